/// \file
/// Where a mesh touches or crosses itself.
#pragma once

#include <cstddef>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Pairs of triangles that have a point in common besides the vertices and the edge that both name: they cross, touch
/// or lie on each other. Exact. Degenerate triangles do not count. Runs in parallel; the count does not depend on the
/// number of threads. Time is close to linear in the number of triangles and of pairs whose boxes overlap.
[[nodiscard]] std::size_t count_self_intersections(const TriangleMesh& mesh);

}  // namespace ricochet
