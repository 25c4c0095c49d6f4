/// \file
/// Numbers and names of surfaces, and points on them.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Number of a surface among the surfaces of all colliders. A surface is a plane, a ball, the side or a cap of a
/// cylinder, or one triangle of a mesh. Numbers ascend in (collider, triangle). This order breaks ties.
using SurfaceId = std::uint32_t;

/// Name of a surface: its collider, and its triangle within it (0 for planes, balls and cylinders).
struct SurfaceName {
    std::uint32_t collider = 0;
    std::uint32_t triangle = 0;
};

/// A point on a surface.
struct SurfacePosition {
    Vec3 point;  ///< in m
    /// Weights of the triangle's corners in the order of its mesh; zero for planes, balls and cylinders.
    Vec3 barycentric;
};

}  // namespace ricochet
