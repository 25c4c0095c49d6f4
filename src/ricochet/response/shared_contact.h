/// \file
/// Private to the exact response: contact that lasts with surfaces of different frames, such as the floor and a blade
/// that pushes along it, and with meshes that deform.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/response/contact_interval.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {

/// One particle on the surfaces of several frames in one step. It is followed in the world, in intervals in which the
/// surfaces count as the planes that they are at the contact, with their velocities, and with how fast their normals
/// turn. A plane that advances is one at rest, seen from what moves with all of them: the intervals are planned there.
class SharedContact {
public:
    /// In the world. The step must outlive it.
    explicit SharedContact(ParticleStep& step) : step_(step) {}

    /// True where an impact is so slow, on all surfaces that it approaches, that it begins or goes on. arriving: the
    /// motion before.
    [[nodiscard]] bool is_slow(const Contact& contact, const Motion& arriving) const;
    /// Lands on all that is touched and goes along it. Returns the next contact when the particle comes to one; without
    /// time left it is done; else nothing holds it any more, or surfaces of one frame do (`particle.contact`).
    std::optional<Contact> follow();

private:
    /// A surface that is touched, as the world sees it.
    struct Touched {
        ContactSurface surface;
        BodyId body = kWorldBody;
        Vec3 velocity;  ///< m/s, of the surface and its material at the contact
        Vec3 turning;   ///< rad/s, of the body
        /// Of a mesh that deforms: DeformedContact::all; at the rim of a triangle others that it is a rim of.
        std::vector<SurfaceId> all;
    };
    enum class SupportKind { shared, single, none };

    void gather();
    void gather_in(BodyId body);
    void gather_deforming();
    [[nodiscard]] const DeformingColliders& deforming() const { return step_.rules().bodies->deforming(); }
    [[nodiscard]] bool deforms(const Touched& touched) const {
        return step_.rules().bodies->is_deforming(touched.body);
    }
    [[nodiscard]] bool is_on_deforming() const;
    [[nodiscard]] bool land();
    [[nodiscard]] double fastest() const;
    [[nodiscard]] SupportKind settle(double duration);
    [[nodiscard]] double separation_speed(const Touched& touched) const;
    [[nodiscard]] SupportKind plan(double duration);
    [[nodiscard]] StuckSurfaces sticking(const Motion& motion, std::span<const SupportSurface> surfaces,
                                         double most) const;
    [[nodiscard]] SupportSurface supports(const Touched& touched, const Vec3& shift) const;
    [[nodiscard]] double longest() const;
    [[nodiscard]] std::optional<double> next_jump() const;
    /// How long the path of an interval was, s, and what ended it.
    struct Followed {
        double duration = 0.0;
        std::optional<Contact> contact;
    };
    [[nodiscard]] Followed follow_interval(double most);
    [[nodiscard]] Path interval_path(double duration) const;
    [[nodiscard]] Path path_until_rim(double& duration) const;
    [[nodiscard]] double until_rim(const Path& path) const;
    [[nodiscard]] Vec3 velocity_change_of(std::size_t k, double elapsed, bool has_arrived) const;
    /// Of a surface, from a position at a time.
    struct Height {
        Vec3 normal;
        double above = 0.0;   ///< m, of the centre
        double offset = 0.0;  ///< m, the contact offset there
    };
    [[nodiscard]] Height height_above(const Touched& touched, const Vec3& position, double time) const;
    [[nodiscard]] Vec3 kept_off(Vec3 end, double time) const;
    void lift();
    void lift_middle(Path& path) const;
    [[nodiscard]] std::vector<SurfaceId> supporting(const Path& path) const;
    [[nodiscard]] static Vec3 rim_of(const CollisionWorld& world, SurfaceId triangle, const Vec3& position);
    [[nodiscard]] bool goes_on(const ContactSurface& surface) const;
    void join_impact(Contact& contact) const;
    [[nodiscard]] ContactState contact_state() const;
    [[nodiscard]] bool rests() const;
    [[nodiscard]] std::span<const Touched> touched() const { return {touched_.data(), count_}; }
    [[nodiscard]] MovingView view_at(double time) const;

    [[nodiscard]] MovingParticle& particle() const { return step_.particle(); }
    [[nodiscard]] ForceInput& state() const { return step_.state(); }
    [[nodiscard]] const SurfaceKinematics& surfaces() const { return step_.impact().surfaces(); }
    [[nodiscard]] ImpulseLedger& ledger() { return step_.impact().ledger(); }

    ParticleStep& step_;
    std::array<Touched, kMostSupports> touched_;
    std::size_t count_ = 0;
    Vec3 shift_;  ///< m/s, of the frame that the interval is planned in
    ContactInterval interval_;
};

}  // namespace ricochet
