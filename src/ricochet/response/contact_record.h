/// \file
/// Records of impacts on surfaces.
#pragma once

#include <cstdint>

#include "ricochet/collision/surface.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Effect of one surface in an impact, as in the contact log. An impact in a corner has several records of the same
/// time and particle. The velocity before each record is the velocity after the previous one. Contacts of the penalty
/// response last for a time. Their records mark the start of the contact and have no impulse: the velocities before and
/// after are the same. Surfaces that absorb or reflect at random are exceptions.
struct ContactRecord {
    double time = 0.0;  ///< s, simulation time
    std::uint64_t particle = 0;
    SurfaceId surface = 0;
    Vec3 position;            ///< m, safe position of the particle's centre
    Vec3 normal;              ///< unit, from the surface to the particle
    Vec3 velocity_before;     ///< m/s
    Vec3 velocity_after;      ///< m/s
    double mass = 0.0;        ///< kg
    double radius = 0.0;      ///< m
    Vec3 surface_velocity{};  ///< m/s, of the surface's material there, see SurfaceMotion; 0 if it does not grip
};

}  // namespace ricochet
