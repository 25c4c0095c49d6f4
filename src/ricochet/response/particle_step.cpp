#include "ricochet/response/particle_step.h"

#include <algorithm>
#include <utility>

#include "ricochet/collision/safe_position.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {

std::optional<Contact> ParticleStep::follow(const Flight& flight, const LookAhead* look_ahead,
                                            const ContactCandidates& candidates) {
    const Path& path = flight.path;
    if (!can_follow(path)) return std::nullopt;
    const Vec3 departure = state().velocity;
    const Travel travelled = travel({path, state().radius, look_ahead, candidates});
    state().velocity = velocity_at(rules_.settings.integrator, rules_.forces, flight, travelled.elapsed);
    record_flown(path, travelled.elapsed, departure, true);
    if (look_ahead != nullptr && !travelled.found.contact && state().position == path.end) {
        const LookAheadResult& ahead = travelled.found.ahead;
        outcome_.free_for = std::max(0.0, ahead.free_until - path.duration);
        outcome_.candidates_for = std::max(0.0, ahead.candidates_until - path.duration);
        outcome_.candidates = ahead.candidates;
    }
    return travelled.found.contact;
}

std::optional<Contact> ParticleStep::follow(const Flight& flight) {
    if (!can_follow(flight.path)) return std::nullopt;
    const Vec3 departure = state().velocity;
    const Travel travelled = travel({flight.path, state().radius, nullptr, {}});
    state().velocity = velocity_at(rules_.settings.integrator, rules_.forces, flight, travelled.elapsed);
    record_flown(flight.path, travelled.elapsed, departure, false);
    return travelled.found.contact;
}

bool ParticleStep::can_follow(const Path& path) {
    if (can_be_followed(path)) return true;
    outcome_.end = MoveEnd::frozen;
    remaining_ = 0.0;
    return false;
}

/// The first contact of a path, and the certified segments to the safe position there or to the path's end.
ParticleStep::Travel ParticleStep::travel(const ContactQuery& query) {
    Travel travel{find_first_contact(geometry_, query, scratch_.contacts)};
    go(query, travel);
    return travel;
}

/// To the contact found, or to the end of the path.
void ParticleStep::go(const ContactQuery& query, Travel& travel) {
    const Path& path = query.path;
    const NearSurfaces& near = travel.found.near;
    std::optional<Contact>& contact = travel.found.contact;
    const bool starts_there =
        contact ? contact->time == 0.0 : query.radius > 0.0 && query.held.empty() && near.starts_in_overlap();
    if (starts_there && !near.surfaces_at(path.c[0]).empty()) {
        leave_surface(near);
        contact.reset();
        return;
    }
    if (contact) {
        stop_at_contact(query, travel);
    } else {
        const CertifiedPath followed = follow_freely(near, query);
        state().position = followed.reached;
        if (followed.blocker) contact = contact_with_blocker(near, path, followed);
    }
    record_chain();
    travel.elapsed = contact ? contact->time : path.duration;
    pass(travel.elapsed);
}

/// What blocks the way to the contact is met before.
void ParticleStep::stop_at_contact(const ContactQuery& query, Travel& travel) {
    std::optional<Contact>& contact = travel.found.contact;
    const NearSurfaces& near = travel.found.near;
    const SafePosition safe = find_safe_position(near, query.path, *contact, scratch_.contacts.chain);
    outcome_.stayed += safe.stayed ? 1 : 0;
    state().position = safe.position;
    if (query.held.empty() || !safe.blocker || safe.time >= contact->time) return;
    contact = contact_with_blocker(near, query.path, {safe.position, safe.time, safe.blocker});
}

/// Along a surface that bends away every chord of a point's path is blocked, or of a small sphere's, and its control
/// polygon is free.
CertifiedPath ParticleStep::follow_freely(const NearSurfaces& near, const ContactQuery& query) {
    const Path& path = query.path;
    std::vector<Vec3>& chain = scratch_.contacts.chain;
    const auto is_free_outside = [&] {
        if (query.held.empty() || path.degree != 3) return false;
        ControlPoints outside = path.control_points();
        outside.point[3] = path.end;
        for (std::size_t k = 1; k < 4; ++k) {
            if (!near.is_free(outside.point[k - 1], outside.point[k])) return false;
        }
        chain.assign(outside.begin(), outside.end());
        return true;
    };
    const CertifiedPath whole{path.end, path.duration, std::nullopt};
    if (query.radius == 0.0 && is_free_outside()) return whole;
    const CertifiedPath followed = follow_path(near, path, path.duration, path.end, chain);
    return query.radius > 0.0 && followed.blocker && is_free_outside() ? whole : followed;
}

void ParticleStep::wait(double duration) {
    pass(duration);
    record_flown(line_path(state().position, Vec3{}, duration), duration, Vec3{}, false);
}

void ParticleStep::pass(double duration) {
    state().time += duration;
    remaining_ = std::max(0.0, remaining_ - duration);
}

void ParticleStep::stop() {
    outcome_.unsimulated_time = remaining_;
    remaining_ = 0.0;
}

void ParticleStep::return_to_start() {
    state().position = start_;
    for (std::size_t k = scratch_.segments.size(); k-- > first_segment_;) {
        Segment back = scratch_.segments[k];
        std::swap(back.from, back.to);
        back.time = state().time;
        scratch_.segments.push_back(back);
    }
}

void ParticleStep::leave_surface(const NearSurfaces& near) {
    if (!step_off_surface(near, state(), scratch_)) {
        stop();
        return;
    }
    first_segment_ = scratch_.segments.size();
    start_ = state().position;
}

void ParticleStep::record_chain() {
    if (!scratch_.record_segments) return;
    const std::vector<Vec3>& chain = scratch_.contacts.chain;
    for (std::size_t k = 1; k < chain.size(); ++k) scratch_.segments.push_back({chain[k - 1], chain[k], state().time});
}

bool step_off_surface(const NearSurfaces& near, ForceInput& state, MoveScratch& scratch) {
    const auto position = step_off(near, state.position);
    if (!position) return false;
    if (scratch.record_segments) scratch.segments.push_back({state.position, *position, state.time});
    state.position = *position;
    return true;
}

}  // namespace ricochet
