/// \file
/// A particle that slides, rolls or rests, or whose bounce cascade dies out.
#pragma once

#include <optional>

#include "ricochet/response/contact_follower.h"
#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/contact_support.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// Lasting contact of one particle in one step. It ends at the end of the step or of the surface, at another contact,
/// or when nothing presses the particle on.
class ContactPhase {
public:
    /// Construct it at the start of the step, which must outlive it.
    explicit ContactPhase(ParticleStep& step);
    ContactPhase(const ContactPhase&) = delete;
    ContactPhase& operator=(const ContactPhase&) = delete;

    /// Continues contact from the last step, without a new landing. Returns the next contact if the particle slides
    /// into one. Otherwise the particle flies on if time is left. rounding: rounding of the velocity, and of the speed
    /// of a sphere's surface, in a body's frame, in m/s.
    std::optional<Contact> resume(double rounding = 0.0);
    /// Call both at an impact, the first one before it is resolved. begin() begins contact if all rebounds are slow and
    /// something presses the particle on. arriving: the motion before the impact. Returns the same as resume().
    void remember(const Contact& contact) { manifold_.remember(contact.all()); }
    std::optional<Contact> begin(const Flight& flight, const Contact& contact, const Motion& arriving);
    /// Records the weight of a particle at rest for the whole step.
    void record_weight();
    /// Lets the rest of the step pass at the particle's position. The surfaces that it touches do not act on it.
    /// Returns a contact with a collider that moves to it.
    std::optional<Contact> stay(const Contact& contact);

private:
    using Stop = ContactFollower::Stop;

    [[nodiscard]] std::optional<ContactSurface> find_support(const Flight& flight, const Contact& contact);
    void land(const Motion& arriving);
    std::optional<Contact> drift(const Flight& flight);
    [[nodiscard]] std::optional<Contact> impact_beside(const ContactSurface& support);
    [[nodiscard]] Stop finish_cascade(const ContactSurface& support);
    [[nodiscard]] Stop spend_cascade(const ContactSurface& support, double left);
    std::optional<Contact> follow_surface(bool kicked);
    void gather();
    void drop_rounding(double rounding);
    void find_next_surfaces();
    [[nodiscard]] bool lands() const;
    [[nodiscard]] std::optional<Contact> wait(double duration, const Vec3& forces);
    [[nodiscard]] std::optional<Contact> rest(const Vec3& forces, bool held);
    [[nodiscard]] double time_at_rest();
    void lift();
    [[nodiscard]] bool rests_on(double time);
    [[nodiscard]] Vec3 forces_now(const Flight& flight) const;
    [[nodiscard]] double slow_restitution(SurfaceId surface) const;

    [[nodiscard]] const ResponseRules& rules() const { return step_.rules(); }
    [[nodiscard]] MovingParticle& particle() const { return step_.particle(); }
    [[nodiscard]] ForceInput& state() const { return step_.state(); }
    [[nodiscard]] const SurfaceKinematics& surfaces() const { return step_.impact().surfaces(); }
    [[nodiscard]] ImpulseLedger& ledger() { return step_.impact().ledger(); }

    ParticleStep& step_;
    ContactManifold manifold_;
    ContactSupport support_;
    ContactFollower follower_;
    ContactState began_;                  // contact at the start of the step
    bool began_still_;                    // it had no velocity then
    Vec3 began_spin_;                     // rad/s
    int slow_contacts_ = 0;               // consecutive slow contacts, or without time between them
    double remaining_at_contact_ = -1.0;  // s, at the last contact
};

}  // namespace ricochet
