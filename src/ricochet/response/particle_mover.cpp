#include "ricochet/response/particle_mover.h"

#include <algorithm>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_with_bodies.h"

namespace ricochet {
namespace {

/// Bounces in one step after which a particle does not look ahead. It is in a narrow gap, where a look-ahead always
/// finds a surface. Without the limit the narrow cavity of `ricochet bench --suite pinball` took 6 to 9 % longer
/// (docs/decisions/2026-11-23-what-pays.md). Local, because only the cost depends on it.
constexpr std::uint32_t kBouncesInNarrowGap = 2;
/// Largest duration of a step, in time steps of the run, by the rounding of the clock. Local, because only look-ahead
/// depends on it.
constexpr double kWholeStep = 1.0 + 1e-9;

/// Lets a flight end after a duration, s, on its own path.
void cut(Flight& flight, double duration, const Integrator& integrator, const ForceField& forces) {
    if (flight.path.duration <= duration) return;
    flight.end_velocity = velocity_at(integrator, forces, flight, duration);
    flight.path.end = flight.path.position(duration);
    flight.path.duration = duration;
}

}  // namespace

MoveOutcome ParticleMover::run() {
    MoveOutcome& outcome = step_.outcome();
    // What is copied here is large: no contact is assigned without need.
    let_go_speed_ = particle_.contact.release_speed();
    std::optional<Contact> contact = resume();
    Flight flight;
    for (bool is_first = true; contact || step_.remaining() > 0.0; is_first = false) {
        rules_.poll();
        outcome.free_for = outcome.candidates_for = 0.0;
        if (!contact) contact = fly(flight, std::exchange(flies_anew_, false) || is_first);
        while (contact && !outcome.is_absorbed() && step_.has_budget() && has_room()) {
            step_.impact().release(*contact);
            contact = resolve(flight, *contact);
        }
        if (outcome.is_absorbed()) break;
        if (contact && !follows_receding_body(contact)) {
            step_.stop();
            break;
        }
    }
    if (particle_.contact.count == 0) {
        particle_.contact = let_go_speed_ ? ContactState::release_at(*let_go_speed_) : ContactState{};
    }
    if (frame_rules_ != nullptr) step_.store_position();
    step_.impact().finish_recording();
    step_.log().note_impact();
    return outcome;
}

/// At a surface that moves: what a kick has done for the time that is left is taken back, and done by the forces.
std::optional<Contact> ParticleMover::resolve_without_impulse(const Flight& flight, const Contact& contact) {
    if (!flies_anew_) {
        particle_.state.velocity -= step_.remaining() * flight.acceleration;
        step_.log().note_flight();  // of the integrator's doing, not of the surfaces'
    }
    flies_anew_ = is_without_impulse_ = true;
    return resolve(Flight{}, contact);
}

/// False where surfaces close on it: many bounces have passed in almost no time, and more of them would not help.
bool ParticleMover::has_room() {
    if (!has_met_moving_ || step_.outcome().meetings() < bounces_at_look_ + kBouncesUntilPinched) return true;
    bounces_at_look_ = step_.outcome().meetings();
    const double before = std::exchange(remaining_at_look_, step_.remaining());
    return before - step_.remaining() > kPinchedProgress * step_.duration();
}

/// Contact that lasted to the end of the last step goes on: on the surfaces of one frame, or of several, and of meshes
/// that deform, until those of one are left.
std::optional<Contact> ParticleMover::resume() {
    if (frame_rules_ == nullptr) return contact_phase_.resume();
    if (!step_.catch_up() || particle_.contact.count == 0) return std::nullopt;
    return resume_among_bodies();
}

/// s, for which the next flight is planned.
double ParticleMover::planned_duration(bool is_first) const {
    if (particle_.beyond == 0.0) return step_.remaining();
    const bool as_planned = is_first && particle_.planned != nullptr;
    return as_planned ? particle_.planned->path.duration : step_.remaining() + particle_.beyond;
}

/// Flies until the step's end or the contact that is returned. flight: the one before; replaced.
std::optional<Contact> ParticleMover::fly(Flight& flight, bool is_first) {
    const double remaining = planned_duration(is_first);
    const Integrator integrator = is_without_impulse_ ? IntegratorKind::ballistic : rules_.settings.integrator;
    flight = is_first ? first_flight(rules_, particle_, remaining, integrator)
                      : resume_flight(integrator, rules_.forces, particle_.state, flight, remaining);
    if (particle_.beyond > 0.0) cut(flight, step_.remaining(), integrator, rules_.forces);
    const auto look_ahead = look_ahead_of(flight);
    step_.log().note_impact();
    const auto contact = step_.follow(flight, integrator, look_ahead ? &*look_ahead : nullptr,
                                      is_first ? particle_.candidates : ContactCandidates{});
    step_.log().note_flight();
    step_.outcome().is_coarse |= flight.is_coarse;
    if (flight.has_spent_substeps() && !contact) step_.stop();
    return contact;
}

/// After an impact contact goes on with the surfaces that have held it, if it does not leave them: without a landing.
/// At the end of a step they are kept for the next one. Returns the next contact.
std::optional<Contact> ParticleMover::go_on(const Flight& flight, const Contact& contact) {
    const Contact held = supporting_part(contact);
    if (held.count == 0) return std::nullopt;
    if (step_.remaining() > 0.0) return begin_contact(flight, held, {particle_.state.velocity, particle_.spin});
    ContactState contact_state;
    for (const ContactSurface& surface : held.all()) {
        const bool is_left =
            step_.impact().separation_speed(surface) > kLeavingRounding * length(particle_.state.velocity);
        if (!is_left && contact_state.count < contact_state.surfaces.size())
            contact_state.surfaces[contact_state.count++] = surface.surface;
    }
    particle_.contact = contact_state;
    return std::nullopt;
}

/// Answers an impact. Returns the next contact when the particle slides into one.
std::optional<Contact> ParticleMover::resolve(const Flight& flight, const Contact& contact) {
    const bool moves = has_moving(contact);
    if (moves && flight.kick_duration > 0.0) return resolve_without_impulse(flight, contact);
    has_met_moving_ = has_met_moving_ || moves;
    contact_phase_.remember(contact);
    const Motion arriving{particle_.state.velocity, particle_.spin};
    if (moves) step_.impact().note_driven();
    // A slow one cuts no step short: it begins contact.
    const double slow =
        moves ? slowest_rebound(rules_, *frame_rules_, particle_, contact) : rules_.settings.resting_speed;
    step_.set_resting_speed(slow);
    const bool is_fast = moves && step_.impact().approach(contact.all()) > slow;
    const bool is_resumed = lands_again(contact, slow);
    const std::optional<double> release_speed = is_resumed ? std::exchange(let_go_speed_, {}) : std::nullopt;
    step_.impact().set_hits(!is_resumed);
    const bool is_impact = step_.impact().reflect(contact.all(), is_fast);
    step_.impact().set_hits(true);
    ++(is_impact && !is_resumed ? step_.outcome().bounces : step_.outcome().touches);
    if (is_impact) let_go_speed_.reset();
    // A kicked particle that lands does so anew, without a rebound.
    if (flight.kick_duration == 0.0) step_.log().note_impact();
    if (step_.outcome().is_absorbed()) return std::nullopt;
    if (is_fast && step_.impact().waits_for(contact.all())) return follow_receding_body(contact);
    const double before = step_.remaining();
    auto next = begin_contact(flight, contact, arriving);
    const auto has_begun = [&] { return next || particle_.contact.count > 0 || step_.remaining() < before; };
    if (!has_begun() && flight.kick_duration == 0.0) next = go_on(flight, contact);
    if (!has_begun() && !let_go_speed_) let_go_speed_ = release_speed;
    if (!moves || has_begun()) return next;
    // It goes on into a body that leaves it, but is where its path has it until the move's end.
    if (step_.impact().approach_of_paths(contact.all()) > slow) return follow_receding_body(contact);
    step_.impact().go_with_paths(contact.all());
    return next;
}

/// The horizon of the last flight of a step: as far as its path is known, which it is where the acceleration is
/// uniform and the steps are those of the run.
std::optional<LookAhead> ParticleMover::look_ahead_of(const Flight& flight) {
    const ForceInput& state = particle_.state;
    const double remaining = step_.remaining();
    const double time_step = rules_.settings.time_step;
    const bool is_known = rules_.look_ahead && step_.outcome().meetings() < kBouncesInNarrowGap &&
                          rules_.forces.is_uniform() && particle_.planned == nullptr && particle_.beyond == 0.0 &&
                          state.coupling == nullptr && flight.path.duration == remaining &&
                          remaining <= kWholeStep * time_step;
    if (!is_known) return std::nullopt;
    const double acceleration = length(flight.acceleration);
    const int steps = acceleration == 0.0 ? kMaxLookAheadSteps : kMaxLookAheadStepsCurved;
    const double left = rules_.end - (state.time + remaining);  // of the run, after this step
    if (left < 0.5 * time_step) return std::nullopt;
    const double duration = remaining + std::min(steps * time_step, left + time_step);
    LookAhead look_ahead{look_ahead_path(rules_.settings.integrator, flight, time_step, duration), 0.0,
                         remaining + time_step, kWholeStep * time_step};
    const double speed = length(flight.end_velocity) + acceleration * duration;
    const double largest = max_abs(flight.path.end) + speed * duration + state.radius;
    if (!(largest < kLargestCoordinate) || !(speed < kMaxSpeed)) return std::nullopt;
    const double clocks = 4.0 * ulp(state.time + duration) * speed;  // steps are as long as the clock's times say
    look_ahead.margin = kLookAheadSlack * largest + 0.125 * time_step * time_step * acceleration + clocks;
    return look_ahead;
}

}  // namespace ricochet
