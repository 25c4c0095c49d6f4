/// \file
/// Private to the exact response: a particle that slides, rolls or rests, or whose bounce cascade dies out.
#pragma once

#include <optional>

#include "ricochet/collision/contact_scratch.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/response.h"

namespace ricochet {

// The path of a particle's centre along a surface that holds it.

/// What a particle follows in one contact interval.
struct ContactFlight {
    Flight flight;
    bool leaves_surface = false;  ///< the surface ends at its end, before the interval does
};

/// Paths along flat surfaces, and along curved ones in straight segments that turn by at most kMaxChordAngle.
class ContactPath {
public:
    /// Both must outlive it; positions are the particle's present ones.
    ContactPath(const SurfaceGeometry& geometry, const ForceInput& particle)
        : geometry_(geometry), particle_(particle) {}

    /// The acceleration, m/s^2, that presses and pulls: that of the forces, and on a curved surface the one by which
    /// the path at this velocity turns away from a straight line.
    [[nodiscard]] Vec3 pull(const ContactSurface& support, const Vec3& forces, const Vec3& velocity) const;

    /// The path of a contact interval, up to where the support ends; its end keeps the contact offset. Where a surface
    /// bends away it is a tangent, at whose end the particle falls the little that the surface has bent; where it bends
    /// towards the particle, a chord.
    [[nodiscard]] ContactFlight flight(const ContactInterval& interval, const ContactSurface& support) const;

private:
    [[nodiscard]] double curvature(const ContactSurface& surface, const Vec3& velocity) const;
    [[nodiscard]] double time_on(const ContactSurface& support, const Path& path, double curvature) const;
    void keep_offset(const ContactSurface& support, Path& path) const;
    [[nodiscard]] Path chord(const ContactInterval& interval, const ContactSurface& support, const Path& path) const;

    const SurfaceGeometry& geometry_;
    const ForceInput& particle_;
};

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
    /// Why an interval, or several, have ended before their time.
    struct Stop {
        std::optional<Contact> contact;  ///< it has come to another contact
        bool left_surface = false;       ///< the surface has ended
        [[nodiscard]] bool is_early() const { return contact || left_surface; }
    };

    [[nodiscard]] const ContactSurface* support_of(const Flight& flight, const Contact& contact,
                                                   const Motion& arriving) const;
    [[nodiscard]] std::optional<ContactSurface> hardest_pressed(const Vec3& forces) const;
    void land(const Motion& arriving, double friction);
    [[nodiscard]] Stop finish_cascade(ContactSurface support);
    [[nodiscard]] Stop spend_cascade(ContactSurface& support, double left);
    std::optional<Contact> follow_surface(ContactSurface support, bool kicked);
    [[nodiscard]] ContactInterval plan(const ContactSurface& support, const Vec3& pull, double pressure,
                                       double duration);
    [[nodiscard]] Stop follow(const ContactInterval& interval, ContactSurface& support, const Vec3& forces);
    void turn_along(ContactSurface& support);
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
    ContactPath path_;
    KeptContact began_;                   // what the particle touched at the start of the step
    bool began_still_;                    // nothing moved then
    double shortest_interval_;            // s
    int slow_contacts_ = 0;               // in a row, all slower than the resting speed or without time between them
    double remaining_at_contact_ = -1.0;  // s, at the last one
};

}  // namespace ricochet
