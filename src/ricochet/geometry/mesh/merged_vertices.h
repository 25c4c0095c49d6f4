/// \file
/// Vertices that nearly meet, joined within a tolerance that the caller states.
#pragma once

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Returns the mesh with each vertex replaced by the first vertex within the tolerance (m) that is kept itself, in the
/// order of the list. Kept vertices stay where they are, and no vertex moves farther than the tolerance. Triangles keep
/// their numbers. A triangle that loses its area takes no part in queries. Vertices without triangles are left out.
/// A tolerance of 0 joins equal positions. Throws InputError for a tolerance that is not finite, below 0, or, unless it
/// is 0, below 2^-48 of the largest coordinate, where rounding would decide, and for one that joins two corners of
/// every triangle.
[[nodiscard]] TriangleMesh merged_within(const TriangleMesh& mesh, double tolerance);

}  // namespace ricochet
