/// \file
/// A straight piece of a trajectory.
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A straight piece of a trajectory that a particle's centre has travelled.
struct Segment {
    Vec3 from;
    Vec3 to;
    double time = 0.0;  ///< s, simulation time at which the flight (or contact phase) that it belongs to began
    // Simulation times of its ends, s, where colliders move: by these it is judged in their frames.
    double begin = 0.0;
    double end = 0.0;
};

}  // namespace ricochet
