/// \file
/// Private to the exact response: the life of one particle in one step.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "ricochet/response/contact_phase.h"
#include "ricochet/response/particle_step.h"
#include "ricochet/response/reference_frame.h"
#include "ricochet/response/response.h"

namespace ricochet {

/// The exact response to one particle in one step: fly to the first contact, answer it, go on with the time that is
/// left.
class ParticleMover {
public:
    /// rides: null where nothing moves.
    ParticleMover(const ResponseRules& rules, const FrameRules* frame_rules, MovingParticle& particle, double duration,
                  MoveScratch& scratch)
        : rules_(rules),
          frame_rules_(frame_rules),
          particle_(particle),
          step_(rules, particle, duration, scratch),
          contact_phase_(step_) {}

    MoveOutcome run();

private:
    std::optional<Contact> fly(Flight& flight, bool is_first);
    [[nodiscard]] double planned_duration(bool is_first) const;
    std::optional<Contact> resolve(const Flight& flight, const Contact& contact);
    std::optional<Contact> resolve_without_impulse(const Flight& flight, const Contact& contact);
    [[nodiscard]] bool has_room();
    bool follows_receding_body(std::optional<Contact>& contact);
    [[nodiscard]] bool has_moving(const Contact& contact) const {
        return rules_.bodies != nullptr &&
               std::any_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
                   return rules_.bodies->body_of(surface.surface) != kWorldBody;
               });
    }
    [[nodiscard]] std::optional<Contact> resume();
    [[nodiscard]] std::optional<Contact> resume_among_bodies();
    [[nodiscard]] bool is_released_by_jump() const;
    [[nodiscard]] double rounding_on(BodyId body) const;
    [[nodiscard]] std::optional<Contact> begin_contact(const Flight& flight, const Contact& contact,
                                                       const Motion& arriving);
    [[nodiscard]] std::optional<Contact> begin_attached(BodyId body, const Contact& contact, const Motion& arriving);
    [[nodiscard]] std::optional<Contact> begin_shared();
    [[nodiscard]] Contact part_with(BodyId body, const Contact& contact) const;
    [[nodiscard]] std::optional<Contact> follow_receding_body(const Contact& contact);
    [[nodiscard]] std::optional<Contact> go_on(const Flight& flight, const Contact& contact);
    [[nodiscard]] bool lands_again(const Contact& contact, double slow);
    template <class Go>
    std::optional<Contact> attach(BodyId body, Contact* contact, const Go& go);
    template <class Go>
    std::optional<Contact> attach_unsettled(BodyId body, Contact* contact, const Go& go);
    [[nodiscard]] std::optional<Contact> follow_shared();
    [[nodiscard]] std::optional<LookAhead> look_ahead_of(const Flight& flight);

    const ResponseRules& rules_;
    const FrameRules* frame_rules_;
    MovingParticle& particle_;
    ParticleStep step_;
    ContactPhase contact_phase_;
    std::uint32_t bounces_at_look_ = 0;  // of has_room()
    double remaining_at_look_ = std::numeric_limits<double>::infinity();
    int shared_count_ = 0;         // of contacts with several frames at once
    bool has_met_moving_ = false;  // a surface that moves, in this step
    bool flies_anew_ = false;      // the next flight does not go on from one before: it comes from a ride
    /// For the rest of the step: another kick would lead what leaves a surface back onto it at once.
    bool is_without_impulse_ = false;
    /// In flight since a jump of a body's velocity has let it go: see ContactState::release_speed().
    std::optional<double> let_go_speed_;
};

}  // namespace ricochet
