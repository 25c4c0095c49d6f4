#include "ricochet/core/body_path.h"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

/// A polynomial c[0] t + c[1] t^2 + c[2] t^3 with its first and second derivative.
template <class Value>
struct Cubic {
    Cubic(const std::array<Value, 3>& c, double t)
        : value(t * (c[0] + t * (c[1] + t * c[2]))),
          rate(c[0] + t * (2.0 * c[1] + (3.0 * t) * c[2])),
          second(2.0 * c[1] + (6.0 * t) * c[2]) {}
    Value value, rate, second;
};

double size_of(double x) { return std::fabs(x); }
double size_of(const Vec3& v) { return length(v); }

/// Returns bounds of the derivatives of a cubic for |t| <= h.
template <class Value>
DerivativeBounds bounds_of(const std::array<Value, 3>& c, double h) {
    const double a = size_of(c[0]);
    const double b = size_of(c[1]);
    const double d = size_of(c[2]);
    return {h * (a + h * (b + h * d)), a + h * (2.0 * b + 3.0 * h * d), 2.0 * b + 6.0 * h * d, 6.0 * d, 0.0};
}

}  // namespace

MovingPose BodyPath::turned_by(double angle, double rate, double second) const {
    MovingPose pose;
    pose.world_from_frame = at_begin;
    turn(pose, axis, angle, rate, second);
    return pose;
}

MovingPose BodyPath::at(double time) const {
    const double t = time - begin;
    const Cubic<Vec3> moved(center_path, t);
    const Cubic<double> turned(turns, t);
    MovingPose pose = turned_by(degrees + turned.value, turned.rate, turned.second);
    // The carrier point follows its cubic, and the frame's origin rotates about this point.
    const Vec3 arm = pose.world_from_frame.direction(carrier);
    const Vec3 arm_at_begin = turned_by(degrees).world_from_frame.direction(carrier);
    const Vec3 carried = cross(pose.angular_velocity, arm);
    pose.world_from_frame.translation += moved.value - (arm - arm_at_begin);
    pose.velocity = moved.rate - carried;
    pose.acceleration = moved.second - cross(pose.angular_acceleration, arm) - cross(pose.angular_velocity, carried);
    return pose;
}

MotionBounds BodyPath::bounds(double from, double to) const {
    const double h = std::max(std::fabs(from - begin), std::fabs(to - begin));
    MotionBounds bounds;
    bounds.rotation = turn_bounds(bounds_of(turns, h));
    bounds.origin = bounds_of(center_path, h);
    bounds.origin[0] = 0.0;
    for (std::size_t n = 1; n < bounds.origin.size(); ++n) bounds.origin[n] += length(carrier) * bounds.rotation[n];
    return bounds;
}

}  // namespace ricochet
