#include "ricochet/response/shared_contact.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_arc.h"
#include "ricochet/response/deformed_surface.h"
#include "ricochet/response/impact_problem.h"

namespace ricochet {
namespace {

/// Intervals of a step before the particle is set free again.
constexpr int kMostIntervals = 64;

/// Corrections of an interval's end; each leaves the square of what was wrong.
constexpr int kCorrections = 3;

}  // namespace

MovingView SharedContact::view_at(double time) const {
    return {*step_.rules().bodies, kAtRest, {time, time, time, 0.0, 0.0}};
}

bool SharedContact::is_slow(const Contact& contact, const Motion& arriving) const {
    const ImpactAnswer& impact = step_.impact();
    return std::all_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& surface) {
        const Material& material = impact.material_of(surface.surface);
        const double approach = impact.advance_of(surface) - dot(arriving.velocity, surface.normal);
        if (!(approach > 0.0)) return true;
        return !material.is_random() &&
               material.restitution_at(approach) * approach < step_.rules().settings.resting_speed;
    });
}

/// All that is touched, of all frames, but what is left.
void SharedContact::gather() {
    const double margin = state_.radius + kEdgeOffsets * contact_offset(state_.position);
    const Vec3 by{margin, margin, margin};
    std::vector<BodyId> near{kAtRest};
    step_.rules().bodies->near({state_.position - by, state_.position + by}, kAtRest, near);
    count_ = 0;
    for (const BodyId body : near) gather_in(body);
    gather_deforming();
}

void SharedContact::gather_deforming() {
    const MovingColliders& bodies = *step_.rules().bodies;
    const double departure = step_.rules().settings.resting_speed;
    for (const DeformedContact& contact : touched_surfaces(deforming(), state_, departure)) {
        if (count_ == kMostHolding) return;
        Touched& touched = touched_[count_++];
        const ContactSurface& surface = contact.surface;
        touched.surface = surface;
        touched.all = contact.all;
        touched.body = bodies.body_of(surface.surface);
        touched.velocity = step_.impact().velocity_of(surface);
        touched.turning = deforming().motion_at(surface.surface, state_.position, state_.time).turning;
    }
}

void SharedContact::gather_in(BodyId body) {
    const MovingView view = view_at(state_.time);
    const CollisionWorld& world = view.bodies().world(body);
    if (world.empty()) return;
    ForceInput seen = state_;
    seen.position = view.image(body, state_.position, 0.0);
    seen.velocity = view.velocity_in(body, {state_.position, 0.0, state_.position}, state_.velocity);
    TrianglePlaneCache planes;
    const SurfaceGeometry geometry(world, planes);
    ContactManifold manifold(geometry, seen);
    const double offset = std::max(contact_offset(seen.position), contact_offset(state_.position));
    const double reach = kTouchingOffsets * offset;
    const TouchRule rule{reach, reach, reach, step_.rules().settings.resting_speed};
    step_.visit_near_in(geometry, seen.position, reach, [&](SurfaceId surface) { manifold.touch(surface, rule); });
    for (std::size_t k = 0; k < manifold.size() && count_ < kMostHolding; ++k) {
        Touched& touched = touched_[count_++];
        touched.surface = manifold[k];
        touched.all.clear();
        touched.surface.normal = view.direction_from(body, manifold[k].normal, 0.0);
        touched.body = body;
        touched.velocity = step_.impact().velocity_of(touched.surface);
        touched.turning = view.bodies().pose(body, state_.time).angular_velocity;
    }
}

/// Loses what leads into the surfaces; false where they leave it no way out.
bool SharedContact::land() {
    ImpactAnswer& impact = step_.impact();
    const Vec3 before = state_.velocity;
    // What goes on along all of them has landed already.
    const bool is_along = std::all_of(touched().begin(), touched().end(), [&](const Touched& one) {
        return departure_from(one) >= -kStopRounding * (length(before) + length(one.velocity));
    });
    if (is_along) return true;
    std::array<ImpactSurface, kMostHolding> surfaces;
    for (std::size_t k = 0; k < count_; ++k) surfaces[k] = impact.landing_on(touched_[k].surface);
    const ImpactResult result =
        solve_impact({state_.velocity, particle_.spin}, state_.radius, std::span(surfaces).first(count_));
    state_.velocity = result.after.velocity;
    particle_.spin = result.after.spin;
    for (std::size_t k = 0; k < count_; ++k) {
        if (result.push[k] != Vec3{}) impact.push(touched_[k].surface.surface, result.push[k], false);
    }
    const double scale = length(before) + length(state_.velocity);
    return std::all_of(touched().begin(), touched().end(), [&](const Touched& one) {
        return impact.departure_from(one.surface) >= -kSlowSlip * (scale + length(one.velocity));
    });
}

double SharedContact::departure_from(const Touched& touched) const {
    return dot(state_.velocity - touched.velocity, touched.surface.normal);
}

/// Plans without the slow departures that are left of bounces on what presses the particle on: they have died out. What
/// does not press is left.
SharedContact::Hold SharedContact::settle(double duration) {
    const Vec3 leaving = state_.velocity;
    for (;;) {
        std::array<Vec3, kMostHolding> normals;
        std::array<double, kMostHolding> departures{};
        for (std::size_t k = 0; k < count_; ++k) {
            normals[k] = touched_[k].surface.normal;
            departures[k] = -departure_from(touched_[k]);
        }
        state_.velocity += shift_by({normals.data(), count_}, {departures.data(), count_});
        const std::size_t before = count_;
        const Hold hold = plan(duration);
        std::size_t kept = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            const bool is_left = interval_.push[k] == Vec3{} && departures[k] < 0.0;
            if (!is_left) touched_[kept++] = touched_[k];
        }
        if (kept == before || kept == 0 || hold != Hold::shared) {
            // Surfaces of one frame answer the departure from them by themselves.
            if (hold != Hold::shared) state_.velocity = leaving;
            if (hold == Hold::shared) {
                step_.impact().push(touched_[0].surface.surface, state_.velocity - leaving, false);
            }
            return hold;
        }
        count_ = kept;
        state_.velocity = leaving;
    }
}

/// As it holds the particle, seen from what moves with `shift`: the gap to a rigid surface grows by n . (a - a_s) + 2
/// (omega x n) . (v - w), and by what its curvature adds; a_s: of its own point there.
HoldingSurface SharedContact::holding(const Touched& touched, const Vec3& shift) const {
    const ImpactAnswer& impact = step_.impact();
    const Material& material = impact.material_of(touched.surface.surface);
    const Vec3& n = touched.surface.normal;
    const Vec3 relative = touched.velocity - shift;
    HoldingSurface held{n,
                        material.friction,
                        material.rolling_friction,
                        material.spinning_friction,
                        relative - dot(relative, n) * n,
                        impact.angular_velocity_of(touched.surface.surface)};
    if (deforms(touched)) {
        const SurfaceBend bent = bend_of(deforming(), state_, touched.surface);
        held.bend = bent.bend;
        held.slip_bend = bent.slip_bend;
        return held;
    }
    const MovingView view = view_at(state_.time);
    const MovingPose pose = view.bodies().pose(touched.body, state_.time);
    const Vec3 arm = state_.position - pose.world_from_frame.translation;
    const Vec3& turning = pose.angular_velocity;
    const Vec3 carried = cross(turning, arm);
    const Vec3 of_surface = pose.acceleration + cross(pose.angular_acceleration, arm) + cross(turning, carried);
    const Vec3 slip = state_.velocity - pose.velocity - carried;
    held.bend = 2.0 * dot(cross(turning, n), slip) - dot(of_surface, n);
    const Vec3 change = of_surface + cross(turning, slip);
    held.slip_bend = dot(change, n) * n - change;
    if (touched.surface.flat) return held;
    ForceInput seen = state_;
    seen.position = view.image(touched.body, state_.position, 0.0);
    TrianglePlaneCache planes;
    const SurfaceGeometry geometry(view.bodies().world(touched.body), planes);
    const ContactSurface in_frame{touched.surface.surface, pose.direction_image(n), false};
    held.bend += ContactArc::bend_of(geometry, seen, in_frame, pose.direction_image(slip));
    return held;
}

/// s, in which surfaces turn little, and bend little under the particle.
double SharedContact::longest() const {
    double rate = 0.0;
    for (const Touched& one : touched()) {
        rate = std::max(rate, length(one.turning));
        if (one.surface.flat) continue;
        const SurfaceId surface = one.surface.surface;
        // A sphere turns about an edge, however large the triangle.
        const double own = deforms(one) ? 0.0 : step_.rules().bodies->world(one.body).size_of(surface);
        const double size = std::max(state_.radius, own);
        rate = std::max(rate, length(state_.velocity - one.velocity) / size);
    }
    return rate > 0.0 ? kMostSharedTurn / rate : step_.remaining();
}

/// s, when one of the bodies goes on with another velocity, in this step.
std::optional<double> SharedContact::next_jump() const {
    std::optional<double> first;
    for (const Touched& one : touched()) {
        const auto jump = step_.rules().bodies->next_jump(one.body, state_.time, particle_.step_end);
        if (jump && (!first || *jump < *first)) first = jump;
    }
    return first;
}

/// Plans the next interval in the frame in which none of the surfaces advances.
SharedContact::Hold SharedContact::plan(double duration) {
    std::array<Vec3, kMostHolding> normals;
    std::array<double, kMostHolding> advances{};
    std::array<HoldingSurface, kMostHolding> surfaces;
    for (std::size_t k = 0; k < count_; ++k) {
        normals[k] = touched_[k].surface.normal;
        advances[k] = dot(touched_[k].velocity, normals[k]);
    }
    shift_ = shift_by({normals.data(), count_}, {advances.data(), count_});
    for (std::size_t k = 0; k < count_; ++k) surfaces[k] = holding(touched_[k], shift_);
    const Vec3 forces = step_.rules().forces.acceleration(state_);
    const double reach = kTouchingOffsets * contact_offset(state_.position);
    const Grip grip{1.0, step_.duration() / kShortestIntervals, reach};
    interval_ = plan_interval({state_.velocity - shift_, particle_.spin}, state_.radius, forces,
                              std::span(surfaces).first(count_), grip, duration);
    std::optional<BodyId> holder;
    bool is_shared = false;
    for (std::size_t k = 0; k < count_; ++k) {
        if (interval_.push[k] == Vec3{}) continue;
        is_shared = is_shared || (holder && *holder != touched_[k].body) || deforms(touched_[k]);
        holder = touched_[k].body;
    }
    if (!holder) return Hold::none;
    if (is_shared) return Hold::shared;
    // One frame's surfaces hold it; others are only touched.
    std::size_t kept = 0;
    for (std::size_t k = 0; k < count_; ++k) {
        if (touched_[k].body == *holder) touched_[kept++] = touched_[k];
    }
    count_ = kept;
    return Hold::single;
}

SharedContact::Height SharedContact::height_above(const Touched& touched, const Vec3& position, double time) const {
    if (deforms(touched)) {
        const auto [normal, above] =
            ricochet::height_above(deforming(), {touched.surface, touched.all}, position, time);
        return {normal, above, 2.0 * deforming().offset_of(touched.surface.surface)};
    }
    const MovingView view = view_at(time);
    const CollisionWorld& world = view.bodies().world(touched.body);
    const SurfaceId surface = touched.surface.surface;
    const Vec3 image = view.image(touched.body, position, 0.0);
    Vec3 normal = world.unit_normal_of(surface, image);
    double height = world.signed_distance_from(surface, image);
    if (!touched.surface.flat && !world.is_shape(surface)) {
        const CollisionWorld::Nearest nearest = world.nearest(surface, image);
        normal = nearest.normal;
        height = nearest.distance;
    }
    normal = view.direction_from(touched.body, normal, 0.0);
    const double side = dot(normal, touched.surface.normal) < 0.0 ? -1.0 : 1.0;
    return {side * normal, side * height, 2.0 * std::max(contact_offset(position), contact_offset(image))};
}

/// A position at a time put at the contact offset from the surfaces that hold it.
Vec3 SharedContact::kept_off(Vec3 end, double time) const {
    for (int pass = 0; pass < kCorrections; ++pass) {
        std::array<Vec3, kMostHolding> normals;
        std::array<double, kMostHolding> lifts{};
        std::size_t count = 0;
        for (std::size_t k = 0; k < count_; ++k) {
            if (interval_.push[k] == Vec3{}) continue;
            const Height height = height_above(touched_[k], end, time);
            normals[count] = height.normal;
            lifts[count++] = state_.radius + height.offset - height.above;
        }
        end += shift_by({normals.data(), count}, {lifts.data(), count});
    }
    return flush_tiny(end);
}

/// Between its ends the path of a point can be behind surfaces that turn, by the cubic's error, where it would be
/// stopped: lifts it, by 4 s (1 - s) of a height over its duration.
void SharedContact::lift_middle(Path& path) const {
    for (std::size_t k = 0; k < count_; ++k) {
        if (interval_.push[k] == Vec3{}) continue;
        double behind = 0.0;
        Vec3 normal;
        for (const double part : {0.1, 0.25, 0.5, 0.75, 0.9}) {
            const double time = part * path.duration;
            const Height height = height_above(touched_[k], path.position(time), state_.time + time);
            const double missing = state_.radius + height.offset - height.above;
            behind = std::max(behind, missing / (4.0 * part * (1.0 - part)));
            normal = height.normal;
        }
        if (behind <= (deforms(touched_[k]) ? 0.0 : 0.5 * state_.radius)) continue;
        const Vec3 lift = (4.0 * behind / path.duration) * normal;
        path.c[1] += lift;
        path.c[2] -= lift / path.duration;
        path.degree = std::max(path.degree, 2);
    }
}

/// Along the interval, to where the surfaces will be.
Path SharedContact::way(double duration) const {
    const Vec3 velocity = interval_.motion.velocity + shift_;
    const Vec3 last = velocity + duration * interval_.acceleration;
    const Vec3 end = state_.position + duration * (velocity + (0.5 * duration) * interval_.acceleration);
    const double until = duration >= step_.remaining() ? particle_.step_end : state_.time + duration;
    Path path = hermite_path(state_.position, velocity, kept_off(end, until), last, duration);
    if (path.duration > 0.0) lift_middle(path);
    return path;
}

/// s, in which it is over the faces of meshes that deform that hold it.
double SharedContact::until_rim(const Path& path) const {
    double most = path.duration;
    for (std::size_t k = 0; k < count_; ++k) {
        const Touched& one = touched_[k];
        if (interval_.push[k] == Vec3{} || !deforms(one) || !one.surface.flat) continue;
        most = std::min(most, time_over(deforming(), {one.surface, one.all}, path, state_.time));
    }
    return most;
}

/// m/s, what a surface has changed the velocity by in an interval: about an edge as much in its direction at the end as
/// in that at the start.
Vec3 SharedContact::push_of(std::size_t k, double elapsed, bool has_arrived) const {
    const Touched& one = touched_[k];
    const Vec3 push = elapsed * interval_.push[k];
    if (push == Vec3{} || !has_arrived || !deforms(one) || one.surface.flat) return push;
    const Vec3& n = one.surface.normal;
    return push + 0.5 * dot(push, n) * (height_above(one, state_.position, state_.time).normal - n);
}

std::vector<SurfaceId> SharedContact::held() const {
    std::vector<SurfaceId> list;
    for (const Touched& one : touched()) {
        if (!deforms(one)) list.push_back(one.surface.surface);
        list.insert(list.end(), one.all.begin(), one.all.end());
    }
    std::sort(list.begin(), list.end());
    return list;
}

/// What holds it takes part in its impact on something else.
void SharedContact::take_part_in(Contact& contact) const {
    for (const Touched& one : touched()) {
        const bool is_there = std::any_of(contact.all().begin(), contact.all().end(), [&](const ContactSurface& other) {
            return other.surface == one.surface.surface;
        });
        if (is_there || contact.count == Contact::kMostSurfaces) continue;
        contact.surfaces[static_cast<std::size_t>(contact.count++)] = one.surface;
    }
}

KeptContact SharedContact::kept() const {
    KeptContact kept;
    for (const Touched& one : touched()) kept.surfaces[kept.count++] = one.surface.surface;
    return kept;
}

/// Relative to all that presses on it.
bool SharedContact::rests() const {
    bool is_held = false;
    for (std::size_t k = 0; k < count_; ++k) {
        if (interval_.push[k] == Vec3{}) continue;
        const Touched& one = touched_[k];
        const double rounding = kStopRounding * (length(state_.velocity) + length(one.velocity));
        if (length(state_.velocity - one.velocity) > rounding) return false;
        const Vec3 turning = step_.impact().angular_velocity_of(one.surface.surface);
        if (state_.radius * length(particle_.spin - turning) > rounding) return false;
        is_held = true;
    }
    return is_held;
}

std::optional<Contact> SharedContact::follow() {
    particle_.contact = {};
    bool has_jumped = false;
    for (int count = 0; count < kMostIntervals && step_.remaining() > 0.0; ++count) {
        step_.impact().note_driven();
        gather();
        if (count_ == 0) return std::nullopt;
        if (!land()) {
            step_.log().note_impact();
            step_.stop();
            return std::nullopt;
        }
        const std::optional<double> jump = next_jump();
        double most = std::min(step_.remaining(), longest());
        if (jump) most = std::clamp(*jump - state_.time, 0.0, most);
        const Hold hold = settle(most);
        if (hold == Hold::single) particle_.contact = kept();
        if (hold != Hold::shared) return std::nullopt;
        step_.log().note_impact();
        const double before = step_.remaining();
        const double before_time = state_.time;
        const Vec3 forces = step_.rules().forces.acceleration(state_);
        const Vec3 velocity = interval_.motion.velocity + shift_;
        // What ends at once has ended after the shortest interval.
        const double shortest = std::min(before, step_.duration() / kShortestIntervals);
        double duration = interval_.duration > 0.0 ? interval_.duration : std::min(shortest, most);
        Path path = way(duration);
        if (const double on = until_rim(path); on < duration) {
            duration = on;
            path = way(duration);
        }
        std::optional<Contact> contact = step_.follow(path, held());
        const double elapsed = before - step_.remaining();
        if (!contact) state_.velocity = velocity + elapsed * interval_.acceleration;
        for (std::size_t k = 0; k < count_; ++k) {
            const Vec3 push = push_of(k, elapsed, !contact);
            if (!contact) state_.velocity += push - elapsed * interval_.push[k];
            if (push != Vec3{}) step_.impact().push(touched_[k].surface.surface, push, false);
        }
        particle_.spin = interval_.motion.spin + elapsed * interval_.spin_acceleration;
        step_.impact().note_driven();
        step_.log().note_contact(forces, path, true);
        if (contact) {
            take_part_in(*contact);
            return contact;
        }
        has_jumped = jump && duration >= *jump - before_time;
        if (has_jumped) break;
    }
    // At a jump a body goes on with another velocity, and the particle with its own.
    if (step_.remaining() <= 0.0 && !has_jumped) {
        particle_.contact = kept();
        if (rests()) step_.outcome().end = MoveEnd::resting;
    }
    return std::nullopt;
}

}  // namespace ricochet
