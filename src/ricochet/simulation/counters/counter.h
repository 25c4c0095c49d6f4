/// \file
/// Counters: disks that particles pass without touching them.
#pragma once

#include <cstdint>
#include <string>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A disk at rest that counts the particles whose centres pass it. The disk belongs to its front side, to which the
/// normal points. So a centre exactly on the disk has passed it forward, and not yet backward.
struct CounterDescription {
    std::string name;      ///< not empty, and different from the names of other counters
    Vec3 center;           ///< m
    Vec3 normal{0, 0, 1};  ///< direction that counts as forward; of any length above 0
    double radius = 1.0;   ///< m, above 0; the rim belongs to the disk
};

/// Passages of one counter since the start of the run. A particle that passes several times counts each time.
struct CounterTotals {
    std::string name;
    std::uint64_t forward = 0;   ///< passages along the normal
    std::uint64_t backward = 0;  ///< passages against the normal
    double forward_mass = 0.0;   ///< kg, sum of the masses of the forward passages
    double backward_mass = 0.0;  ///< kg
};

}  // namespace ricochet
