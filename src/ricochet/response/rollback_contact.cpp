// Sliding, rolling and resting between two collisions.
#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/rollback_mover.h"

namespace ricochet {

/// Touched is what is nearer than the particle can move within the tolerance of a time of contact, and is not left
/// faster than the resting speed.
TouchRule RollbackMover::touch_rule() const {
    const double resting_speed = rules_.settings.resting_speed;
    double speed = std::max(length(state_.velocity), resting_speed);
    // What rests under symplectic Euler has come down at the speed of a step's kick.
    if (kicks_first(rules_.settings.integrator.kind) && trial_ == Trial::same_flight) {
        speed = std::max(speed, rules_.settings.time_step * length(rules_.forces.acceleration(state_)));
    }
    const double reach = kTouchingOffsets * contact_offset(state_.position) +
                         kTouchBrackets * rules_.settings.rollback.time_tolerance * speed;
    return {reach, std::numeric_limits<double>::infinity(), reach, resting_speed};
}

/// Plans a stretch on what is touched; none when nothing presses the particle on, or the surface ends here.
void RollbackMover::plan_contact(double duration) {
    const bool kicked = is_kicked();
    pull_ = kicked ? Vec3{} : rules_.forces.acceleration(state_);
    manifold_.load(pull_);
    if (!(kicked || manifold_.is_loaded()) || !is_finite(pull_)) {
        manifold_.clear();
        return;
    }
    Grip grip;
    grip.friction = manifold_.friction(pull_, impact_);
    grip.rolling_friction = impact_.material_of(manifold_[0].surface).rolling_friction;
    grip.pressure = kicked ? 0.0 : 1.0;
    grip.shortest = duration / kShortestStretches;
    grip.negligible_way = kTouchingOffsets * contact_offset(state_.position);
    stretch_ =
        plan_stretch({state_.velocity, particle_.spin}, state_.radius, pull_, manifold_.normals(), grip, duration);
    limit_stretch();
}

/// A stretch ends where its face does. One that is too short for the clock would be planned again for ever.
void RollbackMover::limit_stretch() {
    const double duration = stretch_->at_rest ? stretch_->duration : time_on_support();
    turns_ = false;
    if (!(state_.time + duration > state_.time)) {
        stretch_.reset();
        manifold_.clear();
        return;
    }
    const Vec3& v = stretch_->motion.velocity;
    const Vec3& a = stretch_->acceleration;
    flight_ = {parabola_path(state_.position, v, a, duration), a, 0.0, state_, v + duration * a};
    if (!stretch_->at_rest && !manifold_[0].flat) bend_stretch(duration);
}

/// How long the stretch stays over its face; on curved surfaces as long as it takes to turn by a small angle.
double RollbackMover::time_on_support() const {
    const Vec3& v = stretch_->motion.velocity;
    const Vec3& a = stretch_->acceleration;
    const double duration = stretch_->duration;
    const ContactSurface& support = manifold_[0];
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
    const SurfaceId surface = manifold_[0].surface;
    const Vec3 end = flight_.path.end;
    if (!is_finite(end)) return;
    const CollisionWorld::Nearest here = world.nearest(surface, state_.position);
    const CollisionWorld::Nearest there = world.nearest(surface, end);
    const double side = dot(there.normal, manifold_[0].normal) < 0.0 ? -1.0 : 1.0;
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
    manifold_.touch_again(touch_rule());
    const auto turned = turned_along(state_.velocity, manifold_.normals());
    if (manifold_.empty() || !turned) return;
    impact_.push(manifold_[0].surface, *turned - state_.velocity, false);
    state_.velocity = *turned;
}

}  // namespace ricochet
