/// \file
/// The names of surfaces, and points on them.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Number of a surface (a plane, a ball, the side or a cap of a cylinder, or one triangle of a mesh) among those of all
/// colliders. Ascending in (collider, triangle): the order that breaks ties.
using SurfaceId = std::uint32_t;

/// Which collider, and which triangle of it (0 for planes, balls and cylinders), a surface is.
struct SurfaceName {
    std::uint32_t collider = 0;
    std::uint32_t triangle = 0;
};

/// A position on a surface.
struct SurfacePosition {
    Vec3 point;        ///< m
    Vec3 barycentric;  ///< for the triangle's corners in the order of its mesh; zero for planes, balls and cylinders
};

}  // namespace ricochet
