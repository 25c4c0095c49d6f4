/// \file
/// Private to the integrators: the backward Euler step of one particle, and parts shared with the step of a system.
#pragma once

#include <array>

#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/system_integrator.h"

namespace ricochet {

/// Three columns of a 3 x 3 matrix.
using Columns3 = std::array<Vec3, 3>;

/// Returns the velocity v1 with v1 = v0 + h a(x0 + h v1, v1, t + h), by Newton's method from v0 on.
[[nodiscard]] Vec3 implicit_euler_velocity(const ForceField& forces, const ForceInput& state, double h);

/// Returns the derivative of a(x0 + h v1, v1, t + h) with respect to v1, in 1/s, from forward differences. It only
/// steers the iteration: its error costs iterations, not accuracy.
[[nodiscard]] Columns3 acceleration_slope(const ForceField& forces, const ForceInput& state, const Vec3& v1, double h);

/// Returns true if a velocity correction is within rounding of the largest speed, which includes the velocity gain of a
/// step.
[[nodiscard]] bool is_converged(double correction, double largest_speed);

}  // namespace ricochet
