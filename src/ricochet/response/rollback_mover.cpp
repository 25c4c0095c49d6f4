#include "ricochet/response/rollback_mover.h"

#include <algorithm>

#include "ricochet/collision/safe_position.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

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

/// The loop that moves one particle: take all the time that is left, go back to what was in the way, answer, go on.
void RollbackMover::run(double duration) {
    double remaining = duration;
    int idle = 0;
    while (remaining > 0.0) {
        if (!begin(remaining)) return;
        const CollisionBracket found = bracket();
        advance(found.free);
        remaining = std::max(0.0, remaining - found.free);
        if (found.blocked && !has_budget()) {
            outcome_.unsimulated_time = remaining;
            break;
        }
        if (found.blocked) answer();
        if (outcome_.absorbed) return;
        idle = in_contact() && found.free < kLeastProgress * duration ? idle + 1 : 0;
        if (idle > kMaxSlowContacts) {
            rest(remaining);
            break;
        }
    }
    keep_contact();
}

/// Rests for the time given: what circles into a pit gets there in infinitely many ever shorter stretches.
void RollbackMover::rest(double duration) {
    pull_ = is_kicked() ? Vec3{} : rules_.forces.acceleration(state_);
    manifold_.load(pull_);
    manifold_.record_push(-state_.velocity - duration * pull_, duration, impact_);
    state_.velocity = particle_.spin = Vec3{};
    state_.time += duration;
    outcome_.resting = true;
}

bool RollbackMover::begin(double duration) {
    stretch_.reset();
    from_ = state_.position;
    outcome_.resting = false;
    manifold_.touch_again(touch_rule());
    if (in_contact()) plan_contact(duration);
    if (!stretch_) flight_ = flight_for(duration);
    if (can_be_followed(flight_.path)) return true;
    outcome_.frozen = true;
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
    if (!stretch_ && trial_ == Trial::own_step) {
        const Flight flight = flight_for(elapsed);
        return {flight.path.end, flight.end_velocity};
    }
    return ricochet::state_at(rules_.settings.integrator, rules_.forces, flight_, elapsed);
}

/// Bisection: free at one end, blocked at the other, until the bracket is as small as asked for.
CollisionBracket RollbackMover::bracket() {
    const double whole = flight_.path.duration;
    if (stretch_ && stretch_->at_rest) return {whole, false};
    const Obstacles obstacles(rules_.world, from_, state_.radius);
    const auto is_blocked = [&](const Vec3& place) {
        ++outcome_.trials;
        return !is_finite(place) || obstacles.block(place);
    };
    blocked_place_ = flush_tiny(flight_.path.end);
    if (!is_blocked(blocked_place_)) return {whole, false};
    double free = 0.0;
    double blocked = whole;
    while (blocked - free > rules_.settings.rollback.time_tolerance) {
        const double middle = 0.5 * (free + blocked);
        if (middle <= free || middle >= blocked) break;
        const Vec3 place = flush_tiny(state_at(middle).position);
        if (is_blocked(place)) {
            blocked = middle;
            blocked_place_ = place;
        } else {
            free = middle;
        }
    }
    return {free, true};
}

void RollbackMover::advance(double elapsed) {
    stretch_ ? follow_stretch(elapsed) : fly(elapsed);
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
}

void RollbackMover::follow_stretch(double elapsed) {
    const Vec3 before = state_.velocity;
    const bool rests = stretch_->at_rest;
    if (!rests) state_.position = flush_tiny(flight_.path.position(elapsed));
    const Motion arriving{rests ? Vec3{} : flight_.path.velocity(elapsed), particle_.spin};
    const Motion motion = end_of_stretch(*stretch_, elapsed, arriving, state_.radius, manifold_.normals().front());
    state_.velocity = motion.velocity;
    particle_.spin = rests ? Vec3{} : motion.spin;
    manifold_.record_push(state_.velocity - before - elapsed * pull_, elapsed, impact_);
    outcome_.resting = rests;
    kick_velocity_ = Vec3{};
    if (turns_) turn_along();
}

/// Bounces, or stays on what it has met when all rebounds are slow and something presses it on.
void RollbackMover::answer() {
    ++outcome_.bounces;
    outcome_.resting = false;
    Obstacles(rules_.world, from_, state_.radius).gather(blocked_place_, state_.position, state_.velocity, met_);
    const bool on_surface = std::any_of(met_.begin(), met_.end(), [&](const ContactSurface& met) {
        return rules_.world.point_on(met.surface, state_.position);
    });
    if (on_surface) {
        leave_surface();
        return;
    }
    if (met_.empty()) return;
    if (will_stay()) {
        impact_.land(met_);
        for (const ContactSurface& met : met_) manifold_.add(met);
    } else {
        impact_.reflect(met_);
    }
}

/// A centre that was put exactly on a surface has no side yet: it gets the one that the normal points to.
void RollbackMover::leave_surface() {
    const Path path = line_path(state_.position, state_.velocity, flight_.path.duration);
    const ContactQueryResult found = find_first_contact(geometry_, {path, state_.radius}, scratch_.contacts);
    const auto place = step_off(found.near, state_.position);
    if (!place) {
        ++outcome_.stayed;
        return;
    }
    if (scratch_.record_segments) scratch_.segments.push_back({state_.position, *place, state_.time});
    state_.position = *place;
}

/// True when every rebound is slower than the resting speed, on surfaces that can hold, and something presses it on.
bool RollbackMover::will_stay() const {
    const Vec3 a = is_kicked() ? flown_->acceleration : rules_.forces.acceleration(state_);
    // What is touched already holds its part; what is left may press onto the next surface.
    const Vec3 pull = project_off(a, manifold_.normals());
    bool pressed = false;
    for (const ContactSurface& met : met_) {
        const Material& material = impact_.material_of(met.surface);
        // What the step's own kick put into the velocity is not the speed of an impact.
        const double approach = -dot(state_.velocity, met.normal) - std::max(0.0, -dot(kick_velocity_, met.normal));
        const bool can_rest = material.can_hold(rules_.settings.resting_speed);
        const double rebound = approach > 0.0 ? material.restitution_at(approach) * approach : 0.0;
        if (approach > 0.0 && (!can_rest || rebound >= rules_.settings.resting_speed)) return false;
        pressed = pressed || (can_rest && std::min(dot(a, met.normal), dot(pull, met.normal)) < 0.0);
    }
    return pressed;
}

}  // namespace ricochet
