/// \file
/// The shells of a closed mesh: sets of triangles joined by edges, at equal positions.
#pragma once

#include <cstddef>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Returns true if two shells of a mesh overlap. Shells are sets of triangles joined by edges, at equal positions.
/// Shells that only touch, or of which one lies within the other, do not overlap. Exact for shells that cross properly.
/// Where their triangles only touch, or lie in one plane, places on the first of these triangles decide: centroids, and
/// places halfway from where an edge comes through the other's plane.
[[nodiscard]] bool shells_overlap(const TriangleMesh& mesh);

/// Returns the number of shells that lie within other shells wound the same way. Such a shell is a hole by the parity
/// rule of inside_rule.h, but adds to signed_volume() where a hole would subtract. The first vertex of a shell decides.
/// Repeated faces count as in closed_surface.h. The mesh must be closed.
[[nodiscard]] std::size_t count_shells_nested_alike(const TriangleMesh& mesh);

}  // namespace ricochet
