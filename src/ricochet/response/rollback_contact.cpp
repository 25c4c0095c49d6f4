// Sliding, rolling and resting between two collisions.
#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/rollback_mover.h"

namespace ricochet {

/// The surface as the particle touches it now: nearer than it can move within the tolerance of a time of contact.
std::optional<ContactSurface> RollbackMover::touching(SurfaceId surface) const {
    const CollisionWorld& world = rules_.world;
    const CollisionWorld::Nearest nearest = world.nearest(surface, state_.position);
    double speed = std::max(length(state_.velocity), rules_.settings.resting_speed);
    // What rests under symplectic Euler has come down at the speed of a step's kick.
    if (kicks_first(rules_.settings.integrator.kind) && trial_ == Trial::same_flight) {
        speed = std::max(speed, rules_.settings.time_step * length(rules_.forces.acceleration(state_)));
    }
    const double reach = kTouchingOffsets * contact_offset(state_.position) +
                         kTouchBrackets * rules_.settings.rollback.time_tolerance * speed;
    if (nearest.distance - state_.radius > reach) return std::nullopt;
    if (dot(state_.velocity, nearest.normal) > rules_.settings.resting_speed) return std::nullopt;
    if (state_.radius > 0.0 || nearest.flat) return ContactSurface{surface, nearest.normal, nearest.flat};
    // A point next to a rim: the direction from the rim is rounding, the plane's normal counts.
    const double distance = world.signed_distance_from(surface, state_.position);
    const Vec3 normal = world.unit_normal_of(surface, state_.position);
    return ContactSurface{surface, distance < 0.0 ? -normal : normal, world.is_flat(surface)};
}

/// Of what was touched before, what still is.
void RollbackMover::find_touched() {
    std::array<ContactSurface, 3> before = touched_;
    const std::size_t count = std::exchange(count_, 0);
    for (std::size_t k = 0; k < count; ++k) {
        if (const auto surface = touching(before[k].surface)) touch({&*surface, 1});
    }
}

/// Adds surfaces that are touched; at most three of different normals matter.
void RollbackMover::touch(std::span<const ContactSurface> surfaces) {
    for (const ContactSurface& surface : surfaces) {
        const auto known = std::any_of(normals_.begin(), normals_.begin() + static_cast<std::ptrdiff_t>(count_),
                                       [&](const Vec3& n) { return 1.0 - dot(n, surface.normal) <= kSameNormal; });
        if (known || count_ == touched_.size()) continue;
        touched_[count_] = surface;
        normals_[count_++] = surface.normal;
    }
}

/// Plans a stretch on what is touched; none when nothing presses the particle on, or the surface ends here.
void RollbackMover::plan_contact(double duration) {
    const bool kicked = is_kicked();
    pull_ = kicked ? Vec3{} : rules_.forces.acceleration(state_);
    shares_ = normal_accelerations(pull_, normals());
    const bool pressed = kicked || shares_[0] > 0.0 || shares_[1] > 0.0 || shares_[2] > 0.0;
    if (!pressed || !is_finite(pull_)) {
        count_ = 0;
        return;
    }
    double friction = 0.0;
    for (std::size_t k = 0; k < count_; ++k) {
        friction += shares_[k] * impact_.material_of(touched_[k].surface).friction;
    }
    const double all = length(pull_ - project_off(pull_, normals()));
    Grip grip;
    grip.friction = all > 0.0 ? friction / all : 0.0;
    grip.rolling_friction = impact_.material_of(touched_[0].surface).rolling_friction;
    grip.pressure = kicked ? 0.0 : 1.0;
    grip.shortest = duration / kShortestStretches;
    grip.negligible_way = kTouchingOffsets * contact_offset(state_.position);
    stretch_ = plan_stretch({state_.velocity, particle_.spin}, state_.radius, pull_, normals(), grip, duration);
    limit_stretch();
}

/// A stretch ends where its face does. One that is too short for the clock would be planned again for ever.
void RollbackMover::limit_stretch() {
    const double duration = stretch_->at_rest ? stretch_->duration : time_on_support();
    turns_ = false;
    if (!(state_.time + duration > state_.time)) {
        stretch_.reset();
        count_ = 0;
        return;
    }
    const Vec3& v = stretch_->motion.velocity;
    const Vec3& a = stretch_->acceleration;
    flight_ = {parabola_path(state_.position, v, a, duration), a, 0.0, state_, v + duration * a};
    if (!stretch_->at_rest && !touched_[0].flat) bend_stretch(duration);
}

/// How long the stretch stays over its face; on curved surfaces as long as it takes to turn by a small angle.
double RollbackMover::time_on_support() const {
    const Vec3& v = stretch_->motion.velocity;
    const Vec3& a = stretch_->acceleration;
    const double duration = stretch_->duration;
    const ContactSurface& support = touched_[0];
    if (support.flat) {
        const Path way = parabola_path(state_.position - state_.radius * support.normal, v, a, duration);
        const double slack = kTouchingOffsets * contact_offset(state_.position);
        return is_finite(way.end) ? rules_.world.time_over(support.surface, way, slack) : duration;
    }
    const double longest = kMaxChordAngle * 0.25 * rules_.world.size_of(support.surface);
    const double speed = length(v);
    const double pull = 2.0 * length(a);
    return std::min(
        {duration, speed > 0.0 ? longest / speed : duration, pull > 0.0 ? std::sqrt(2.0 * longest / pull) : duration});
}

/// On a surface that bends towards the particle a stretch is a chord, whose end is as far off as its beginning.
void RollbackMover::bend_stretch(double duration) {
    const CollisionWorld& world = rules_.world;
    const SurfaceId surface = touched_[0].surface;
    const Vec3 end = flight_.path.end;
    if (!is_finite(end)) return;
    const CollisionWorld::Nearest here = world.nearest(surface, state_.position);
    const CollisionWorld::Nearest there = world.nearest(surface, end);
    const double side = dot(there.normal, touched_[0].normal) < 0.0 ? -1.0 : 1.0;
    const double lift = here.distance - side * there.distance;
    if (!(lift > 0.0)) return;
    turns_ = true;
    const Vec3 lifted = end + (side * lift) * there.normal;
    const Vec3 v = stretch_->motion.velocity + (lifted - end) / duration;
    flight_.path = parabola_path(state_.position, v, stretch_->acceleration, duration);
    flight_.path.end = lifted;
}

/// After a chord the velocity is turned along the surface. Its speed is kept.
void RollbackMover::turn_along() {
    const Vec3 before = state_.velocity;
    find_touched();
    const Vec3 along = project_off(before, normals());
    const double left = length(along);
    if (count_ == 0 || left == 0.0) return;
    state_.velocity = (length(before) / left) * along;
    impact_.push(touched_[0].surface, state_.velocity - before, false);
}

/// Books what contact has changed the velocity by: each surface its normal part, what is left (friction) on the first.
void RollbackMover::book_contact(const Vec3& velocity_change, double elapsed) {
    Vec3 left = velocity_change;
    for (std::size_t k = 1; k < count_; ++k) {
        if (shares_[k] == 0.0) continue;
        const Vec3 part = (elapsed * shares_[k]) * normals_[k];
        impact_.push(touched_[k].surface, part, false);
        left -= part;
    }
    impact_.push(touched_[0].surface, left, false);
}

void RollbackMover::remember_contact() {
    particle_.contact = {};
    for (std::size_t k = 0; k < count_; ++k) particle_.contact.surfaces[k] = touched_[k].surface;
    particle_.contact.count = static_cast<std::uint8_t>(count_);
}

}  // namespace ricochet
