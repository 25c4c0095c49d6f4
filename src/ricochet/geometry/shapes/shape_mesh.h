/// \file
/// Meshes that show shapes with a formula. For pictures and files; nothing collides with them.
#pragma once

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// A ball of that radius (m) about the local origin, placed; vertices on the surface, wound outward.
[[nodiscard]] TriangleMesh ball_mesh(double radius, const Placement& placement);

/// A cylinder about the local z axis with flat caps, centred on the origin, placed; wound outward.
[[nodiscard]] TriangleMesh cylinder_mesh(double radius, double height, const Placement& placement);

/// A box of these edge lengths (m) about the local origin, not placed: two triangles a side, wound outward.
[[nodiscard]] TriangleMesh cuboid_mesh(const Vec3& size);

}  // namespace ricochet
