/// \file
/// Lasting contact with surfaces of different frames, such as a floor and a blade on it, and with deforming meshes.
#pragma once

#include <optional>

#include "ricochet/response/contact_interval.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/shared_surfaces.h"

namespace ricochet {

/// Follows one particle on the surfaces of several frames in one step. In each contact interval the surfaces count as
/// planes with a velocity, whose normals turn at a known rate. It is planned in a frame in which no plane advances
/// along its normal.
class SharedContact {
public:
    /// The step must outlive it.
    explicit SharedContact(ParticleStep& step) : step_(step), surfaces_(step) {}

    /// Returns true if an impact is slow on all surfaces, so that contact begins. arriving: the motion before it.
    [[nodiscard]] bool is_slow(const Contact& contact, const Motion& arriving) const;
    /// Lands on all surfaces that touch the particle, and follows them. Returns the next contact, if there is one.
    /// Otherwise, if time is left, surfaces of at most one frame support the particle (MovingParticle::contact).
    std::optional<Contact> follow();

private:
    enum class SupportKind { shared, single, none };
    /// Duration of an interval's path, in s, and the contact that has ended it.
    struct Followed {
        double duration = 0.0;
        std::optional<Contact> contact{};
    };

    [[nodiscard]] bool land();
    [[nodiscard]] double fastest() const;
    [[nodiscard]] SupportKind settle(double duration);
    [[nodiscard]] SupportKind plan(double duration);
    [[nodiscard]] Followed follow_interval(double most);
    [[nodiscard]] Path interval_path(double duration) const;
    [[nodiscard]] Path path_until_rim(double& duration) const;
    [[nodiscard]] double until_rim(const Path& path) const;
    void take_reactions(double elapsed, bool has_arrived);
    [[nodiscard]] Vec3 velocity_change_of(std::size_t k, double elapsed, bool has_arrived) const;
    [[nodiscard]] Vec3 kept_off(Vec3 end, double time) const;
    void lift();
    void lift_middle(Path& path) const;
    [[nodiscard]] bool rests() const;

    [[nodiscard]] MovingParticle& particle() const { return step_.particle(); }
    [[nodiscard]] ForceInput& state() const { return step_.state(); }
    [[nodiscard]] ImpulseLedger& ledger() { return step_.impact().ledger(); }

    ParticleStep& step_;
    SharedSurfaces surfaces_;
    Vec3 shift_;  ///< m/s, of the frame in which the interval is planned
    ContactInterval interval_;
};

}  // namespace ricochet
