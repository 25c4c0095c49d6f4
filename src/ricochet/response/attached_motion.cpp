// A particle among colliders that move: its way in their frames, and what it does where they leave it no room.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "ricochet/collision/clearance.h"
#include "ricochet/collision/obstacles.h"
#include "ricochet/collision/surfaces_in_other_frames.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/response/particle_step.h"

namespace ricochet {
namespace {}  // namespace

PathClock ParticleStep::clock_of(const Path& path) const {
    const double now = particle_.state.time;
    const double end =
        path.duration >= remaining_ ? particle_.step_end : std::min(now + path.duration, particle_.step_end);
    return {stored_.time, std::max(end, stored_.time), now, 0.0, path.duration};
}

std::optional<Contact> ParticleStep::first_contact_among_bodies(const ContactQuery& query) {
    const MovingView view = view_of(query.path);
    return MovingSweep(view, geometry_, query, here(view), scratch_.contacts).first_contact();
}

std::optional<Contact> ParticleStep::follow_among_bodies(const Flight& flight, const Integrator& integrator) {
    const Vec3 separation_speed = state().velocity;
    const Travel travelled = travel_among_bodies({flight.path, state().radius, nullptr, {}});
    state().velocity = velocity_at(integrator, rules_->forces, flight, travelled.elapsed);
    record_flown(flight.path, travelled.elapsed, separation_speed, true);
    if (!travelled.contact) return std::nullopt;  // what is copied here is large
    return travelled.contact;
}

/// Piece by piece, up to a contact.
ParticleStep::Travel ParticleStep::travel_among_bodies(const ContactQuery& query) {
    const MovingView view = view_of(query.path);
    MovingSweep sweep(view, geometry_, query, here(view), scratch_.contacts);
    Travel travel;
    while (!sweep.is_done() && !travel.contact) {
        const double begin = sweep.begin();
        ContactQueryResult found = sweep.sweep(view.stored(stored_.position, begin));
        const double elapsed =
            go_along({sweep.path(), query.radius, nullptr, {}, query.supports}, found, sweep.clock());
        if (found.contact) travel.contact = found.contact;
        const bool has_gone = elapsed >= sweep.path().duration;
        travel.elapsed = has_gone ? sweep.begin() : begin + elapsed;
        if (travel.contact) travel.contact->time = travel.elapsed;
        if (!has_gone) break;
    }
    pass(travel.elapsed);
    return travel;
}

void ParticleStep::enter(BodyId body, const ResponseRules& rules, Contact* contact) {
    const ReferenceFrame before = reference_;
    reference_.set(body);
    rules_ = &rules;
    const RecordedMotion motion = reference_.in_frame(
        before.in_world({state().position, state().velocity, particle_.spin}, state().time), state().time);
    state().position = reference_.bodies().pose(body, stored_.time).local_position(stored_.position);
    state().velocity = motion.velocity;
    particle_.spin = motion.spin;
    // The world's coordinates are what is stored: contact is felt as they are rounded, and a carried place stays off.
    const MotionBounds& bounds = reference_.bodies().bounds(body);
    const double path_length = remaining_ * (bounds.origin[1] + bounds.rotation[1] * length(state().position));
    const MovingPose pose = reference_.bodies().pose(body, stored_.time);
    const double reach = max_abs(stored_.position) + path_length + max_abs(pose.world_from_frame.translation);
    double least_offset = contact_offset({reach, 0.0, 0.0});
    if (reference_.bodies().is_dynamic(body)) {
        least_offset = std::max(least_offset, offset_for_carrying(pose, state().position));
    }
    geometry_ = SurfaceGeometry(rules.world, scratch_.contacts.plane_cache, least_offset);
    start_ = state().position;
    first_segment_ = scratch_.segments.size();
    turn_contact(contact, before, reference_);
}

void ParticleStep::leave(const ResponseRules& rules, Contact* contact) {
    const ReferenceFrame before = reference_;
    // At a key, as the body moved before it.
    const bool is_at_key = substep_end_ && remaining_ <= 0.0;
    const double time = is_at_key ? std::nextafter(*substep_end_, 0.0) : state().time;
    const RecordedMotion motion = before.in_world({state().position, state().velocity, particle_.spin}, time);
    reference_.set(kWorldBody);
    scratch_.driven = true;  // to and fro between frames it is rounded
    rules_ = &rules;
    state().position = stored_.position;
    state().velocity = motion.velocity;
    particle_.spin = motion.spin;
    geometry_ = SurfaceGeometry(rules.world, scratch_.contacts.plane_cache);
    start_ = state().position;
    first_segment_ = scratch_.segments.size();
    turn_contact(contact, before, reference_);
}

/// What others that it is joined with see: the cubic through both ends.
void ParticleStep::record_flown_in_world(const Path& path, double duration, const Vec3& separation_speed) {
    const double time = state().time - duration;
    const RecordedMotion begin = reference_.in_world({path.c[0], separation_speed, {}}, time);
    const RecordedMotion end = reference_.in_world({path.position(duration), state().velocity, {}}, state().time);
    const Path seen = duration > 0.0
                          ? hermite_path(begin.position, begin.velocity, end.position, end.velocity, duration)
                          : line_path(begin.position, begin.velocity, 0.0);
    scratch_.flown.push_back({seen, time, duration, begin.velocity, end.velocity, false});
}

void ParticleStep::begin_substep(double until) {
    // Beyond the step's end bodies that are pushed may yet get other paths.
    until = std::min(until, particle_.step_end);
    substep_end_ = until;
    const double part = std::clamp(until - state().time, 0.0, remaining_);
    rest_after_substep_ = remaining_ - part;
    remaining_ = part;
    whole_step_end_ = std::exchange(particle_.step_end, until);
}

void ParticleStep::end_substep() {
    if (!substep_end_) return;
    if (remaining_ <= 0.0) state().time = *substep_end_;
    remaining_ += rest_after_substep_;
    particle_.step_end = whole_step_end_;
    substep_end_.reset();
}

void ParticleStep::turn_contact(Contact* contact, const ReferenceFrame& from, const ReferenceFrame& to) const {
    for (int k = 0; contact != nullptr && k < contact->count; ++k) {
        Vec3& normal = contact->surfaces[static_cast<std::size_t>(k)].normal;
        const double time = particle_.state.time;
        normal = to.direction_in_frame(from.direction_in_world(normal, time), time);
    }
}

/// Exact, in the frames of all colliders.
bool ParticleStep::is_segment_free(const StoredPosition& from, const StoredPosition& to) const {
    return is_segment_free_of_bodies(from, to) &&
           rules_->bodies->deforming().is_segment_free(from, to, particle_.state.radius);
}

/// The same in the frames of those that move rigidly, and of those at rest.
bool ParticleStep::is_segment_free_of_bodies(const StoredPosition& from, const StoredPosition& to) const {
    const MovingColliders& bodies = *rules_->bodies;
    const double radius = particle_.state.radius;
    const auto is_free_in = [&](BodyId body) {
        const CollisionWorld& world = bodies.world(body);
        if (world.empty()) return true;
        const Vec3 p = body == kWorldBody ? from.position : bodies.pose(body, from.time).local_position(from.position);
        const Vec3 q = body == kWorldBody ? to.position : bodies.pose(body, to.time).local_position(to.position);
        return !Obstacles(world, p, radius).block(q);
    };
    for (BodyId body = 0; body < bodies.size(); ++body) {
        if (!is_free_in(body)) return false;
    }
    return is_free_in(kWorldBody);
}

/// What is next to a mesh that deforms goes with the point of it that is nearest, at the same distance; what overlaps
/// it by rounding comes off it.
Vec3 ParticleStep::carried_by_mesh(SurfaceId surface, double until) const {
    const DeformingColliders& deforming = rules_->bodies->deforming();
    const auto [a, b, c] = deforming.corners_at(surface, stored_.time);
    const ClosestPointOnTriangle closest = closest_point_on_triangle(stored_.position, a, b, c);
    const Vec3 weights = barycentric_coordinates(closest, a, b, c);
    const std::array<Vec3, 3> later = deforming.corners_at(surface, until);
    const Vec3 path_length = weights.x * (later[0] - a) + weights.y * (later[1] - b) + weights.z * (later[2] - c);
    const Vec3 moved = stored_.position + path_length;
    double distance = std::sqrt(closest.distance_squared);
    const double radius = particle_.state.radius;
    if (distance >= radius - sphere_tolerance(radius, max_abs(moved))) distance = std::max(distance, radius);
    const CollisionWorld::Nearest nearest = deforming.nearest(surface, moved, until);
    const Vec3 normal = dot(nearest.normal, closest.offset) < 0.0 ? -nearest.normal : nearest.normal;
    return flush_tiny(moved + (distance - nearest.distance) * normal);
}

/// Goes with a mesh that deforms until a time, as far as links are free.
bool ParticleStep::carry_by_mesh(SurfaceId surface, double until, int depth) {
    const double key = rules_->bodies->deforming().next_key(stored_.time);
    if (key < until) return carry_by_mesh(surface, key, depth) && carry_by_mesh(surface, until, depth);
    if (take_segment({carried_by_mesh(surface, until), until})) return true;
    const double middle = 0.5 * (stored_.time + until);
    if (depth == 0 || !(middle > stored_.time) || !(middle < until)) return false;
    return carry_by_mesh(surface, middle, depth - 1) && carry_by_mesh(surface, until, depth - 1);
}

/// By each of the triangles that it is next to, by turns.
bool ParticleStep::carry_by_meshes(double until) {
    const DeformingColliders& deforming = rules_->bodies->deforming();
    const double radius = particle_.state.radius;
    const double beside = 2.0 * kEdgeOffsets * contact_offset(stored_.position) +
                          2.0 * sphere_tolerance(radius, max_abs(stored_.position));
    const Vec3 reach{radius + beside, radius + beside, radius + beside};
    std::vector<SurfaceId> near;
    deforming.near({stored_.position - reach, stored_.position + reach}, near);
    for (const SurfaceId surface : near) {
        if (stored_.time >= until) break;
        const double distance = deforming.nearest(surface, stored_.position, stored_.time).distance;
        if (distance <= radius + std::max(beside, kEdgeOffsets * deforming.offset_of(surface))) {
            static_cast<void>(carry_by_mesh(surface, until, kCarryDepth));
        }
    }
    return stored_.time >= until;
}

/// Moves it along a link, where that is free.
bool ParticleStep::take_segment(const StoredPosition& next) {
    if (!is_segment_free(stored_, next)) return false;
    advance_along_segment(next);
    return true;
}

void ParticleStep::advance_along_segment(const StoredPosition& next) {
    if (scratch_.record_segments) {
        scratch_.segments.push_back({stored_.position, next.position, stored_.time, stored_.time, next.time});
    }
    stored_ = next;
}

void ParticleStep::shift_to(const Vec3& position) {
    if (take_segment({position, stored_.time})) state().position = position;
}

/// Goes with a frame until a time, as far as links are free. image: where it is in that frame.
bool ParticleStep::carry(BodyId frame, const Vec3& local_position, double until, int depth) {
    const double key = rules_->bodies->deforming().next_key(stored_.time);
    if (key < until) return carry(frame, local_position, key, depth) && carry(frame, local_position, until, depth);
    const MovingPose pose = rules_->bodies->pose(frame, until);
    const StoredPosition next{frame == kWorldBody ? stored_.position : flush_tiny(pose.point(local_position)), until};
    if (take_segment(next)) return true;
    const double middle = 0.5 * (stored_.time + until);
    if (depth == 0 || !(middle > stored_.time) || !(middle < until)) return false;
    return carry(frame, local_position, middle, depth - 1) && carry(frame, local_position, until, depth - 1);
}

bool ParticleStep::carry_on(BodyId frame, double until) {
    const Vec3 local_position = frame == kWorldBody
                                    ? stored_.position
                                    : rules_->bodies->pose(frame, stored_.time).local_position(stored_.position);
    return carry(frame, local_position, until, kCarryDepth);
}

/// Stays until a time: where it is, or carried along by one of the bodies, by turns, as far as that is free.
void ParticleStep::wait_by_turns(double until) {
    constexpr int kMostTurns = 8;
    for (int turn = 0; turn < kMostTurns; ++turn) {
        const double before = stored_.time;
        if (carry_on(reference_.body(), until)) break;
        if (reference_.is_moving() && carry_on(kWorldBody, until)) break;
        for (BodyId body = 0; body < rules_->bodies->size() && stored_.time < until; ++body) {
            if (body != reference_.body()) static_cast<void>(carry_on(body, until));
        }
        if (stored_.time < until) static_cast<void>(carry_by_meshes(until));
        if (stored_.time >= until || stored_.time == before) break;
    }
}

/// Stays until a time, or carried along. False where none of that is free: its clock stands still then.
bool ParticleStep::wait_out(double until) {
    scratch_.driven = true;
    wait_by_turns(until);
    if (stored_.time < until) static_cast<void>(wait_with_clearance(until));
    state().position = reference_.is_moving()
                           ? rules_->bodies->pose(reference_.body(), stored_.time).local_position(stored_.position)
                           : stored_.position;
    return stored_.time >= until;
}

/// Bounds the rounding, m, of where stored positions are in a frame, from now until a time.
double ParticleStep::rounding_in(BodyId frame, double until) const {
    double rounding = ulp(max_abs(stored_.position));
    if (frame == kWorldBody) return rounding;
    const Vec3 local_position = rules_->bodies->pose(frame, stored_.time).local_position(stored_.position);
    rounding = std::max(rounding, ulp(max_abs(local_position)));
    for (const double time : {stored_.time, until}) {
        const MovingPose pose = rules_->bodies->pose(frame, time);
        const Vec3 world = pose.point(local_position);
        const double largest = std::max(max_abs(world), max_abs(pose.world_from_frame.translation));
        rounding = std::max({rounding, ulp(largest), max_abs(pose.local_position(world) - local_position)});
    }
    return rounding;
}

/// Moves it in no time off the surfaces of a frame that are nearer than the clearance, m.
bool ParticleStep::step_aside(BodyId frame, double clearance) {
    const MovingPose pose = rules_->bodies->pose(frame, stored_.time);
    const Vec3 local_position = frame == kWorldBody ? stored_.position : pose.local_position(stored_.position);
    const auto displacement =
        displacement_to_clear(rules_->bodies->world(frame), local_position, particle_.state.radius, clearance);
    if (!displacement) return false;
    const Vec3 aside = local_position + *displacement;
    if (!take_segment({flush_tiny(frame == kWorldBody ? aside : pose.point(aside)), stored_.time})) return false;
    particle_.attachment.reset();  // where it rested it is no longer
    return true;
}

/// In its frame a rigid collider leaves a particle room at all times, but stored positions are rounded in the world:
/// between surfaces that are nearer to each other than that, carried positions may lie behind them. Moves the particle
/// to where it has more room in the frame, and waits then.
bool ParticleStep::wait_with_clearance(double until) {
    for (const double roundings : kCarryingClearances) {
        const auto waits_in = [&](BodyId frame) {
            if (stored_.time < until && step_aside(frame, roundings * rounding_in(frame, until))) {
                static_cast<void>(carry_on(frame, until));
            }
        };
        waits_in(kWorldBody);
        for (BodyId body = 0; body < rules_->bodies->size(); ++body) waits_in(body);
        if (stored_.time >= until) return true;
    }
    return false;
}

/// Moves it from where its clock has stood still to a position at the present time, where that is a free link.
bool ParticleStep::take_late_segment(const Vec3& position) {
    const StoredPosition next{flush_tiny(position), particle_.state.time};
    const bool is_free = is_segment_free_of_bodies(stored_, next) &&
                         rules_->bodies->deforming().is_late_segment_free(stored_, next, particle_.state.radius);
    if (!is_free) return false;
    advance_along_segment(next);
    particle_.attachment.reset();
    return true;
}

/// At once, wherever meshes that deform have been meanwhile: where they have left it no room for a time, no chain of
/// links leads through that. It goes where a frame has taken its place, or a triangle that was near.
bool ParticleStep::catch_up_directly() {
    constexpr std::size_t kMostTriangles = 8;
    const MovingColliders& bodies = *rules_->bodies;
    if (bodies.deforming().empty()) return false;
    const double now = particle_.state.time;
    if (take_late_segment(stored_.position)) return true;
    for (BodyId body = 0; body < bodies.size(); ++body) {
        const Vec3 local_position = bodies.pose(body, stored_.time).local_position(stored_.position);
        if (take_late_segment(bodies.pose(body, now).point(local_position))) return true;
    }
    std::vector<SurfaceId> nearest;
    bodies.deforming().nearest_to(stored_.position, stored_.time, kMostTriangles, nearest);
    return std::any_of(nearest.begin(), nearest.end(),
                       [&](SurfaceId surface) { return take_late_segment(carried_by_mesh(surface, now)); });
}

bool ParticleStep::catch_up() {
    if (!(stored_.time < particle_.state.time)) return true;
    if (wait_out(particle_.state.time)) return true;
    if (catch_up_directly()) {
        state().position = stored_.position;
        return true;
    }
    outcome_.unsimulated_time = remaining_;
    outcome_.squeezed = 1;
    remaining_ = 0.0;
    return false;
}

void ParticleStep::store_position() {
    particle_.state.position = stored_.position;
    particle_.stored_time = stored_.time;
}

}  // namespace ricochet
