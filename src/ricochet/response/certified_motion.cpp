#include "ricochet/response/certified_motion.h"

#include <utility>
#include <vector>

#include "ricochet/collision/obstacles.h"
#include "ricochet/collision/safe_position.h"
#include "ricochet/collision/surfaces_in_other_frames.h"
#include "ricochet/response/carried_particle.h"

namespace ricochet {
namespace {

/// Moves a particle off the surface on which it lies, along a segment that is free in all frames, if colliders move.
bool step_off_in_frame(ParticleStep& step, const NearSurfaces& near) {
    ForceInput& state = step.state();
    const auto position = step_off(near, state.position);
    if (!position) return false;
    const PathPoint to = near.point_at(*position, 0.0);
    if (!near.is_free_after(state.position, to.position)) return false;
    if (near.other_frames() != nullptr && !near.other_frames()->are_free(near.start(), to)) return false;
    step.chain().add({to.world, step.chain().stored().time}, state.time, step.scratch());
    state.position = to.position;
    return true;
}

void leave_surface(ParticleStep& step, const NearSurfaces& near) {
    const bool is_off =
        step.chain().is_timed() ? step_off_in_frame(step, near) : step_off_surface(near, step.state(), step.scratch());
    is_off ? step.chain().begin(step.state().position, step.scratch()) : give_up(step);
}

/// Moves to a safe position at the contact. If another surface blocks the path to it, that surface becomes the contact.
void stop_at_contact(ParticleStep& step, const ContactQuery& query, ContactQueryResult& found) {
    std::optional<Contact>& contact = found.contact;
    const NearSurfaces& near = found.near;
    const SafePosition safe = find_safe_position(near, query.path, *contact, step.scratch().contacts.chain);
    step.outcome().stayed += safe.stayed ? 1 : 0;
    step.state().position = safe.reached.position;
    const bool is_supported = !query.supports.empty() || near.other_frames() != nullptr;
    if (!is_supported || !safe.blocker || safe.reached.time >= contact->time) return;
    contact = contact_with_blocker(near, query.path, {safe.reached, safe.blocker});
}

/// Stores the control polygon of a path in the chain. Returns false if the polygon is not free. A convex surface blocks
/// the chords of a point's or small sphere's path along it, but not the control polygon.
bool is_polygon_free(const ParticleStep& step, const NearSurfaces& near, const ContactQuery& query) {
    const Path& path = query.path;
    if (query.supports.empty() || path.degree != 3) return false;
    std::vector<PathPoint>& chain = step.scratch().contacts.chain;
    ControlPoints outside = path.control_points();
    outside.point[3] = path.end;
    chain.assign(1, near.start());
    for (std::size_t k = 1; k < 4; ++k) {
        const double time = k < 3 ? static_cast<double>(k) / 3.0 * path.duration : path.duration;
        const PathPoint next = near.point_at(outside.point[k], time);
        if (!near.is_free(chain.back().position, next.position)) return false;
        // In other frames the polygon does not enclose the path, so each segment is tested against all colliders.
        if (const SurfacesInOtherFrames* const others = near.other_frames()) {
            const SurfacesInTime& surfaces = others->surfaces();
            const StoredPosition from = surfaces.stored_position(chain.back());
            if (!is_segment_free(surfaces.bodies(), from, surfaces.stored_position(next), query.radius)) return false;
        }
        chain.push_back(next);
    }
    return true;
}

CertifiedPath follow_to_end(const ParticleStep& step, const NearSurfaces& near, const ContactQuery& query) {
    std::vector<PathPoint>& chain = step.scratch().contacts.chain;
    const auto end_of_polygon = [&] { return CertifiedPath{chain.back(), std::nullopt}; };
    if (query.radius == 0.0 && is_polygon_free(step, near, query)) return end_of_polygon();
    const Path& path = query.path;
    const CertifiedPath followed = certify_path(near, path, path.duration, path.end, chain);
    if (!followed.blocker || query.radius == 0.0) return followed;
    std::vector<PathPoint> until_blocked = chain;
    if (is_polygon_free(step, near, query)) return end_of_polygon();
    chain.swap(until_blocked);
    return followed;
}

void record_chain(ParticleStep& step, const PathClock& clock) {
    MoveScratch& scratch = step.scratch();
    const std::vector<PathPoint>& chain = scratch.contacts.chain;
    const bool is_timed = step.chain().is_timed();
    const auto time_of = [&](const PathPoint& p) { return is_timed ? clock.at(p.time) : 0.0; };
    if (is_timed) step.chain().store({chain.back().world, time_of(chain.back())});
    if (!scratch.record_segments) return;
    for (std::size_t k = 1; k < chain.size(); ++k) {
        scratch.segments.push_back(
            {chain[k - 1].world, chain[k].world, step.state().time, time_of(chain[k - 1]), time_of(chain[k])});
    }
}

}  // namespace

double move_certified(ParticleStep& step, const ContactQuery& query, ContactQueryResult& found,
                      const PathClock& clock) {
    const Path& path = query.path;
    const NearSurfaces& near = found.near;
    std::optional<Contact>& contact = found.contact;
    const bool starts_on_surface =
        contact ? contact->time == 0.0 : query.radius > 0.0 && query.supports.empty() && near.starts_in_overlap();
    if (starts_on_surface && !near.surfaces_at(path.c[0]).empty()) {
        leave_surface(step, near);
        contact.reset();
        return 0.0;
    }
    if (contact) {
        stop_at_contact(step, query, found);
    } else {
        const CertifiedPath followed = follow_to_end(step, near, query);
        step.state().position = followed.reached.position;
        if (followed.blocker) contact = contact_with_blocker(near, path, followed);
    }
    record_chain(step, clock);
    return contact ? contact->time : path.duration;
}

void return_to_start(ParticleStep& step) {
    step.state().position = step.chain().start();
    step.chain().store({step.chain().start(), step.chain().stored().time});
    std::vector<Segment>& segments = step.scratch().segments;
    for (std::size_t k = segments.size(); k-- > step.chain().first_segment();) {
        Segment back = segments[k];
        std::swap(back.from, back.to);
        back.time = step.state().time;
        back.begin = back.end = step.chain().stored().time;
        segments.push_back(back);
    }
}

bool step_off_surface(const NearSurfaces& near, ForceInput& state, MoveScratch& scratch) {
    const auto position = step_off(near, state.position);
    if (!position) return false;
    if (scratch.record_segments) {
        scratch.segments.push_back({state.position, *position, state.time, state.time, state.time});
    }
    state.position = *position;
    return true;
}

}  // namespace ricochet
