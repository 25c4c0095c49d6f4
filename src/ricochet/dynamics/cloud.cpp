#include "ricochet/dynamics/cloud.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/portable_math.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// A mathematical constant.
constexpr double kTwoPi = 6.28318530717958647692;

/// Coefficients of the solution of a damped oscillator. With g as half of the damping, d(t) = c d0 + s (v0 + g d0) and
/// d'(t) = c v0 - s (g v0 + pull d0).
struct Decay {
    double c = 1.0;
    double s = 0.0;
};

/// Returns sinh(x) / x near 0 for square = x^2, or sin(x) / x for square = -x^2. The next term of the series is below
/// rounding.
double near_zero(double square) { return 1.0 + square / 6.0 * (1.0 + square / 20.0); }

Decay decay_of(const CloudRule& rule, double t) {
    // Local: for squares below this value, the series of near_zero() is exact to rounding.
    constexpr double kSmallSquare = 1e-6;
    const double half = 0.5 * rule.damping;
    const double square = half * half - rule.pull;  // square of the rate if the oscillator is overdamped
    const double fading = portable_exp(-half * t);
    if (square < 0.0) {
        const double turns = std::sqrt(-square) * t / kTwoPi;
        const double sine =
            -square * t * t < kSmallSquare ? t * near_zero(square * t * t) : sine_of_turns(turns) / std::sqrt(-square);
        return {fading * sine_of_turns(turns + 0.25), fading * sine};
    }
    const double rate = std::sqrt(square);
    const double slow = portable_exp((rate - half) * t);
    const double fast = portable_exp((-rate - half) * t);
    const double sine =
        square * t * t < kSmallSquare ? fading * t * near_zero(square * t * t) : (slow - fast) / (2.0 * rate);
    return {0.5 * (slow + fast), sine};
}

}  // namespace

PhaseState turned_offset(const CloudRule& rule, const Vec3& offset, double age) {
    if (rule.turning == Vec3{}) return {offset, {}};
    const double rate = length(rule.turning);
    const Vec3 axis = rule.turning / rate;
    const double turns = rate * age / kTwoPi;
    const Vec3 along = dot(axis, offset) * axis;
    const Vec3 across = offset - along;
    const Vec3 now = along + sine_of_turns(turns + 0.25) * across + sine_of_turns(turns) * cross(axis, offset);
    return {now, cross(rule.turning, now)};
}

double cloud_turn(const CloudRule& rule, double duration) {
    return duration * std::max({length(rule.turning), std::sqrt(rule.pull), rule.damping});
}

PhaseState CloudMember::offset_at(double time) const {
    const PhaseState about = turned_offset(rule_, offset_, time - birth_time_);
    const double s = std::clamp(time - begin_, 0.0, parent_.duration);
    return {parent_.position(s) + about.position, parent_.velocity(s) + about.velocity};
}

PhaseState CloudMember::after(const PhaseState& state, double from, double to) const {
    const PhaseState old_offset = offset_at(from);
    const PhaseState new_offset = offset_at(to);
    const Vec3 off = state.position - old_offset.position;
    const Vec3 speed = state.velocity - old_offset.velocity;
    const double duration = to - from;
    if (rule_.pull == 0.0 && rule_.damping == 0.0) {
        return {flush_tiny(new_offset.position + (off + duration * speed)), new_offset.velocity + speed};
    }
    const Decay decay = decay_of(rule_, duration);
    const double half = 0.5 * rule_.damping;
    const Vec3 off_then = decay.c * off + decay.s * (speed + half * off);
    const Vec3 speed_then = decay.c * speed - decay.s * (half * speed + rule_.pull * off);
    return {flush_tiny(new_offset.position + off_then), new_offset.velocity + speed_then};
}

Vec3 CloudMember::acceleration(const ForceInput& input) const {
    const double s = std::clamp(input.time - begin_, 0.0, parent_.duration);
    Vec3 sum = 2.0 * parent_.c[2] + (6.0 * s) * parent_.c[3];
    if (rule_.turning != Vec3{}) {
        const PhaseState about = turned_offset(rule_, offset_, input.time - birth_time_);
        sum += cross(rule_.turning, about.velocity);
    }
    if (rule_.pull == 0.0 && rule_.damping == 0.0) return sum;
    const PhaseState offset = offset_at(input.time);
    return sum - rule_.pull * (input.position - offset.position) - rule_.damping * (input.velocity - offset.velocity);
}

}  // namespace ricochet
