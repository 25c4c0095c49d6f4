#include "ricochet/response/clear_flight.h"

#include "ricochet/response/flight_forecast.h"
#include "ricochet/response/impact_resolver.h"
#include "ricochet/response/motion_log.h"

namespace ricochet {
namespace {

/// Returns true if the particle is in free flight by itself, and a contact query would serve this step alone.
bool may_fly_clear(const ResponseRules& rules, const MovingParticle& particle) {
    return rules.bodies.empty() && rules.world.culls() && !rules.forces.is_uniform() && particle.beyond == 0.0 &&
           particle.contact == ContactState{} && is_finite(particle.state.position);
}

/// Number of steps for which a search looks for free space. More: a search costs more where space is free. Fewer: more
/// searches. Local: it affects only the cost.
constexpr double kSearchedSteps = 40.0;

/// Number of steps after which a search that has found too little free space is repeated. Fewer: a particle along a
/// wall pays for searches in vain. More: one that leaves a wall pays for contact queries. Local: it affects only the
/// cost.
constexpr double kStepsBetweenSearches = 6.0;

/// Searches for free space if the known one is used up, unless the contact query of this step will find it. Returns
/// true if the search has found another space.
bool search_space(const ResponseRules& rules, MovingParticle& particle, const Flight& flight, double duration) {
    const ForceInput& state = particle.state;
    ClearSpace& clear = particle.clear;
    const double step = duration * length(state.velocity);
    if (clear.is_known() && clear.is_at_rest() &&
        length(state.position - clear.center) < kStepsBetweenSearches * step) {
        return false;
    }
    const bool has_left_forecast = !clear.is_at_rest() && state.time + duration <= clear.end;
    if (!has_left_forecast && look_ahead_of(rules, particle, flight, duration)) return false;
    clear = find_clear_ball(rules.world, state.position, state.radius, kSearchedSteps * step);
    return true;
}

/// Records the flight in the lists that the caller has asked for. before: the particle at the start.
void record(const ResponseRules& rules, const MovingParticle& before, const MovingParticle& after, const Flight& flight,
            MoveScratch& scratch) {
    const Path& path = flight.path;
    if (scratch.record_segments) scratch.segments.push_back({path.c[0], path.end, before.state.time, 0.0, 0.0});
    if (scratch.record_flown) {
        // Computed like the beginning of a flight that made a query, to the last bit.
        const double begin = after.state.time - path.duration;
        scratch.flown.push_back({path, begin, path.duration, before.state.velocity, after.state.velocity, true});
    }
    if (!scratch.record_motions) return;
    MovingParticle moved = before;
    MotionLog log(rules, moved, scratch, ReferenceFrame::world());
    moved.state = after.state;
    log.note_flight();
}

}  // namespace

bool flies_clear(const ClearSpace& space, const ForceInput& state, const Flight& flight, double duration) {
    return flight.path.duration == duration && can_be_followed(flight.path) &&
           space.contains(flight.path, state.time, state.radius);
}

std::optional<MoveOutcome> fly_clear(const ResponseRules& rules, MovingParticle& particle, double duration,
                                     MoveScratch& scratch, std::optional<Flight>& flight) {
    if (!may_fly_clear(rules, particle)) return std::nullopt;
    flight = first_flight(rules, particle, duration);
    if (!flies_clear(particle.clear, particle.state, *flight, duration)) {
        const bool has_found = search_space(rules, particle, *flight, duration);
        if (!has_found || !flies_clear(particle.clear, particle.state, *flight, duration)) return std::nullopt;
    }
    const bool is_recorded = scratch.record_segments || scratch.record_flown || scratch.record_motions;
    const std::optional<MovingParticle> before = is_recorded ? std::optional(particle) : std::nullopt;
    ForceInput& state = particle.state;
    state.position = flight->path.end;
    state.velocity = flight->end_velocity;
    state.time += duration;
    if (before) record(rules, *before, particle, *flight, scratch);
    MoveOutcome outcome;
    outcome.is_coarse = flight->is_coarse;
    return outcome;
}

}  // namespace ricochet
