/// \file
/// Small closed meshes for tests, wound outward.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::testing {

/// Returns an axis-aligned box of twelve triangles.
[[nodiscard]] TriangleMesh box_mesh(const Vec3& lower, const Vec3& upper);

/// Returns a sphere of 8 * 4^levels triangles. It is an octahedron whose triangles are split into four `levels` times,
/// with all vertices on the sphere.
[[nodiscard]] TriangleMesh sphere_mesh(const Vec3& center, double radius, int levels);

/// Returns the mesh with every face flipped.
[[nodiscard]] TriangleMesh flipped(TriangleMesh mesh);

/// Returns one mesh with the triangles of both meshes, without merging vertices.
[[nodiscard]] TriangleMesh merged(TriangleMesh first, const TriangleMesh& second);

/// Returns the mesh with every vertex moved by `offset` and rounded.
[[nodiscard]] TriangleMesh moved(TriangleMesh mesh, const Vec3& offset);

}  // namespace ricochet::testing
