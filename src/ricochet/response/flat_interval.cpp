#include "ricochet/response/flat_interval.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Number of Runge-Kutta steps in an interval. For a slide that turns by a right angle in ten intervals, two steps lose
/// 1e-6 of the speed, and one step 2e-5. Local: the cost is small compared with a query.
constexpr int kParts = 2;

}  // namespace

TurningSlip::TurningSlip(const Motion& motion, double radius, const SupportSurface& surface, const Vec3& forces,
                         double pressure)
    : start_(motion),
      radius_(radius),
      normal_(surface.normal),
      pressing_(std::max(0.0, -dot(forces, normal_))),
      friction_(pressure * surface.friction * pressing_),
      slip_(slip_on(surface, motion, radius)),
      slip_rate_(radius > 0.0 ? kSlipAcceleration : 1.0),
      rounding_(kSlowSlip * speed_scale(motion, radius, {&surface, 1})) {
    along_ = forces + pressing_ * normal_;
    // Projects each vector twice, so that the rounding error of the projection is relative to the vector's own size.
    // Reason: friction has the direction of the slip even if the slip is very slow.
    for (Vec3* const v : {&along_, &slip_}) {
        for (int pass = 0; pass < 2; ++pass) *v -= dot(*v, normal_) * normal_;
    }
}

double TurningSlip::longest(double duration) const {
    const double speed = length(slip_);
    if (!(friction_ > 0.0) || !(speed > rounding_)) return 0.0;
    const Vec3 heading = slip_ / speed;
    const Vec3 change = along_ + slip_rate_ * friction_on(slip_);
    const double braking = -dot(change, heading);
    const double turning = length(change + braking * heading);
    if (!(turning * duration > kStraightHeading * speed)) return 0.0;
    // Friction turns the slip back to its steady direction at the rate slip_rate_ * friction_ / speed.
    const double stable = kParts * kStageLimit * speed / (slip_rate_ * friction_);
    if (turning * duration <= kMostStraightTurn * speed) {
        return 2.0 * braking * duration < speed && duration <= stable ? duration : 0.0;
    }
    return std::min({duration, stable, kMaxArcAngle * speed / length(change)});
}

Vec3 TurningSlip::friction_on(const Vec3& slip) const { return (-friction_ / length(slip)) * slip; }

TurningSlip::State TurningSlip::at(double t) const {
    const double part = t / kParts;
    State state{{}, start_.velocity, {}, {}};
    Vec3 slip = slip_;
    for (int k = 0; k < kParts; ++k) {
        const auto friction_after = [&](const Vec3& mean_friction, double time) {
            return friction_on(slip + time * (along_ + slip_rate_ * mean_friction));
        };
        const Vec3 first = friction_on(slip);
        const Vec3 second = friction_after(first, 0.5 * part);
        const Vec3 third = friction_after(second, 0.5 * part);
        const Vec3 fourth = friction_after(third, part);
        const Vec3 mean = (first + 2.0 * (second + third) + fourth) / 6.0;
        const Vec3 mean_of_early = (first + second + third) / 3.0;  // weighted by the time that is left
        state.displacement += part * (state.velocity + (0.5 * part) * (along_ + mean_of_early));
        state.velocity += part * (along_ + mean);
        slip += part * (along_ + slip_rate_ * mean);
        state.friction += mean / kParts;
    }
    state.acceleration = along_ + state.friction;
    return state;
}

Path FlatInterval::path(const Vec3& x, double time) const {
    const Vec3& v = motion().velocity;
    const Vec3& a = begin_.interval.acceleration;
    if (!slip_ && !varies_) return parabola_path(x, v, a, time);
    if (!(time > 0.0)) return line_path(x, v, 0.0);
    if (slip_) {
        const TurningSlip::State end = slip_->at(time);
        return hermite_path(x, v, x + end.displacement, end.velocity, time);
    }
    const Vec3 turned = middle_.interval.acceleration - a;
    const Vec3 end = x + time * (v + time * (0.5 * a + (time / (3.0 * duration())) * turned));
    return hermite_path(x, v, end, v + time * mean_until(time).interval.acceleration, time);
}

PlannedInterval FlatInterval::mean_until(double time) const {
    if (slip_) {
        PlannedInterval result = middle_;
        const TurningSlip::State end = slip_->at(time);
        result.interval.acceleration = end.acceleration;
        result.interval.spin_acceleration = slip_->spin_acceleration(end.friction);
        return result;
    }
    if (!varies_) return middle_;
    const double part = time / duration();
    const auto mean = [&](const Vec3& begin, const Vec3& middle) { return begin + part * (middle - begin); };
    const ContactInterval& begin = begin_.interval;
    PlannedInterval result = middle_;
    result.forces = mean(begin_.forces, middle_.forces);
    result.interval.acceleration = mean(begin.acceleration, middle_.interval.acceleration);
    result.interval.spin_acceleration = mean(begin.spin_acceleration, middle_.interval.spin_acceleration);
    return result;
}

double FlatInterval::work_until(double time, const Vec3& displacement) const {
    const PlannedInterval mean = mean_until(time);
    // Mean force times displacement neglects the correlation of the changes of force and velocity.
    const double later = time * time / 6.0 * dot(mean.forces - begin_.forces, mean.interval.acceleration);
    return dot(mean.forces, displacement) + later;
}

}  // namespace ricochet
