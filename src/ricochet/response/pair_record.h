/// \file
/// Records of impacts between spheres.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// An impact of two spheres. If several impacts at the same time share spheres, each one has a record, with the
/// velocities before and after all of them.
struct PairImpactRecord {
    double time = 0.0;         ///< s
    std::uint64_t first = 0;   ///< id, the lower one
    std::uint64_t second = 0;  ///< id
    Vec3 position;             ///< m, centre of the first
    Vec3 normal;               ///< unit, from the second to the first
    Vec3 velocity_before;      ///< m/s, of the first
    Vec3 velocity_after;       ///< m/s, of the first
    Vec3 impulse;              ///< N s, given to the second
    double approach = 0.0;     ///< m/s
    double mass = 0.0;         ///< kg, of the first
    double radius = 0.0;       ///< m, of the first
};

}  // namespace ricochet
