/// \file
/// Backward Euler step of one particle, and the derivative that the step of a system also needs. Private to the
/// integrators.
#pragma once

#include <array>

#include "ricochet/dynamics/forces.h"

namespace ricochet {

/// Columns of a 3 x 3 matrix.
using Columns3 = std::array<Vec3, 3>;

/// Returns the solution v1 of v1 = v0 + h a(x0 + h v1, v1, t + h), in m/s, by Newton's method with the start value v0.
[[nodiscard]] Vec3 implicit_euler_velocity(const ForceField& forces, const ForceInput& state, double h);

/// Returns the derivative of a(x0 + h v1, v1, t + h) with respect to v1, in 1/s, from forward differences. An error of
/// the derivative can cost iterations, but does not reduce the accuracy of the solution.
[[nodiscard]] Columns3 acceleration_slope(const ForceField& forces, const ForceInput& state, const Vec3& v1, double h);

}  // namespace ricochet
