/// \file
/// Private to the integrators: the backward Euler step of one particle, and what it shares with that of a system.
#pragma once

#include <array>

#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/system_integrator.h"

namespace ricochet {

/// Three columns of a 3 x 3 matrix.
using Columns3 = std::array<Vec3, 3>;

/// Newton's iterations before the last iterate is taken as it is.
inline constexpr int kMostNewtonSteps = 20;

/// The velocity v1 with v1 = v0 + h a(x0 + h v1, v1, t + h), by Newton's method from v0 on.
[[nodiscard]] Vec3 implicit_euler_velocity(const ForceField& forces, const ForceInput& state, double h);

/// Derivative of a(x0 + h v1, v1, t + h) by v1, 1/s, from forward differences. It steers the iteration only: its error
/// costs iterations, not accuracy.
[[nodiscard]] Columns3 acceleration_slope(const ForceField& forces, const ForceInput& state, const Vec3& v1, double h);

/// True when a correction of the velocity is rounding beside the velocities and the accelerations' share of a step.
[[nodiscard]] bool is_converged(double correction, double largest_speed);

}  // namespace ricochet
