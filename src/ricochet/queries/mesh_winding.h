/// \file
/// Private: winding numbers of a mesh around points, also for open meshes.
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

class MeshIndex;

/// A directed edge that more triangles list in its direction than against it.
struct BoundaryEdge {
    Vec3 from;             ///< in m
    Vec3 to;               ///< in m
    double surplus = 1.0;  ///< triangles that list it in this direction, less the ones that list it in the other
};

/// Returns all boundary edges of a mesh. Vertices at equal positions count as one.
[[nodiscard]] std::vector<BoundaryEdge> boundary_of(const TriangleMesh& mesh);

/// Returns the winding number of the mesh around a point: the fraction of all directions in which its back faces the
/// point, less the fraction in which its front does. It equals the result of geometry/mesh/mesh_openings.h up to
/// rounding. Its time grows with the number of boundary edges instead of triangles.
///
/// Half-strips extend from the boundary edges, opposite to a fixed direction, and close the mesh at infinity. A ray in
/// that direction meets no half-strip, so its crossings of the mesh add up to the winding number of the closed surface,
/// exactly. The solid angle of a half-strip is that of a spherical triangle. If the point lies in the plane of a
/// half-strip, the sign of this angle is decided by the same rule as the crossings. The idea: C. Martens, M.
/// Bessmeltsev, "One-shot Method for Computing Generalized Winding Numbers", Computer Graphics Forum 44, 2025.
[[nodiscard]] double winding_number(const MeshIndex& mesh, const Vec3& point);

}  // namespace ricochet
