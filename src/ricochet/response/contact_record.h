/// \file
/// Impacts as they are recorded.
#pragma once

#include <cstdint>

#include "ricochet/collision/surface.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// What one surface does in an impact, as the contact log writes it. An impact in a corner is several of them, of the
/// same time and particle, each beginning with the velocity that the one before left. The penalty response, whose
/// contacts last, records their beginnings, with the same velocity before and after (and no impulse, but on surfaces of
/// chance).
struct ContactRecord {
    double time = 0.0;  ///< s, simulation time
    std::uint64_t particle = 0;
    SurfaceId surface = 0;
    Vec3 position;            ///< of the particle's centre: the safe position, m
    Vec3 normal;              ///< unit, from the surface to the particle
    Vec3 velocity_before;     ///< m/s
    Vec3 velocity_after;      ///< m/s
    double mass = 0.0;        ///< kg
    double radius = 0.0;      ///< m
    Vec3 surface_velocity{};  ///< m/s, of the surface's own material there, see SurfaceMotion; 0 where it does not grip
};

}  // namespace ricochet
