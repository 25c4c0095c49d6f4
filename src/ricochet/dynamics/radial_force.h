/// \file
/// A force towards or away from a centre by a power of the distance.
#pragma once

#include <memory>

#include "ricochet/dynamics/force.h"

namespace ricochet {

/// F = -strength (s / reference)^(exponent - 1) d / reference with d from the centre and s^2 = |d|^2 + softening^2.
/// Without softening its size is strength (|d| / reference)^exponent: exponent 1 is a spring, 0 a constant pull, -2
/// Coulomb's and Newton's law. Its potential is a power of s, or a logarithm for exponent -1; zero at the centre for
/// exponents above -1, at s = reference for -1, infinitely far away below. At the very centre it does not pull.
struct RadialForceSettings {
    Vec3 center;             ///< m
    double strength = 0.0;   ///< N at the reference distance; negative pushes away
    double exponent = -2.0;  ///< -12 to 12
    double softening = 0.0;  ///< m, >= 0
    double reference = 1.0;  ///< m, > 0
};
[[nodiscard]] std::unique_ptr<Force> make_radial_force(const RadialForceSettings& settings);

/// Largest magnitude of RadialForceSettings::exponent.
inline constexpr double kLargestRadialExponent = 12.0;

}  // namespace ricochet
