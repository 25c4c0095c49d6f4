#include "ricochet/response/clear_flight.h"

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

/// Returns the room beside the triangles, in m, if it exceeds the estimated length of a step, in m; otherwise 0.
/// Searches for free space if the known one is used up.
double room_for(const CollisionWorld& world, MovingParticle& particle, double step) {
    const Vec3& position = particle.state.position;
    const double radius = particle.state.radius;
    double room = room_beside_triangles(world, position, radius, particle.clear);
    if (room > step) return room;
    ClearBall& clear = particle.clear;
    const bool is_searched = clear.radius > 0.0 && length(position - clear.center) < kStepsBetweenSearches * step;
    if (is_searched) return 0.0;
    clear = find_clear_ball(world, position, radius, kSearchedSteps * step);
    room = room_beside_triangles(world, position, radius, clear);
    return room > step ? room : 0.0;
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

std::optional<MoveOutcome> fly_clear(const ResponseRules& rules, MovingParticle& particle, double duration,
                                     MoveScratch& scratch, std::optional<Flight>& flight) {
    if (!may_fly_clear(rules, particle)) return std::nullopt;
    ForceInput& state = particle.state;
    const double room = room_for(rules.world, particle, duration * length(state.velocity));
    if (!(room > 0.0)) return std::nullopt;
    flight = first_flight(rules, particle, duration);
    const Path& path = flight->path;
    if (path.duration != duration || !can_be_followed(path)) return std::nullopt;
    if (!is_path_clear(rules.world, path, state.radius, room)) return std::nullopt;
    const bool is_recorded = scratch.record_segments || scratch.record_flown || scratch.record_motions;
    const std::optional<MovingParticle> before = is_recorded ? std::optional(particle) : std::nullopt;
    state.position = path.end;
    state.velocity = flight->end_velocity;
    state.time += duration;
    if (before) record(rules, *before, particle, *flight, scratch);
    MoveOutcome outcome;
    outcome.is_coarse = flight->is_coarse;
    return outcome;
}

}  // namespace ricochet
