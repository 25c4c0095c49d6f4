#include "ricochet/response/particle_step.h"

#include <algorithm>
#include <utility>

#include "ricochet/collision/safe_position.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {

std::optional<Contact> ParticleStep::follow(const Flight& flight, const Integrator& integrator,
                                            const LookAhead* look_ahead, const ContactCandidates& candidates) {
    const Path& path = flight.path;
    if (!can_follow(path)) return std::nullopt;
    if (is_among_bodies(path)) return follow_among_bodies(flight, integrator);
    const Vec3 separation_speed = state().velocity;
    const ContactQuery query{path, state().radius, look_ahead, candidates};
    ContactQueryResult found = find_first_contact(geometry_, query, scratch_.contacts);
    const double elapsed = go(query, found);
    state().velocity = velocity_at(integrator, rules_->forces, flight, elapsed);
    record_flown(path, elapsed, separation_speed, true);
    if (look_ahead != nullptr && !found.contact && state().position == path.end) {
        const LookAheadResult& ahead = found.ahead;
        outcome_.free_for = std::max(0.0, ahead.free_until - path.duration);
        outcome_.candidates_for = std::max(0.0, ahead.candidates_until - path.duration);
        outcome_.candidates = ahead.candidates;
    }
    return found.contact;
}

std::optional<Contact> ParticleStep::follow(const Flight& flight) {
    if (!can_follow(flight.path)) return std::nullopt;
    const Vec3 separation_speed = state().velocity;
    const ContactQuery query{flight.path, state().radius, nullptr, {}};
    ContactQueryResult found = find_first_contact(geometry_, query, scratch_.contacts);
    const double elapsed = go(query, found);
    state().velocity = velocity_at(rules_->settings.integrator, rules_->forces, flight, elapsed);
    record_flown(flight.path, elapsed, separation_speed, false);
    return found.contact;
}

bool ParticleStep::can_follow(const Path& path) {
    if (can_be_followed(path)) return true;
    outcome_.end = MoveEnd::frozen;
    remaining_ = 0.0;
    return false;
}

/// False where all that moves stays away from the path: it is followed as where nothing moves.
bool ParticleStep::is_among_bodies(const Path& path) const {
    if (rules_->bodies == nullptr) return false;
    return reference_.is_moving() || !rules_->bodies->all_stay_out(reach_of(path, particle_.state.radius));
}

/// To the contact found, or to the end of the path; what is met on the way is the contact then. s, that it has taken.
double ParticleStep::go(const ContactQuery& query, ContactQueryResult& found) {
    const double elapsed = go_along(query, found, rules_->bodies == nullptr ? PathClock{} : clock_of(query.path));
    pass(elapsed);
    return elapsed;
}

/// The same without its time. clock: of the path; matters where something moves.
double ParticleStep::go_along(const ContactQuery& query, ContactQueryResult& found, const PathClock& clock) {
    const Path& path = query.path;
    const NearSurfaces& near = found.near;
    std::optional<Contact>& contact = found.contact;
    const bool starts_there =
        contact ? contact->time == 0.0 : query.radius > 0.0 && query.supports.empty() && near.starts_in_overlap();
    if (starts_there && !near.surfaces_at(path.c[0]).empty()) {
        leave_surface(near);
        contact.reset();
        return 0.0;
    }
    if (contact) {
        stop_at_contact(query, found);
    } else {
        const CertifiedPath followed = follow_freely(near, query);
        state().position = followed.reached.position;
        if (followed.blocker) contact = contact_with_blocker(near, path, followed);
    }
    record_chain(clock);
    return contact ? contact->time : path.duration;
}

/// What blocks the way to the contact is met before.
void ParticleStep::stop_at_contact(const ContactQuery& query, ContactQueryResult& found) {
    std::optional<Contact>& contact = found.contact;
    const NearSurfaces& near = found.near;
    const SafePosition safe = find_safe_position(near, query.path, *contact, scratch_.contacts.chain);
    outcome_.stayed += safe.stayed ? 1 : 0;
    state().position = safe.reached.position;
    const bool is_held = !query.supports.empty() || near.other_frames() != nullptr;
    if (!is_held || !safe.blocker || safe.reached.time >= contact->time) return;
    contact = contact_with_blocker(near, query.path, {safe.reached, safe.blocker});
}

/// Along a surface that bends away every chord of a point's path is blocked, or of a small sphere's, and its control
/// polygon is free.
CertifiedPath ParticleStep::follow_freely(const NearSurfaces& near, const ContactQuery& query) {
    const Path& path = query.path;
    std::vector<PathPoint>& chain = scratch_.contacts.chain;
    const auto is_free_outside = [&] {
        if (query.supports.empty() || path.degree != 3) return false;
        ControlPoints outside = path.control_points();
        outside.point[3] = path.end;
        chain.assign(1, near.start());
        for (std::size_t k = 1; k < 4; ++k) {
            const double time = k < 3 ? static_cast<double>(k) / 3.0 * path.duration : path.duration;
            const PathPoint next = near.point_at(outside.point[k], time);
            if (!near.is_free(chain.back().position, next.position)) return false;
            // In other frames it is no hull of the path, near which alone their surfaces are known.
            if (near.other_frames() != nullptr && !is_segment_free(*near.other_frames(), chain.back(), next))
                return false;
            chain.push_back(next);
        }
        return true;
    };
    const auto end_of_chain = [&] { return CertifiedPath{chain.back(), std::nullopt}; };
    if (query.radius == 0.0 && is_free_outside()) return end_of_chain();
    const CertifiedPath followed = follow_path(near, path, path.duration, path.end, chain);
    if (!followed.blocker || query.radius == 0.0) return followed;
    std::vector<PathPoint> until_there = chain;
    if (is_free_outside()) return end_of_chain();
    chain.swap(until_there);
    return followed;
}

std::optional<Contact> ParticleStep::wait(double duration, std::span<const SurfaceId> supports) {
    const Path here = line_path(state().position, Vec3{}, duration);
    if (!is_among_bodies(here)) {
        stay_until(clock_of(here).end);
        pass(duration);
        record_flown(here, duration, Vec3{}, false);
        return std::nullopt;
    }
    const Travel travelled = travel_among_bodies({here, state().radius, nullptr, {}, supports});
    if (!travelled.contact) state().position = here.end;  // bit by bit, wherever its frame goes
    record_flown(here, travelled.elapsed, Vec3{}, false);
    return travelled.contact;
}

/// Nothing that moves comes near until then, s.
void ParticleStep::stay_until(double until) {
    if (rules_->bodies == nullptr) return;
    if (scratch_.record_segments) {
        scratch_.segments.push_back({stored_.position, stored_.position, stored_.time, stored_.time, until});
    }
    stored_.time = until;
}

void ParticleStep::go_clear(const Path& line) {
    const double end = clock_of(line).end;
    if (scratch_.record_segments) {
        scratch_.segments.push_back({line.c[0], line.end, state().time, stored_.time, end});
    }
    if (scratch_.record_flown) {
        scratch_.flown.push_back({line, state().time, line.duration, line.c[1], line.c[1], false});
    }
    stored_ = {line.end, end};
    state().position = line.end;
    pass(line.duration);
}

void ParticleStep::pass(double duration) {
    state().time += duration;
    remaining_ = std::max(0.0, remaining_ - duration);
}

void ParticleStep::stop() {
    outcome_.unsimulated_time = remaining_;
    if (!is_near_bodies()) {
        stay_until(particle_.step_end);
    } else if (!wait_out(particle_.step_end)) {
        outcome_.squeezed = 1;
    }
    remaining_ = 0.0;
}

void ParticleStep::return_to_start() {
    state().position = start_;
    stored_.position = start_;
    for (std::size_t k = scratch_.segments.size(); k-- > first_segment_;) {
        Segment back = scratch_.segments[k];
        std::swap(back.from, back.to);
        back.time = state().time;
        back.begin = back.end = stored_.time;
        scratch_.segments.push_back(back);
    }
}

void ParticleStep::leave_surface(const NearSurfaces& near) {
    if (!(rules_->bodies == nullptr ? step_off_surface(near, state(), scratch_) : step_off_in_frame(near))) {
        stop();
        return;
    }
    first_segment_ = scratch_.segments.size();
    start_ = state().position;
}

/// Where colliders move: by a link that is free in all frames, after it has left the surface in its own.
bool ParticleStep::step_off_in_frame(const NearSurfaces& near) {
    const auto position = step_off(near, state().position);
    if (!position) return false;
    const PathPoint to = near.point_at(*position, 0.0);
    if (!near.is_free_after(state().position, to.position)) return false;
    if (near.other_frames() != nullptr && !near.other_frames()->are_free(near.start(), to)) return false;
    if (scratch_.record_segments) {
        scratch_.segments.push_back({stored_.position, to.world, state().time, stored_.time, stored_.time});
    }
    stored_.position = to.world;
    state().position = to.position;
    return true;
}

void ParticleStep::record_chain(const PathClock& clock) {
    const std::vector<PathPoint>& chain = scratch_.contacts.chain;
    const bool is_timed = rules_->bodies != nullptr;
    const auto time_of = [&](const PathPoint& p) { return is_timed ? clock.at(p.time) : 0.0; };
    if (is_timed) stored_ = {chain.back().world, time_of(chain.back())};
    if (!scratch_.record_segments) return;
    for (std::size_t k = 1; k < chain.size(); ++k) {
        scratch_.segments.push_back(
            {chain[k - 1].world, chain[k].world, state().time, time_of(chain[k - 1]), time_of(chain[k])});
    }
}

bool step_off_surface(const NearSurfaces& near, ForceInput& state, MoveScratch& scratch) {
    const auto position = step_off(near, state.position);
    if (!position) return false;
    if (scratch.record_segments)
        scratch.segments.push_back({state.position, *position, state.time, state.time, state.time});
    state.position = *position;
    return true;
}

}  // namespace ricochet
