#include "ricochet/response/particle_mover.h"

#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/carried_particle.h"
#include "ricochet/response/clear_flight.h"
#include "ricochet/response/exact.h"
#include "ricochet/response/flight_forecast.h"
#include "ricochet/response/path_motion.h"
#include "ricochet/response/supported_acceleration.h"

namespace ricochet {
namespace {

/// Number of bounces in one step after which a particle does not look ahead. Such a particle is in a narrow gap, where
/// a look-ahead always finds a surface. Without the limit the narrow cavity of `ricochet bench --suite pinball` took 6
/// to 9 % longer (docs/decisions/2026-11-23-what-pays.md). Local: it affects only the cost.
constexpr std::uint32_t kBouncesInNarrowGap = 2;

/// Shortens a flight to a duration, in s, along its path.
void cut(Flight& flight, double duration, const Integrator& integrator, const ForceField& forces) {
    if (flight.path.duration <= duration) return;
    flight.end_velocity = velocity_at(integrator, forces, flight, duration);
    flight.path.end = flight.path.position(duration);
    flight.path.duration = duration;
}

/// Returns the duration, in s, for which the next flight is planned.
double planned_duration(const ParticleStep& step, bool is_first) {
    const MovingParticle& particle = step.particle();
    if (particle.beyond == 0.0) return step.remaining();
    const bool is_planned = is_first && particle.planned != nullptr;
    return is_planned ? particle.planned->path.duration : step.remaining() + particle.beyond;
}

/// Returns the look-ahead of the last flight of a step; nothing if it is not worth its cost.
std::optional<LookAhead> look_ahead_of(const ParticleStep& step, const Flight& flight) {
    if (step.outcome().meetings() >= kBouncesInNarrowGap) return std::nullopt;
    return look_ahead_of(step.rules(), step.particle(), flight, step.remaining());
}

/// Keeps the free space along a forecast of a step that began at a time, in s. A forecast does not replace later steps.
void keep_forecast(const LookAhead& forecast, double begin, MovingParticle& particle, MoveOutcome& outcome) {
    const double flown = particle.state.time - begin;
    if (outcome.free_for > 0.0) {
        particle.clear = space_along(forecast, begin, {flown, flown + outcome.free_for}, particle.state.radius);
    }
    outcome.free_for = outcome.candidates_for = 0.0;
}

}  // namespace

ExactResponse::ExactResponse(const ResponseRules& rules) : Response(rules), frame_rules_(rules_) {}

MoveOutcome ExactResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    std::optional<Flight> planned;
    if (const auto clear = fly_clear(rules_, particle, duration, scratch, planned)) return *clear;
    return ParticleMover(rules_, frame_rules_, particle, duration, scratch).run(planned ? &*planned : nullptr);
}

SupportedAcceleration ExactResponse::supported_acceleration(const MovingParticle& particle, const Vec3& pull) const {
    return acceleration_in_contact(rules_, particle, pull);
}

void ExactResponse::add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const {
    MovingParticle copy = particle;
    MoveScratch scratch;
    ParticleStep step(rules_, copy, duration, scratch);
    ContactPhase(step).record_weight();
    hits.insert(hits.end(), scratch.hits.begin(), scratch.hits.end());
}

MoveOutcome ParticleMover::run(const Flight* planned) {
    MoveOutcome& outcome = step_.outcome();
    release_speed_ = particle_.contact.release_speed();
    std::optional<Contact> contact = resume_contact();
    Flight flight;
    for (bool is_first = true; contact || step_.remaining() > 0.0; is_first = false) {
        rules_.poll();
        outcome.free_for = outcome.candidates_for = 0.0;
        // Contacts are large to copy, so one is assigned only if needed.
        if (!contact) {
            contact =
                advance_flight(flight, std::exchange(flies_anew_, false) || is_first, is_first ? planned : nullptr);
        }
        while (contact && !outcome.is_absorbed() && may_resolve_contact()) contact = resolve_contact(flight, *contact);
        if (outcome.is_absorbed()) break;
        if (contact && !follows_receding_body(contact)) {
            give_up(step_);
            break;
        }
    }
    finish();
    return outcome;
}

std::optional<Contact> ParticleMover::resume_contact() {
    if (rules_.bodies.empty()) return contact_phase_.resume();
    if (!catch_up(step_) || particle_.contact.count == 0) return std::nullopt;
    return resume_among_bodies();
}

/// Moves the particle in free flight to the end of the step or to the next contact, which is returned. flight: on input
/// the last flight, on output the new one.
std::optional<Contact> ParticleMover::advance_flight(Flight& flight, bool is_first, const Flight* planned) {
    const double remaining = planned_duration(step_, is_first);
    const Integrator integrator = is_without_impulse_ ? IntegratorKind::ballistic : rules_.settings.integrator;
    flight = planned != nullptr ? *planned
             : is_first         ? first_flight(rules_, particle_, remaining, integrator)
                                : resume_flight(integrator, rules_.forces, particle_.state, flight, remaining);
    if (particle_.beyond > 0.0) cut(flight, step_.remaining(), integrator, rules_.forces);
    const auto look_ahead = look_ahead_of(step_, flight);
    const double begin = particle_.state.time;
    step_.log().note_impact();
    const auto contact = follow_flight(step_, flight, integrator, look_ahead ? &*look_ahead : nullptr,
                                       is_first ? particle_.candidates : ContactCandidates{});
    step_.log().note_flight();
    if (look_ahead && look_ahead->deviation > 0.0) keep_forecast(*look_ahead, begin, particle_, step_.outcome());
    step_.outcome().is_coarse |= flight.is_coarse;
    if (flight.has_spent_substeps() && !contact) give_up(step_);
    return contact;
}

/// Returns false if the budget of bounces is used up, or if moving surfaces pinch the particle. A particle counts as
/// pinched if many bounces have taken almost no time. More bounces would not help then.
bool ParticleMover::may_resolve_contact() {
    if (!step_.has_budget()) return false;
    const std::uint32_t meetings = step_.outcome().meetings();
    if (!has_met_moving_ || meetings < meetings_at_check_ + kBouncesUntilPinched) return true;
    meetings_at_check_ = meetings;
    const double before = std::exchange(remaining_at_check_, step_.remaining());
    return before - step_.remaining() > kPinchedProgress * step_.duration();
}

/// Resolves a contact as an impact and, if the rebound is slow, continues with lasting contact.
std::optional<Contact> ParticleMover::resolve_contact(const Flight& flight, Contact& contact) {
    step_.impact().release(contact);
    if (!meets_moving(contact)) return resolve_contact_at_rest(flight, contact);
    if (!(flight.kick_duration > 0.0)) return resolve_contact_with_bodies(flight, contact);
    retract_kick(flight);
    return resolve_contact_with_bodies(Flight{}, contact);
}

std::optional<Contact> ParticleMover::resolve_contact_at_rest(const Flight& flight, const Contact& contact) {
    const Motion arriving = particle_.motion();
    contact_phase_.remember(contact);
    step_.set_resting_speed(rules_.settings.resting_speed);
    const bool is_impact = step_.impact().reflect(contact.all(), /*ends_substep=*/false);
    count_impact(flight, is_impact, false);
    if (step_.outcome().is_absorbed()) return std::nullopt;
    return begin_or_continue_contact(flight, contact, arriving);
}

/// Counts and logs an impact, or a contact without an impact. is_resumed: the impact only resumes a contact.
void ParticleMover::count_impact(const Flight& flight, bool is_impact, bool is_resumed) {
    ++(is_impact && !is_resumed ? step_.outcome().bounces : step_.outcome().touches);
    if (is_impact) release_speed_.reset();
    // After a kick, the landing starts from the motion before the impact, so both are logged as one.
    if (flight.kick_duration == 0.0) step_.log().note_impact();
}

std::optional<Contact> ParticleMover::begin_or_continue_contact(const Flight& flight, const Contact& contact,
                                                                const Motion& arriving) {
    const double before = step_.remaining();
    auto next = begin_contact(flight, contact, arriving);
    const bool has_begun = next || particle_.contact.count > 0 || step_.remaining() < before;
    if (!has_begun && flight.kick_duration == 0.0) next = continue_contact(flight, contact);
    return next;
}

/// Continues contact after an impact with the surfaces that have supported the particle, unless it separates from them.
/// No landing takes place. At the end of a step, the surfaces are stored for the next step.
std::optional<Contact> ParticleMover::continue_contact(const Flight& flight, const Contact& contact) {
    const Contact supporting = part_of(contact, &ContactSurface::is_support);
    if (supporting.count == 0) return std::nullopt;
    if (step_.remaining() > 0.0) return begin_contact(flight, supporting, particle_.motion());
    ContactState contact_state;
    for (const ContactSurface& surface : supporting.all()) {
        const bool is_left = surfaces().separation_speed(surface) > kLeavingRounding * length(particle_.state.velocity);
        if (!is_left && contact_state.count < contact_state.surfaces.size()) {
            contact_state.surfaces[contact_state.count++] = surface.surface;
        }
    }
    particle_.contact = contact_state;
    return std::nullopt;
}

void ParticleMover::finish() {
    if (particle_.contact.count == 0) {
        particle_.contact = release_speed_ ? ContactState::release_at(*release_speed_) : ContactState{};
    }
    keep_stored_position(step_);
    ledger().close();
    step_.log().note_impact();
}

/// Subtracts the kick for the remaining time, at an impact on a moving surface. Forces then act during flights.
void ParticleMover::retract_kick(const Flight& flight) {
    if (!flies_anew_) {
        particle_.state.velocity -= step_.remaining() * flight.acceleration;
        step_.log().note_flight();  // a change by the integrator, not by surfaces
    }
    flies_anew_ = is_without_impulse_ = true;
}

/// Records that contact on a body has ended the flight, so that the next flight does not continue it.
void ParticleMover::leave_flight() {
    flies_anew_ = true;
    is_without_impulse_ = kicks_first(rules_.settings.integrator.kind);
}

}  // namespace ricochet
