/// \file
/// An impact of a particle on surfaces, as it is recorded for the verifier.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/core/motion_part.h"

namespace ricochet {

/// An impact as it was resolved: the motion on both sides of it, the surfaces, and the contact state.
struct RecordedImpact {
    struct Surface {
        std::uint32_t surface = 0;           ///< its number
        Vec3 normal;                         ///< unit, towards the particle
        Vec3 velocity_before;                ///< m/s, of the surface where it is touched
        Vec3 velocity_after;                 ///< m/s
        double restitution = 1.0;            ///< of its material, 0..1
        double restitution_threshold = 0.0;  ///< m/s, of its material
        bool holds = false;                  ///< the impact took it for one that holds the particle
    };

    double time = 0.0;  ///< s
    RecordedMotion before;
    RecordedMotion after;
    std::vector<Surface> surfaces;
    std::vector<std::uint32_t> held_by;  ///< surfaces of the contact interval that the impact has ended
};

}  // namespace ricochet
