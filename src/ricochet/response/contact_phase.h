/// \file
/// Private to the exact response: a particle that slides, rolls or rests, or whose bounce cascade dies out.
#pragma once

#include <optional>
#include <vector>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/contact_arc.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/held_motion.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Contact that lasts, of one particle in one step. It is made of contact intervals of constant acceleration, and ends
/// with the step, where nothing presses the particle on any more, where the surface ends, or at another contact.
class ContactPhase {
public:
    /// At the start of the step, which must outlive it.
    explicit ContactPhase(ParticleStep& step);

    /// Contact that lasted to the end of the last step goes on without a new landing. Returns the next contact when the
    /// particle slides into one; without time left it is done, else it flies on.
    std::optional<Contact> resume();
    /// An impact, before and after it is answered: where all its rebounds are slow and something presses the particle
    /// on, contact begins. arriving: the motion before. Returns as resume().
    void remember(const Contact& contact) { manifold_.remember(contact.all()); }
    std::optional<Contact> begin(const Flight& flight, const Contact& contact, const Motion& arriving);
    /// Records the weight of a particle at rest for the whole step.
    void record_weight();

private:
    /// What a particle follows in one contact interval on flat surfaces.
    struct ContactPath {
        Path path;
        bool leaves_surface = false;  ///< the surface ends at its end, before the interval does
    };
    /// Why an interval, or several, have ended before their time.
    struct Stop {
        std::optional<Contact> contact;  ///< it has come to another contact
        bool left_surface = false;       ///< the surface has ended, or holds it no more
        bool rests = false;              ///< nothing moves; no time has passed
        [[nodiscard]] bool is_early() const { return contact || left_surface; }
    };

    /// A surface that is touched at a contact point of the manifold.
    struct HeldPoint {
        SurfaceId surface = 0;
        std::size_t point = 0;
    };

    [[nodiscard]] bool rebounds_slowly(const Flight& flight, const Contact& contact, const Motion& arriving) const;
    [[nodiscard]] bool has_losses(const ContactSurface& surface) const;
    [[nodiscard]] double slow_rebound(const ContactSurface& surface, const Vec3& forces, bool kicked,
                                      bool dies_out) const;
    [[nodiscard]] double fastest_departure(const ContactSurface& surface, const Vec3& forces, double fastest,
                                           bool die_out) const;
    [[nodiscard]] std::optional<ContactSurface> support_of(const Vec3& forces, double fastest) const;
    [[nodiscard]] std::array<Vec3, kMostHolding> pushes_together(const Vec3& forces, double fastest) const;
    [[nodiscard]] std::array<Vec3, kMostHolding> pushes_together(const Vec3& forces, double fastest,
                                                                 bool die_out) const;
    [[nodiscard]] StuckSurfaces sticking(std::span<const HoldingSurface> surfaces) const;
    [[nodiscard]] std::optional<ContactSurface> hardest_pressed(const Vec3& forces) const;
    void land(const Motion& arriving);
    std::optional<Contact> drift(const Flight& flight);
    [[nodiscard]] Stop finish_cascade(const ContactSurface& support);
    [[nodiscard]] bool settle(const Vec3& forces);
    [[nodiscard]] Stop spend_cascade(const ContactSurface& support, double left);
    std::optional<Contact> follow_surface(bool kicked);
    [[nodiscard]] Stop advance(const Vec3& forces, bool has_forces, double pressure, double duration);
    [[nodiscard]] ContactInterval plan(const Vec3& pull, double pressure, double duration);
    [[nodiscard]] Grip grip(double pressure) const;
    [[nodiscard]] Stop follow(const ContactInterval& interval, const Vec3& forces, bool has_forces);
    [[nodiscard]] ContactPath path_along(const ContactInterval& interval) const;
    void keep_offset(Path& path, const ContactInterval& interval) const;
    [[nodiscard]] Stop follow_arc(const Vec3& forces, bool has_forces, double pressure, double duration);
    void lift_middle(Path& path) const;
    [[nodiscard]] std::optional<ErrorTolerance> tolerance() const;
    [[nodiscard]] double arc_duration(const ContactArc& arc, bool& leaves) const;
    [[nodiscard]] double time_on_pieces(const ContactArc& arc, const Path& path) const;
    void gather();
    [[nodiscard]] bool lands() const;
    void find_next_surfaces();
    [[nodiscard]] bool is_pressed(const Vec3& forces) const;
    [[nodiscard]] bool overlaps_held(const Vec3& position) const;
    [[nodiscard]] bool has_left_face(const Vec3& position) const;
    [[nodiscard]] bool is_beyond_rim(SurfaceId surface, const Vec3& position) const;
    void hold_manifold();
    void find_held();
    void touch_held(const Vec3& turning_point);
    [[nodiscard]] bool goes_on_along(const Contact& contact);
    void add_held(std::optional<Contact>& contact) const;
    [[nodiscard]] bool bends() const;
    [[nodiscard]] double pressing_on(const ContactSurface& surface, const Vec3& forces, const Vec3& velocity) const;
    void wait(double duration, const Vec3& forces);
    void rest(const Vec3& forces, bool held);
    [[nodiscard]] Vec3 forces_now(const Flight& flight) const;
    [[nodiscard]] double slow_restitution(SurfaceId surface) const;

    ParticleStep& step_;
    const ResponseRules& rules_;
    MovingParticle& particle_;
    ForceInput& state_;
    ImpactAnswer& impact_;
    ContactManifold manifold_;
    std::vector<SurfaceId> held_;         // surfaces that are touched, for paths along them
    std::vector<HeldPoint> held_points_;  // those of them that are touched where the manifold's are
    bool crosses_seam_ = false;           // the next interval begins there
    int seams_ = 0;                       // at which the step has met the next part of a surface
    KeptContact began_;                   // what the particle touched at the start of the step
    bool began_still_;                    // its place stayed then
    Vec3 began_spin_;                     // rad/s
    bool forces_vary_;                    // and the integrator is of second order or more
    double shortest_interval_;            // s
    int slow_contacts_ = 0;               // in a row, all slower than the resting speed or without time between them
    double remaining_at_contact_ = -1.0;  // s, at the last one
};

}  // namespace ricochet
