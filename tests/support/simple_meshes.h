/// \file
/// Small closed meshes for tests, wound outward.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::testing {

/// Returns a box of twelve triangles.
[[nodiscard]] TriangleMesh box_mesh(const Vec3& lower, const Vec3& upper);

/// Returns an octahedron whose triangles are split `levels` times into four and projected onto the sphere. It has 8 *
/// 4^levels triangles.
[[nodiscard]] TriangleMesh sphere_mesh(const Vec3& center, double radius, int levels);

/// Returns the mesh with every face flipped.
[[nodiscard]] TriangleMesh flipped(TriangleMesh mesh);

/// Returns both meshes in one list, without merging vertices.
[[nodiscard]] TriangleMesh merged(TriangleMesh first, const TriangleMesh& second);

/// Returns the mesh with every vertex moved by `offset` and rounded.
[[nodiscard]] TriangleMesh moved(TriangleMesh mesh, const Vec3& offset);

}  // namespace ricochet::testing
