/// \file
/// Small closed meshes, wound outward, for tests.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::testing {

/// Twelve triangles.
[[nodiscard]] TriangleMesh box_mesh(const Vec3& lower, const Vec3& upper);

/// An octahedron whose triangles are split `levels` times into four and pushed onto the sphere: 8 * 4^levels triangles.
[[nodiscard]] TriangleMesh sphere_mesh(const Vec3& center, double radius, int levels);

/// Every face turned around.
[[nodiscard]] TriangleMesh flipped(TriangleMesh mesh);

/// Both meshes in one list; vertices are not joined.
[[nodiscard]] TriangleMesh merged(TriangleMesh first, const TriangleMesh& second);

/// Every vertex moved by `offset` and rounded.
[[nodiscard]] TriangleMesh moved(TriangleMesh mesh, const Vec3& offset);

}  // namespace ricochet::testing
