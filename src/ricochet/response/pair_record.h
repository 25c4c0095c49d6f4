/// \file
/// Impacts of spheres on each other as they are recorded.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// An impact of two spheres. Of several at the same time that share spheres each is one, all with the velocities before
/// and after them together.
struct PairImpactRecord {
    double time = 0.0;         ///< s
    std::uint64_t first = 0;   ///< id, the lower one
    std::uint64_t second = 0;  ///< id
    Vec3 position;             ///< m, of the first's centre
    Vec3 normal;               ///< unit, from the second to the first
    Vec3 velocity_before;      ///< m/s, of the first
    Vec3 velocity_after;       ///< m/s, of the first
    Vec3 impulse;              ///< N s, given to the second
    double approach = 0.0;     ///< m/s
    double mass = 0.0;         ///< kg, of the first
    double radius = 0.0;       ///< m, of the first
};

}  // namespace ricochet
