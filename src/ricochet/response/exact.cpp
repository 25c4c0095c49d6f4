#include "ricochet/response/exact.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_phase.h"

namespace ricochet {
namespace {

/// Bounces in one step after which a particle does not look ahead: it is in a narrow gap, and what it would find out
/// is that something is near. Looking ahead all the same cost the narrow cavity of `ricochet bench --suite pinball` 6
/// to 9 % (docs/decisions/2026-11-23-what-pays.md).
constexpr std::uint32_t kBouncesInNarrowGap = 2;

/// Parts of the run's time step that a step may last by the rounding of the clock.
constexpr double kWholeStep = 1.0 + 1e-9;

/// The exact response to one particle in one step: fly to the first contact, answer it, go on with the time that is
/// left.
class ParticleMover {
public:
    ParticleMover(const ResponseRules& rules, MovingParticle& particle, double duration, MoveScratch& scratch)
        : rules_(rules), particle_(particle), step_(rules, particle, duration, scratch), contact_phase_(step_) {}

    MoveOutcome run();

private:
    std::optional<Contact> fly(Flight& flight, bool is_first);
    std::optional<Contact> answer(const Flight& flight, const Contact& contact);
    [[nodiscard]] std::optional<LookAhead> look_ahead_of(const Flight& flight);

    const ResponseRules& rules_;
    MovingParticle& particle_;
    ParticleStep step_;
    ContactPhase contact_phase_;
};

MoveOutcome ParticleMover::run() {
    MoveOutcome& outcome = step_.outcome();
    std::optional<Contact> contact = contact_phase_.resume();
    Flight flight;
    for (bool is_first = true; contact || step_.remaining() > 0.0; is_first = false) {
        outcome.free_for = outcome.candidates_for = 0.0;
        if (!contact) contact = fly(flight, is_first);
        while (contact && !outcome.is_absorbed() && outcome.bounces < rules_.settings.bounce_budget) {
            contact = answer(flight, *contact);
        }
        if (outcome.is_absorbed()) break;
        if (contact) {
            step_.stop();
            break;
        }
    }
    step_.log().note_impact();
    return outcome;
}

/// Flies until the step's end or the contact that is returned. flight: the one before; replaced.
std::optional<Contact> ParticleMover::fly(Flight& flight, bool is_first) {
    const double remaining = step_.remaining();
    flight = is_first ? first_flight(rules_, particle_, remaining)
                      : resume_flight(rules_.settings.integrator, rules_.forces, particle_.state, flight, remaining);
    const auto look_ahead = look_ahead_of(flight);
    step_.log().note_impact();
    const auto contact = step_.follow(flight, look_ahead ? &*look_ahead : nullptr,
                                      is_first ? particle_.candidates : ContactCandidates{});
    step_.log().note_flight();
    return contact;
}

/// Answers an impact. Returns the next contact when the particle slides into one.
std::optional<Contact> ParticleMover::answer(const Flight& flight, const Contact& contact) {
    ++step_.outcome().bounces;
    contact_phase_.remember(contact);
    const Motion arriving{particle_.state.velocity, particle_.spin};
    step_.impact().reflect(contact.all());
    // A kicked particle that lands does so anew, without a rebound.
    if (flight.kick_duration == 0.0) step_.log().note_impact();
    if (step_.outcome().is_absorbed()) return std::nullopt;
    return contact_phase_.begin(flight, contact, arriving);
}

/// The horizon of the last flight of a step: as far as its path is known, which it is where the acceleration is
/// uniform and the steps are those of the run.
std::optional<LookAhead> ParticleMover::look_ahead_of(const Flight& flight) {
    const ForceInput& state = particle_.state;
    const double remaining = step_.remaining();
    const double time_step = rules_.settings.time_step;
    const bool is_known = rules_.look_ahead && step_.outcome().bounces < kBouncesInNarrowGap &&
                          rules_.forces.is_uniform() && particle_.planned == nullptr && state.coupling == nullptr &&
                          flight.path.duration == remaining && remaining <= kWholeStep * time_step;
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

}  // namespace

MoveOutcome ExactResponse::move(MovingParticle& particle, double duration, MoveScratch& scratch) const {
    return ParticleMover(rules_, particle, duration, scratch).run();
}

void ExactResponse::add_weight(const MovingParticle& particle, double duration, std::vector<SurfaceHit>& hits) const {
    MovingParticle copy = particle;
    MoveScratch scratch;
    ParticleStep step(rules_, copy, duration, scratch);
    ContactPhase(step).record_weight();
    hits.insert(hits.end(), scratch.hits.begin(), scratch.hits.end());
}

}  // namespace ricochet
