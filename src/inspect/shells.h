/// \file
/// The shells of a closed mesh. A shell is a set of triangles that common edges connect; vertices at equal positions
/// count as one.
#pragma once

#include <cstddef>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Returns true if two shells of a mesh overlap. Shells that only touch do not overlap. Nested shells do not overlap
/// either, even if they touch. The result is exact if an edge of one shell passes through the interior of a triangle of
/// the other. If triangles only touch or are in one plane, sample points decide. The sample points are the centroids of
/// these triangles, and points on edges halfway between a corner and the other triangle's plane. A shell is nested if
/// points close to the centroids of its triangles, on the inner side, are inside the other shell.
[[nodiscard]] bool shells_overlap(const TriangleMesh& mesh);

/// Returns the number of shells within other shells of the same winding. Such a shell bounds a hole by the parity rule
/// of inside_rule.h. However, its volume is added to signed_volume(), whereas the volume of a hole should be
/// subtracted. A shell counts as nested if all its vertices are inside other shells of the same winding. The mesh must
/// be closed, and its shells must not overlap. Repeated faces count as in closed_surface.h.
[[nodiscard]] std::size_t count_shells_nested_alike(const TriangleMesh& mesh);

}  // namespace ricochet
