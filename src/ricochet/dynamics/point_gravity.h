/// \file
/// Gravity of point masses.
#pragma once

#include <memory>
#include <vector>

#include "ricochet/dynamics/force.h"

namespace ricochet {

/// One attracting mass, fixed in place.
struct Attractor {
    Vec3 position;           ///< m
    double strength = 0.0;   ///< G M, m^3/s^2; negative repels
    double softening = 0.0;  ///< m, >= 0: the mass is spread over about this length
};

/// a = -strength d / (|d|^2 + softening^2)^(3/2), d from the attractor to the particle; summed over the attractors in
/// their order. At the very place of an attractor without softening, where nothing is defined, it does not pull.
/// Source: H. C. Plummer, MNRAS 71, 1911.
[[nodiscard]] std::unique_ptr<Force> make_point_gravity(std::vector<Attractor> attractors);

}  // namespace ricochet
