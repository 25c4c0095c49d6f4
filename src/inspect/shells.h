/// \file
/// The shells of a closed mesh: sets of triangles joined by edges, at equal positions.
#pragma once

#include <cstddef>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Returns true if two shells of a mesh overlap. Shells are sets of triangles joined by edges, at equal positions.
/// Shells that only touch do not overlap. Neither do nested shells, even if they touch. The result is exact for shells
/// that cross properly. If their triangles only touch, or lie in one plane, points decide. These points are centroids
/// of the first of these triangles, and points halfway along an edge from its intersection with the other triangle's
/// plane. A shell is nested if points close to its centroids, on the inner side, are within the other.
[[nodiscard]] bool shells_overlap(const TriangleMesh& mesh);

/// Returns the number of shells within other shells of the same winding. Such a shell is a hole by the parity rule of
/// inside_rule.h. However, it adds to signed_volume(), from which a hole would subtract. All vertices of a nested
/// shell are within the others; the shells must not overlap. Repeated faces count as in closed_surface.h. The mesh must
/// be closed.
[[nodiscard]] std::size_t count_shells_nested_alike(const TriangleMesh& mesh);

}  // namespace ricochet
