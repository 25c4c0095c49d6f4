#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/response/certified_motion.h"
#include "ricochet/response/rollback.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {
namespace {

/// Returns the time, in s, for which an interval stays over its face. On a curved surface, the normal turns by a small
/// angle.
double time_on(const ContactSurface& support, const ContactInterval& interval, const CollisionWorld& world,
               const ForceInput& state) {
    const Vec3& v = interval.motion.velocity;
    const Vec3& a = interval.acceleration;
    const double duration = interval.duration;
    if (support.flat) {
        const Path path = parabola_path(state.position - state.radius * support.normal, v, a, duration);
        const double slack = kTouchingOffsets * contact_offset(state.position);
        return is_finite(path.end) ? world.time_over(support.surface, path, slack) : duration;
    }
    const double longest = kMaxChordAngle * 0.25 * world.size_of(support.surface);
    const double speed = length(v);
    const double pull = 2.0 * length(a);
    return std::min(
        {duration, speed > 0.0 ? longest / speed : duration, pull > 0.0 ? std::sqrt(2.0 * longest / pull) : duration});
}

/// Returns the displacement that lifts the end of a path along a curved surface to the distance of its start. Returns
/// zero if the surface does not curve towards the particle.
Vec3 lift_to_surface(const ContactSurface& support, const Path& path, const CollisionWorld& world) {
    if (!is_finite(path.end)) return {};
    const CollisionWorld::Nearest here = world.nearest(support.surface, path.c[0]);
    const CollisionWorld::Nearest there = world.nearest(support.surface, path.end);
    const double side = dot(there.normal, support.normal) < 0.0 ? -1.0 : 1.0;
    const double lift = here.distance - side * there.distance;
    return lift > 0.0 ? (side * lift) * there.normal : Vec3{};
}

}  // namespace

TouchRule rollback_touch(const ResponseRules& rules, const ForceInput& state, double force_velocity) {
    const double resting_speed = rules.settings.resting_speed;
    const double speed = std::max({length(state.velocity), resting_speed, force_velocity});
    const double reach = kTouchingOffsets * contact_offset(state.position) +
                         kRollbackTouchPaths * rules.settings.rollback.time_tolerance * speed;
    return {reach, std::numeric_limits<double>::infinity(), reach, resting_speed};
}

RollbackMover::RollbackMover(const ResponseRules& rules, MovingParticle& particle, MoveScratch& scratch,
                             MoveOutcome& outcome, Trial trial)
    : rules_(rules),
      particle_(particle),
      state_(particle.state),
      scratch_(scratch),
      outcome_(outcome),
      geometry_(rules.world, scratch.contacts.plane_cache),
      manifold_(geometry_, state_),
      impact_(rules, particle, scratch, outcome),
      trial_(trial) {
    manifold_.recall(particle.contact);
    particle.contact = {};
}

/// Takes a step, goes back to the first contact and resolves it, until no time is left.
void RollbackMover::run(double duration) {
    double remaining = duration;
    int idle = 0;
    while (remaining > 0.0) {
        rules_.poll();
        if (!begin(remaining)) return;
        const CollisionBracket found = bracket();
        advance(found.free);
        remaining = std::max(0.0, remaining - found.free);
        if (found.blocked ? !has_budget() : flown_ && flown_->has_spent_substeps()) {
            outcome_.unsimulated_time = remaining;
            break;
        }
        if (found.blocked) resolve();
        if (outcome_.is_absorbed()) return;
        idle = in_contact() && found.free < kLeastProgress * duration ? idle + 1 : 0;
        if (idle > kMaxSlowContacts) {
            rest(remaining);
            break;
        }
    }
    keep_contact();
}

/// Rests for a duration, in s: a particle that circles into a pit would need infinitely many intervals.
void RollbackMover::rest(double duration) {
    pull_ = is_kicked() ? Vec3{} : rules_.forces.acceleration(state_);
    manifold_.load(pull_);
    manifold_.record_impulse(-state_.velocity - duration * pull_, duration, impact_.ledger());
    state_.velocity = particle_.spin = Vec3{};
    state_.time += duration;
    outcome_.end = MoveEnd::resting;
}

bool RollbackMover::begin(double duration) {
    interval_.reset();
    from_ = state_.position;
    outcome_.end = MoveEnd::moving;
    manifold_.touch_again(touch_rule());
    if (in_contact()) plan_contact(duration);
    if (!interval_) flight_ = flight_for(duration);
    if (can_be_followed(flight_.path)) return true;
    outcome_.end = MoveEnd::frozen;
    return false;
}

Flight RollbackMover::flight_for(double duration) const {
    const Integrator& integrator = rules_.settings.integrator;
    if (flown_ && trial_ == Trial::same_flight) {
        return resume_flight(integrator, rules_.forces, state_, *flown_, duration);
    }
    return first_flight(rules_, particle_, duration);
}

PhaseState RollbackMover::state_at(double elapsed) const {
    if (!interval_ && trial_ == Trial::own_step) {
        const Flight flight = flight_for(elapsed);
        return {flight.path.end, flight.end_velocity};
    }
    return ricochet::state_at(rules_.settings.integrator, rules_.forces, flight_, elapsed);
}

/// Brackets the time of contact by bisection, with one end free and the other one blocked, to the tolerance.
CollisionBracket RollbackMover::bracket() {
    const double whole = flight_.path.duration;
    if (interval_ && interval_->at_rest) return {whole, false};
    const Obstacles obstacles(rules_.world, from_, state_.radius);
    const auto is_blocked = [&](const Vec3& position) {
        ++outcome_.trials;
        return !is_finite(position) || obstacles.block(position);
    };
    blocked_position_ = flush_tiny(flight_.path.end);
    if (!is_blocked(blocked_position_)) return {whole, false};
    double free = 0.0;
    double blocked = whole;
    while (blocked - free > rules_.settings.rollback.time_tolerance) {
        const double middle = 0.5 * (free + blocked);
        if (middle <= free || middle >= blocked) break;
        const Vec3 position = flush_tiny(state_at(middle).position);
        if (is_blocked(position)) {
            blocked = middle;
            blocked_position_ = position;
        } else {
            free = middle;
        }
    }
    return {free, true};
}

void RollbackMover::advance(double elapsed) {
    interval_ ? follow_interval(elapsed) : fly(elapsed);
    if (scratch_.record_segments && state_.position != from_) {
        scratch_.segments.push_back({from_, state_.position, state_.time});
    }
    state_.time += elapsed;
}

void RollbackMover::fly(double elapsed) {
    if (elapsed > 0.0) {
        const PhaseState state = state_at(elapsed);
        state_.position = flush_tiny(state.position);
        state_.velocity = state.velocity;
    } else if (trial_ == Trial::same_flight) {
        state_.velocity = flight_.path.velocity(0.0);  // with the kick, if there is one
    }
    const bool own_step = trial_ == Trial::own_step;
    kick_velocity_ = (flight_.kick_duration > 0.0 && own_step ? elapsed : flight_.kick_duration) * flight_.acceleration;
    if (!own_step) flown_ = flight_;
    outcome_.is_coarse |= flight_.is_coarse;
}

void RollbackMover::follow_interval(double elapsed) {
    const Vec3 before = state_.velocity;
    const bool rests = interval_->at_rest;
    if (!rests) state_.position = flush_tiny(flight_.path.position(elapsed));
    const bool is_over = elapsed >= interval_->duration;
    const Motion motion = rests ? interval_->motion
                                : motion_after(*interval_, elapsed, is_over, flight_.path.velocity(elapsed),
                                               state_.radius, manifold_.supports(impact_.surfaces()).all());
    particle_.set_motion(motion);
    manifold_.record_impulse(state_.velocity - before - elapsed * pull_, elapsed, impact_.ledger());
    outcome_.end = rests ? MoveEnd::resting : MoveEnd::moving;
    kick_velocity_ = Vec3{};
    if (turns_) turn_along();
}

/// Resolves the collision: the particle bounces, or lands if will_stay().
void RollbackMover::resolve() {
    ++outcome_.bounces;
    outcome_.end = MoveEnd::moving;
    Obstacles(rules_.world, from_, state_.radius).gather(blocked_position_, state_.position, state_.velocity, hit_);
    const bool on_surface = std::ranges::any_of(
        hit_, [&](const ContactSurface& hit) { return rules_.world.point_on(hit.surface, state_.position); });
    if (on_surface) {
        leave_surface();
        return;
    }
    if (hit_.empty()) return;
    if (will_stay()) {
        impact_.land(hit_);
        for (const ContactSurface& hit : hit_) manifold_.add(hit);
    } else {
        if (!impact_.reflect(hit_)) --outcome_.bounces, ++outcome_.touches;
    }
}

/// Moves a centre that lies exactly on a surface to the side of the normal, because the centre has no side yet.
void RollbackMover::leave_surface() {
    const Path path = line_path(state_.position, state_.velocity, flight_.path.duration);
    const ContactQueryResult found = find_first_contact(geometry_, {path, state_.radius}, scratch_.contacts);
    if (!step_off_surface(found.near, state_, scratch_)) ++outcome_.stayed;
}

/// Returns true if all surfaces can hold the particle, all rebounds are slow, and it is pressed onto a surface.
bool RollbackMover::will_stay() const {
    const Vec3 a = is_kicked() ? flown_->acceleration : rules_.forces.acceleration(state_);
    // The surfaces already in contact cancel the acceleration into them.
    const Vec3 pull = project_off(a, manifold_.normals());
    bool pressed = false;
    for (const ContactSurface& hit : hit_) {
        const Material& material = impact_.surfaces().material_of(hit.surface);
        // The velocity from the step's own kick does not count as impact speed.
        const double approach = -dot(state_.velocity, hit.normal) - std::max(0.0, -dot(kick_velocity_, hit.normal));
        const bool can_rest = material.can_hold(rules_.settings.resting_speed);
        const double rebound = approach > 0.0 ? material.restitution_at(approach) * approach : 0.0;
        if (approach > 0.0 && (!can_rest || rebound >= rules_.settings.resting_speed)) return false;
        pressed = pressed || (can_rest && std::min(dot(a, hit.normal), dot(pull, hit.normal)) < 0.0);
    }
    return pressed;
}

TouchRule RollbackMover::touch_rule() const {
    // Under symplectic Euler, a resting particle approaches its support with the speed of one kick.
    const bool is_kicked_down = kicks_first(rules_.settings.integrator.kind) && trial_ == Trial::same_flight;
    const double force_velocity =
        is_kicked_down ? rules_.settings.time_step * length(rules_.forces.acceleration(state_)) : 0.0;
    return rollback_touch(rules_, state_, force_velocity);
}

/// Plans a contact interval on the touched surfaces, if they press and do not end here.
void RollbackMover::plan_contact(double duration) {
    const bool kicked = is_kicked();
    pull_ = kicked ? Vec3{} : rules_.forces.acceleration(state_);
    manifold_.load(pull_);
    if (!(kicked || manifold_.is_loaded()) || !is_finite(pull_)) {
        manifold_.clear();
        return;
    }
    const FrictionLimits grip = manifold_.grip(kicked ? 0.0 : 1.0, duration);
    interval_ = plan_interval(particle_.motion(), state_.radius, pull_, manifold_.supports(impact_.surfaces()).all(),
                              grip, duration);
    manifold_.load(*interval_);
    limit_interval();
}

/// Ends an interval at the end of its face. Discards one that does not advance the clock and would repeat forever.
void RollbackMover::limit_interval() {
    const ContactSurface support = manifold_[0];
    const double duration =
        interval_->at_rest ? interval_->duration : time_on(support, *interval_, rules_.world, state_);
    turns_ = false;
    if (!(state_.time + duration > state_.time)) {
        interval_.reset();
        manifold_.clear();
        return;
    }
    const Vec3& v = interval_->motion.velocity;
    const Vec3& a = interval_->acceleration;
    flight_ = {parabola_path(state_.position, v, a, duration), a, 0.0, state_, v + duration * a};
    if (interval_->at_rest || support.flat) return;
    const Vec3 lift = lift_to_surface(support, flight_.path, rules_.world);
    turns_ = lift != Vec3{};
    if (!turns_) return;
    // Replaces the path by a chord. The velocity is turned along the surface at the end of the chord.
    const Vec3 end = flight_.path.end + lift;
    flight_.path = parabola_path(state_.position, v + (end - flight_.path.end) / duration, a, duration);
    flight_.path.end = end;
}

/// Turns the velocity along the surface after a chord. Keeps the speed.
void RollbackMover::turn_along() {
    manifold_.touch_again(touch_rule());
    const auto turned = turned_along(state_.velocity, manifold_.normals());
    if (manifold_.empty() || !turned) return;
    impact_.ledger().record_impulse(manifold_[0].surface, *turned - state_.velocity, false);
    state_.velocity = *turned;
}

}  // namespace ricochet
