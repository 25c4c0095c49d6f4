/// \file
/// Joins vertices whose distance is within a given tolerance.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Returns the mesh with nearby vertices merged. Vertices are processed in the order of the list. Each vertex is
/// replaced by the first kept vertex within the tolerance (m), or is kept itself. Kept vertices do not move, and no
/// vertex moves farther than the tolerance. Triangles keep their indices. A triangle that loses its area is ignored by
/// queries. Vertices without triangles are left out. A tolerance of 0 joins vertices at equal positions.
///
/// Throws InputError if the tolerance is not finite or below 0. It also throws if the tolerance is above 0, but below
/// 2^-48 of the largest coordinate, because rounding would then decide. It also throws if every triangle loses its area
/// because two of its corners are joined.
[[nodiscard]] TriangleMesh merged_within(const TriangleMesh& mesh, double tolerance);

}  // namespace ricochet
