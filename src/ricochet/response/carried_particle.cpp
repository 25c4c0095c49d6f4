#include "ricochet/response/carried_particle.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "ricochet/collision/clearance.h"
#include "ricochet/collision/obstacles.h"
#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"

namespace ricochet {
namespace {

const MovingColliders& bodies_of(const ParticleStep& step) { return step.rules().bodies; }
double radius_of(const ParticleStep& step) { return step.state().radius; }
const StoredPosition& stored_of(const ParticleStep& step) { return step.chain().stored(); }

Vec3 stored_position_in(const ParticleStep& step, BodyId body) {
    return bodies_of(step).local_position(body, stored_of(step).position, stored_of(step).time);
}

/// Moves the stored position along a segment. Returns false if the segment is not free.
bool take_segment(ParticleStep& step, const StoredPosition& next) {
    if (!is_segment_free(bodies_of(step), stored_of(step), next, radius_of(step))) return false;
    step.chain().add(next, stored_of(step).time, step.scratch());
    return true;
}

/// Carries the particle with a collider until a given time, or until a surface blocks the next segment.
/// carried_position(time) is the position to which a body, or a triangle of a deforming mesh, carries the particle.
/// Halves a blocked segment up to `depth` times. Segments end at the key times of deforming meshes.
template <class CarriedPosition>
bool carry_until(ParticleStep& step, const CarriedPosition& carried_position, double until, int depth) {
    const double key = bodies_of(step).deforming().next_key(stored_of(step).time);
    if (key < until) {
        return carry_until(step, carried_position, key, depth) && carry_until(step, carried_position, until, depth);
    }
    if (take_segment(step, {carried_position(until), until})) return true;
    const double middle = 0.5 * (stored_of(step).time + until);
    if (depth == 0 || !(middle > stored_of(step).time) || !(middle < until)) return false;
    return carry_until(step, carried_position, middle, depth - 1) &&
           carry_until(step, carried_position, until, depth - 1);
}

/// Carries the particle with a body. With the world body the particle keeps its position.
bool carry_with_body(ParticleStep& step, BodyId body, double until) {
    const Vec3 local_position = stored_position_in(step, body);
    const auto carried_position = [&](double time) {
        if (body == kWorldBody) return stored_of(step).position;
        return flush_tiny(bodies_of(step).pose(body, time).point(local_position));
    };
    return carry_until(step, carried_position, until, kCarryDepth);
}

/// Returns the position at time `until` of a particle that a deforming triangle carries. It keeps its distance from the
/// nearest point of the triangle. A sphere that overlaps by rounding is moved off it.
Vec3 carried_by_triangle(const ParticleStep& step, SurfaceId surface, double until) {
    const Vec3& from = stored_of(step).position;
    const DeformedTriangle now = bodies_of(step).deforming().triangle_at(surface, stored_of(step).time);
    const DeformedTriangle later = bodies_of(step).deforming().triangle_at(surface, until);
    const ClosestPointOnTriangle closest = closest_point_on_triangle(from, now.a, now.b, now.c);
    const Vec3 moved = from + now.displacement_of(from, later);
    const double radius = radius_of(step);
    double distance = std::sqrt(closest.distance_squared);
    if (distance >= radius - sphere_tolerance(radius, max_abs(moved))) distance = std::max(distance, radius);
    const CollisionWorld::Nearest nearest = later.nearest(moved);
    const Vec3 normal = dot(nearest.normal, closest.offset) < 0.0 ? -nearest.normal : nearest.normal;
    return flush_tiny(moved + (distance - nearest.distance) * normal);
}

/// Carries the particle with each nearby deforming triangle in turn.
void carry_with_meshes(ParticleStep& step, double until) {
    const DeformingColliders& deforming = bodies_of(step).deforming();
    const double radius = radius_of(step);
    const Vec3& position = stored_of(step).position;
    const double beside =
        2.0 * kEdgeOffsets * contact_offset(position) + 2.0 * sphere_tolerance(radius, max_abs(position));
    std::vector<SurfaceId> near;
    deforming.near(ball_box(position, radius + beside), near);
    for (const SurfaceId surface : near) {
        if (stored_of(step).time >= until) break;
        const DeformedTriangle now = deforming.triangle_at(surface, stored_of(step).time);
        const double offset = kEdgeOffsets * deforming.mesh_with(surface).offset();
        if (now.nearest(stored_of(step).position).distance > radius + std::max(beside, offset)) continue;
        const auto carried_position = [&](double time) { return carried_by_triangle(step, surface, time); };
        static_cast<void>(carry_until(step, carried_position, until, kCarryDepth));
    }
}

/// Keeps the particle at its position, or carries it with one collider after another, until surfaces block them all.
void carry_by_turns(ParticleStep& step, double until) {
    constexpr int kMostTurns = 8;
    const BodyId own = step.reference().body();
    for (int turn = 0; turn < kMostTurns; ++turn) {
        const double before = stored_of(step).time;
        if (carry_with_body(step, own, until)) break;
        if (step.reference().is_moving() && carry_with_body(step, kWorldBody, until)) break;
        for (BodyId body = 0; body < bodies_of(step).size() && stored_of(step).time < until; ++body) {
            if (body != own) static_cast<void>(carry_with_body(step, body, until));
        }
        if (stored_of(step).time < until) carry_with_meshes(step, until);
        if (stored_of(step).time >= until || stored_of(step).time == before) break;
    }
}

/// Returns a bound of the rounding error, in m, of stored positions in a body's frame until a given time.
double rounding_in(const ParticleStep& step, BodyId body, double until) {
    double rounding = ulp(max_abs(stored_of(step).position));
    if (body == kWorldBody) return rounding;
    const Vec3 local_position = stored_position_in(step, body);
    rounding = std::max(rounding, ulp(max_abs(local_position)));
    for (const double time : {stored_of(step).time, until}) {
        const MovingPose pose = bodies_of(step).pose(body, time);
        const Vec3 world = pose.point(local_position);
        const double largest = std::max(max_abs(world), max_abs(pose.world_from_frame.translation));
        rounding = std::max({rounding, ulp(largest), max_abs(pose.local_position(world) - local_position)});
    }
    return rounding;
}

/// Moves the particle, in zero time, away from the surfaces of a body that are nearer than the clearance, in m.
bool step_aside(ParticleStep& step, BodyId body, double clearance) {
    const MovingColliders& bodies = bodies_of(step);
    const StoredPosition& stored = stored_of(step);
    const Vec3 local_position = stored_position_in(step, body);
    const auto displacement = displacement_to_clear(bodies.world(body), local_position, radius_of(step), clearance);
    if (!displacement) return false;
    const Vec3 aside = local_position + *displacement;
    const Vec3 in_world = body == kWorldBody ? aside : bodies.pose(body, stored.time).point(aside);
    if (!take_segment(step, {flush_tiny(in_world), stored.time})) return false;
    step.particle().attachment.reset();  // the particle has left its rest position
    return true;
}

/// Moves the particle to a position with more clearance, and carries it from there. Stored positions are rounded in
/// world coordinates, so a carried position in a narrow gap may lie behind a surface.
void carry_with_clearance(ParticleStep& step, double until) {
    for (const double roundings : kCarryingClearances) {
        const auto try_body = [&](BodyId body) {
            if (stored_of(step).time < until && step_aside(step, body, roundings * rounding_in(step, body, until))) {
                static_cast<void>(carry_with_body(step, body, until));
            }
        };
        try_body(kWorldBody);
        for (BodyId body = 0; body < bodies_of(step).size(); ++body) try_body(body);
        if (stored_of(step).time >= until) return;
    }
}

/// Lets the particle wait until a given time, at its position or carried by a collider. Returns false if surfaces block
/// both. The particle's stored time then stops before `until`.
bool wait_until(ParticleStep& step, double until) {
    step.scratch().driven = true;
    carry_by_turns(step, until);
    if (stored_of(step).time < until) carry_with_clearance(step, until);
    step.state().position = stored_position_in(step, step.reference().body());
    return stored_of(step).time >= until;
}

/// Moves a stalled particle to a position at the current time, if the segment to it is free.
bool take_late_segment(ParticleStep& step, const Vec3& position) {
    const StoredPosition next{flush_tiny(position), step.state().time};
    if (!is_late_segment_free(bodies_of(step), stored_of(step), next, radius_of(step))) return false;
    step.chain().add(next, stored_of(step).time, step.scratch());
    step.particle().attachment.reset();
    return true;
}

/// Moves a stalled particle from its stored time to its current time in one segment. A chain of segments would be
/// blocked where deforming meshes left no space. The new position is the stored one, or the position to which a body or
/// a near triangle has carried it.
bool catch_up_directly(ParticleStep& step) {
    constexpr std::size_t kMostTriangles = 8;
    const MovingColliders& bodies = bodies_of(step);
    if (bodies.deforming().empty()) return false;
    const double now = step.state().time;
    if (take_late_segment(step, stored_of(step).position)) return true;
    for (BodyId body = 0; body < bodies.size(); ++body) {
        if (take_late_segment(step, bodies.pose(body, now).point(stored_position_in(step, body)))) return true;
    }
    std::vector<SurfaceId> nearest;
    bodies.deforming().nearest_to(stored_of(step).position, stored_of(step).time, kMostTriangles, nearest);
    return std::ranges::any_of(
        nearest, [&](SurfaceId surface) { return take_late_segment(step, carried_by_triangle(step, surface, now)); });
}

}  // namespace

void shift_to(ParticleStep& step, const Vec3& position) {
    if (take_segment(step, {position, stored_of(step).time})) step.state().position = position;
}

void keep_stored_position(ParticleStep& step) {
    if (!step.chain().is_timed()) return;
    step.state().position = stored_of(step).position;
    step.particle().stored_time = stored_of(step).time;
}

void stay_until(ParticleStep& step, double until) {
    if (!step.chain().is_timed()) return;
    step.chain().add({stored_of(step).position, until}, stored_of(step).time, step.scratch());
}

void give_up(ParticleStep& step) {
    step.outcome().unsimulated_time = step.remaining();
    const double end = step.particle().step_end;
    if (!step.is_near_bodies()) {
        stay_until(step, end);
    } else if (!wait_until(step, end)) {
        step.outcome().squeezed = 1;
    }
    step.end();
}

bool catch_up(ParticleStep& step) {
    const double now = step.state().time;
    if (!step.chain().is_timed() || !(stored_of(step).time < now)) return true;
    if (wait_until(step, now)) return true;
    if (catch_up_directly(step)) {
        step.state().position = stored_of(step).position;
        return true;
    }
    step.outcome().unsimulated_time = step.remaining();
    step.outcome().squeezed = 1;
    step.end();
    return false;
}

}  // namespace ricochet
