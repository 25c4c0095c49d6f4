/// \file
/// Private: how often a mesh winds around points, open meshes too.
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

class MeshIndex;

/// A directed edge that more triangles list in its direction than against it.
struct BoundaryEdge {
    Vec3 from;             ///< m
    Vec3 to;               ///< m
    double surplus = 1.0;  ///< triangles that list it so, less those that list it the other way
};

/// Returns all boundary edges of a mesh. Vertices at equal positions count as one.
[[nodiscard]] std::vector<BoundaryEdge> boundary_of(const TriangleMesh& mesh);

/// Returns the winding number of the mesh around a point: the part of all directions in which its back faces the point,
/// less the part in which its front does. It equals that of geometry/mesh/mesh_openings.h up to rounding, in a time
/// that grows with the number of boundary edges rather than of triangles.
///
/// Half-strips from the boundary edges, against a fixed direction, close the mesh at infinity. A ray in that direction
/// meets no half-strip, so its crossings of the mesh add up to the closed surface's winding number, exactly. The
/// half-strips' solid angles are those of spherical triangles, whose sign on a half-strip's plane is decided as the
/// crossings are. The idea: C. Martens, M. Bessmeltsev, "One-shot Method for Computing Generalized Winding Numbers",
/// Computer Graphics Forum 44, 2025.
[[nodiscard]] double winding_number(const MeshIndex& mesh, const Vec3& point);

}  // namespace ricochet
