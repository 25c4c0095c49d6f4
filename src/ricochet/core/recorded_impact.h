/// \file
/// Record, for the verifier, of an impact of a particle on surfaces.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/core/motion_part.h"

namespace ricochet {

/// A resolved impact: the motion before and after it, the surfaces, and the contact state.
struct RecordedImpact {
    struct Surface {
        std::uint32_t surface = 0;           ///< number of the surface
        Vec3 normal;                         ///< unit vector, towards the particle
        Vec3 velocity_before;                ///< of the surface at the contact point, in m/s
        Vec3 velocity_after;                 ///< in m/s
        double restitution = 1.0;            ///< of its material, 0..1
        double restitution_threshold = 0.0;  ///< of its material, in m/s
        bool is_support = false;             ///< the impact treated it as a surface that supports the particle
    };

    double time = 0.0;  ///< in s
    RecordedMotion before;
    RecordedMotion after;
    std::vector<Surface> surfaces;
    std::vector<std::uint32_t> supported_by;  ///< numbers of the surfaces of the contact interval that the impact ended
};

}  // namespace ricochet
