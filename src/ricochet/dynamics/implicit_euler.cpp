#include "ricochet/dynamics/implicit_euler.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"

namespace ricochet {

namespace {

/// Relative increments for finite differences of the velocity. kSpeedStep, the square root of the rounding of doubles,
/// is relative to the speed. kPlaceStep is relative to the coordinates divided by the time step, so that the increment
/// still changes large coordinates. Local: the increments affect only the speed of convergence.
constexpr double kSpeedStep = 0x1p-26;
constexpr double kPlaceStep = 0x1p-38;

ForceInput at_end(const ForceInput& state, const Vec3& v1, double h) {
    ForceInput end = state;
    end.position = state.position + h * v1;
    end.velocity = v1;
    end.time = state.time + h;
    return end;
}

/// Returns the solution of the linear system with these columns, by Cramer's rule. Returns the right-hand side if the
/// system is singular.
Vec3 solved(const Columns3& m, const Vec3& right) {
    const double determinant = dot(m[0], cross(m[1], m[2]));
    if (determinant == 0.0 || !std::isfinite(determinant)) return right;
    return Vec3{dot(right, cross(m[1], m[2])), dot(m[0], cross(right, m[2])), dot(m[0], cross(m[1], right))} /
           determinant;
}

}  // namespace

Columns3 acceleration_slope(const ForceField& forces, const ForceInput& state, const Vec3& v1, double h) {
    const double step = std::max({kSpeedStep * max_abs(v1), kSpeedStep * max_abs(state.velocity),
                                  kPlaceStep * max_abs(state.position) / h, kSpeedStep * kSpeedStep});
    const Vec3 here = forces.acceleration(at_end(state, v1, h));
    Columns3 slope;
    for (int axis = 0; axis < 3; ++axis) {
        Vec3 beside = v1;
        beside[axis] += step;
        slope[static_cast<std::size_t>(axis)] =
            (forces.acceleration(at_end(state, beside, h)) - here) / (beside[axis] - v1[axis]);
    }
    return slope;
}

Vec3 implicit_euler_velocity(const ForceField& forces, const ForceInput& state, double h) {
    const Vec3& v0 = state.velocity;
    Vec3 v1 = v0;
    for (int iteration = 0; iteration < kMostNewtonSteps; ++iteration) {
        const Vec3 gain = h * forces.acceleration(at_end(state, v1, h));
        const Vec3 residual = v1 - v0 - gain;
        Columns3 slope = acceleration_slope(forces, state, v1, h);
        for (int axis = 0; axis < 3; ++axis) {
            Vec3& column = slope[static_cast<std::size_t>(axis)];
            column *= -h;
            column[axis] += 1.0;
        }
        const Vec3 correction = solved(slope, residual);
        v1 -= correction;
        const double speed = std::max({max_abs(v0), max_abs(v1), max_abs(gain)});
        if (max_abs(correction) <= kNewtonTolerance * speed || !is_finite(v1)) break;
    }
    return v1;
}

}  // namespace ricochet
