#include "ricochet/response/flat_interval.h"

namespace ricochet {

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
    // Mean force times displacement neglects the correlation between the changes of force and of velocity. `later` adds
    // it.
    const double later = time * time / 6.0 * dot(mean.forces - begin_.forces, mean.interval.acceleration);
    return dot(mean.forces, displacement) + later;
}

}  // namespace ricochet
