#include "ricochet/response/path_motion.h"

#include <algorithm>

#include "ricochet/collision/moving_sweep.h"
#include "ricochet/response/carried_particle.h"
#include "ricochet/response/certified_motion.h"

namespace ricochet {
namespace {

struct PathProgress {
    std::optional<Contact> contact{};
    double elapsed = 0.0;  ///< s
};

/// Returns true if the path can be followed. Otherwise freezes the particle.
bool can_follow(ParticleStep& step, const Path& path) {
    if (can_be_followed(path)) return true;
    step.outcome().end = MoveEnd::frozen;
    step.end();
    return false;
}

SurfacesInTime surfaces_along(const ParticleStep& step, const Path& path) {
    return {step.rules().bodies, step.reference().body(), step.clock_of(path)};
}

std::optional<Contact> first_contact_among_bodies(ParticleStep& step, const ContactQuery& query) {
    const SurfacesInTime surfaces = surfaces_along(step, query.path);
    const PathPoint start = surfaces.stored(step.chain().stored().position);
    return MovingSweep(surfaces, step.geometry(), query, start, step.scratch().contacts).first_contact();
}

/// Follows a path among moving colliders, piece by piece, up to a contact. Does not advance the particle's time.
PathProgress follow_among_bodies(ParticleStep& step, const ContactQuery& query) {
    const SurfacesInTime surfaces = surfaces_along(step, query.path);
    const PathPoint start = surfaces.stored(step.chain().stored().position);
    MovingSweep sweep(surfaces, step.geometry(), query, start, step.scratch().contacts);
    PathProgress progress;
    while (!sweep.is_done() && !progress.contact) {
        const double begin = sweep.begin();
        ContactQueryResult found = sweep.sweep(surfaces.stored(step.chain().stored().position, begin));
        const ContactQuery of_piece{sweep.path(), query.radius, nullptr, {}, query.supports};
        const double elapsed = move_certified(step, of_piece, found, sweep.clock());
        if (found.contact) progress.contact = found.contact;
        const bool has_gone = elapsed >= sweep.path().duration;
        progress.elapsed = has_gone ? sweep.begin() : begin + elapsed;
        if (progress.contact) progress.contact->time = progress.elapsed;
        if (!has_gone) break;
    }
    return progress;
}

/// Records a piece of a path in the frame of a body, as the cubic through both ends in the world.
void record_flown_in_world(ParticleStep& step, const Path& path, double duration, const Vec3& initial_velocity) {
    const ForceInput& state = step.state();
    const ReferenceFrame& frame = step.reference();
    const double time = state.time - duration;
    const RecordedMotion begin = frame.in_world({path.c[0], initial_velocity, {}}, time);
    const RecordedMotion end = frame.in_world({path.position(duration), state.velocity, {}}, state.time);
    const Path in_world = duration > 0.0
                              ? hermite_path(begin.position, begin.velocity, end.position, end.velocity, duration)
                              : line_path(begin.position, begin.velocity, 0.0);
    step.scratch().flown.push_back({in_world, time, duration, begin.velocity, end.velocity, false});
}

/// Records the piece of a path that the particle has just followed, if MoveScratch::record_flown is set.
void record_flown(ParticleStep& step, const Path& path, double duration, const Vec3& initial_velocity, bool is_free) {
    if (!step.scratch().record_flown) return;
    if (step.reference().is_moving()) {
        record_flown_in_world(step, path, duration, initial_velocity);
        return;
    }
    const ForceInput& state = step.state();
    step.scratch().flown.push_back({path, state.time - duration, duration, initial_velocity, state.velocity, is_free});
}

}  // namespace

std::optional<Contact> follow_flight(ParticleStep& step, const Flight& flight, const Integrator& integrator,
                                     const LookAhead* look_ahead, const ContactCandidates& candidates) {
    const Path& path = flight.path;
    if (!can_follow(step, path)) return std::nullopt;
    ForceInput& state = step.state();
    const Vec3 initial_velocity = state.velocity;
    const auto finish = [&](double elapsed) {
        step.pass(elapsed);
        state.velocity = velocity_at(integrator, step.rules().forces, flight, elapsed);
        record_flown(step, path, elapsed, initial_velocity, true);
    };
    if (step.is_among_bodies(path)) {
        const PathProgress progress = follow_among_bodies(step, {path, state.radius, nullptr, {}});
        finish(progress.elapsed);
        if (!progress.contact) return std::nullopt;  // a contact is large to copy
        return progress.contact;
    }
    const ContactQuery query{path, state.radius, look_ahead, candidates};
    ContactQueryResult found = find_first_contact(step.geometry(), query, step.scratch().contacts);
    finish(move_certified(step, query, found,
                          step.clock_of(query.path)));  // a surface that blocks the path can replace found.contact
    if (look_ahead != nullptr && !found.contact && state.position == path.end) {
        MoveOutcome& outcome = step.outcome();
        outcome.free_for = std::max(0.0, found.ahead.free_until - path.duration);
        outcome.candidates_for = std::max(0.0, found.ahead.candidates_until - path.duration);
        outcome.candidates = found.ahead.candidates;
    }
    return found.contact;
}

std::optional<Contact> follow_path(ParticleStep& step, const Path& path, std::span<const SurfaceId> supports,
                                   const PathRefinement& refine) {
    if (!can_follow(step, path)) return std::nullopt;
    ForceInput& state = step.state();
    const Vec3 initial_velocity = state.velocity;
    Path followed = path;
    const ContactQuery query{followed, state.radius, nullptr, {}, supports};
    const auto is_refined = [&](const std::optional<Contact>& contact) {
        const std::optional<Path> next = contact && refine ? refine(contact->time, followed) : std::nullopt;
        // A cubic of almost zero duration has coefficients that are too large. The longer path is accurate enough.
        if (!next || !can_be_followed(*next)) return false;
        followed = *next;
        return true;
    };
    const auto finish = [&](double elapsed) {
        step.pass(elapsed);
        state.velocity = followed.velocity(elapsed);
        record_flown(step, followed, elapsed, initial_velocity, false);
    };
    if (step.is_among_bodies(followed)) {
        while (is_refined(first_contact_among_bodies(step, query))) {
        }
        const PathProgress progress = follow_among_bodies(step, query);
        finish(progress.elapsed);
        return progress.contact;
    }
    ContactQueryResult found = find_first_contact(step.geometry(), query, step.scratch().contacts);
    while (is_refined(found.contact)) found = find_first_contact(step.geometry(), query, step.scratch().contacts);
    finish(move_certified(step, query, found, step.clock_of(query.path)));
    return found.contact;
}

void follow_clear_path(ParticleStep& step, const Path& line) {
    const double end = step.clock_of(line).end;
    ForceInput& state = step.state();
    MoveScratch& scratch = step.scratch();
    if (scratch.record_segments) {
        scratch.segments.push_back({line.c[0], line.end, state.time, step.chain().stored().time, end});
    }
    if (scratch.record_flown) {
        scratch.flown.push_back({line, state.time, line.duration, line.c[1], line.c[1], false});
    }
    step.chain().store({line.end, end});
    state.position = line.end;
    step.pass(line.duration);
}

std::optional<Contact> wait_in_place(ParticleStep& step, double duration, std::span<const SurfaceId> supports) {
    ForceInput& state = step.state();
    const Path here = line_path(state.position, Vec3{}, duration);
    if (!step.is_among_bodies(here)) {
        stay_until(step, step.clock_of(here).end);
        step.pass(duration);
        record_flown(step, here, duration, Vec3{}, false);
        return std::nullopt;
    }
    const PathProgress progress = follow_among_bodies(step, {here, state.radius, nullptr, {}, supports});
    step.pass(progress.elapsed);
    if (!progress.contact) state.position = here.end;  // exact to the last bit, however its frame moves
    record_flown(step, here, progress.elapsed, Vec3{}, false);
    return progress.contact;
}

std::optional<Contact> first_contact_of_ball(ParticleStep& step, const Path& path, double radius,
                                             std::span<const SurfaceId> supports) {
    return first_contact_among_bodies(step, {path, radius, nullptr, {}, supports});
}

}  // namespace ricochet
