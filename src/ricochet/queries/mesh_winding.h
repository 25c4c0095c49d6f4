/// \file
/// Private: winding numbers of a mesh around points, also for open meshes.
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

class MeshIndex;

/// A directed edge that more triangles use in its direction than in the opposite direction.
struct BoundaryEdge {
    Vec3 from;             ///< in m
    Vec3 to;               ///< in m
    double surplus = 1.0;  ///< number of triangles in this direction, less the number in the opposite direction
};

/// Returns all boundary edges of a mesh. Vertices at equal positions count as one.
[[nodiscard]] std::vector<BoundaryEdge> boundary_of(const TriangleMesh& mesh);

/// Returns the winding number of the mesh around a point: the fraction of all directions from the point that hit the
/// back of the mesh, less the fraction that hit its front. The result equals that of geometry/mesh/winding_number.h up
/// to rounding. The time grows with the number of boundary edges instead of triangles.
///
/// Half-strips extend from the boundary edges, opposite to a fixed direction, and close the mesh at infinity. A ray in
/// that fixed direction hits no half-strip. The sum of its crossings of the mesh is therefore exactly the winding
/// number of the closed surface. The solid angle of a half-strip is that of a spherical triangle. If the point is in
/// the plane of a half-strip, the same rule decides the sign of this angle and the crossings. Source of the idea: C.
/// Martens, M. Bessmeltsev, "One-shot Method for Computing Generalized Winding Numbers", Computer Graphics Forum 44,
/// 2025.
[[nodiscard]] double winding_number(const MeshIndex& mesh, const Vec3& point);

}  // namespace ricochet
