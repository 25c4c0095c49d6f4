/// \file
/// Private to the exact response: one particle on its way through one step.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "ricochet/response/contact_manifold.h"
#include "ricochet/response/contact_mode.h"
#include "ricochet/response/impact.h"

namespace ricochet {

class Mover {
public:
    Mover(const ResponseRules& rules, MovingParticle& particle, double duration, MoveScratch& scratch)
        : rules_(rules),
          particle_(particle),
          state_(particle.state),
          scratch_(scratch),
          geometry_(rules.world, scratch.contacts.plane_cache),
          impact_(rules, particle, scratch, outcome_),
          start_(particle.state.position),
          began_(particle.contact),
          began_still_(particle.state.velocity == Vec3{} && particle.spin == Vec3{}),
          first_segment_(scratch.segments.size()),
          remaining_(duration),
          manifold_(geometry_, state_),
          shortest_stretch_(duration / kShortestStretches) {}

    MoveOutcome run();
    /// Books the weight of a particle at rest for the whole duration.
    void weigh();

private:
    // Flying (exact.cpp).
    std::optional<Contact> follow(const Flight& flight, const LookAhead* look_ahead = nullptr,
                                  const ContactCandidates& candidates = {});
    void look_beyond(const Flight& flight);
    [[nodiscard]] std::optional<LookAhead> look_ahead_of(const Flight& flight) const;
    void accept_chain();
    [[nodiscard]] bool has_budget() const { return outcome_.bounces < rules_.settings.bounce_budget; }
    void leave_surface(const Flight& flight, const NearSurfaces& near);
    void freeze();

    // Impacts (mover_impact.cpp).
    std::optional<Contact> answer(const Flight& flight, const Contact& contact);

    // Resting, sliding, rolling (mover_contact.cpp).
    [[nodiscard]] const ContactSurface* support_of(const Flight& flight, const Contact& contact,
                                                   const Motion& arriving) const;
    std::optional<Contact> go_on_in_contact();
    std::optional<Contact> stay_in_contact(const Flight& flight, const ContactSurface& support, const Motion& arriving);
    std::optional<Contact> follow_surface(ContactSurface support, bool kicked);
    std::optional<Contact> finish_cascade(ContactSurface support, bool& ended_early);
    std::optional<Contact> spend_cascade(ContactSurface& support, double left, bool& ended_early);
    [[nodiscard]] Stretch plan(const ContactSurface& support, const Vec3& pull, double pressure, double duration);
    std::optional<Contact> travel_stretch(const Stretch& stretch, ContactSurface& support, const Vec3& a,
                                          bool& ended_early);
    void land(const Motion& arriving, double friction);
    void rest(const Vec3& a, bool held);
    void wait(double duration, const Vec3& a);
    void finish_stretch(const Stretch& stretch, double elapsed);

    // The shape of a contact (mover_surface.cpp).
    [[nodiscard]] Vec3 acceleration_now(const Flight& flight) const;
    [[nodiscard]] double curvature(const ContactSurface& surface, const Vec3& velocity) const;
    [[nodiscard]] Vec3 pull_on(const ContactSurface& surface, const Vec3& a, const Vec3& velocity) const;
    [[nodiscard]] double slow_restitution(SurfaceId surface) const;
    [[nodiscard]] Flight flight_of(const Stretch& stretch, const ContactSurface& support, bool& ends) const;
    [[nodiscard]] double time_on(const ContactSurface& support, const Path& path, double bend) const;
    void turn_along(ContactSurface& support);

    const ResponseRules& rules_;
    MovingParticle& particle_;
    ForceInput& state_;
    MoveScratch& scratch_;
    SurfaceGeometry geometry_;
    LookAheadResult ahead_;  // of the last query
    MoveOutcome outcome_;
    ImpactAnswer impact_;
    Vec3 start_;         // where the step began
    KeptContact began_;  // what it touched then
    bool began_still_;   // and that nothing moved
    std::size_t first_segment_;
    double remaining_;
    ContactManifold manifold_;
    double shortest_stretch_ = 0.0;  // s
    int slow_contacts_ = 0;          // in a row, all slower than the resting speed or without time between them
    double remaining_at_contact_ = -1.0;
};

}  // namespace ricochet
