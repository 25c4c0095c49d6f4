/// \file
/// Counters: disks that count the particles that pass through them, and do not affect the motion.
#pragma once

#include <cstdint>
#include <string>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A disk at rest that counts the particles whose centres pass through it. The normal points to the front side. The
/// points of the disk belong to the front side. A centre that moves forward has therefore passed when it is exactly on
/// the disk. A centre that moves backward has not passed yet when it is exactly on the disk.
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
