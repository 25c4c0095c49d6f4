/// \file
/// Straight piece of a trajectory.
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Straight piece of the trajectory of a particle's centre.
struct Segment {
    Vec3 from;
    Vec3 to;
    double time = 0.0;  ///< in s, simulation time at the start of the flight or contact phase
    // Simulation times of both ends, in s, if colliders move. The segment is tested in the colliders' frames at these
    // times.
    double begin = 0.0;
    double end = 0.0;
};

}  // namespace ricochet
