/// \file
/// Checks for a sound closed mesh. They use the index list and exact predicates only.
#pragma once

#include <cstddef>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Returns the number of directed edges without exactly one opposite, or that occur more than once. The number is 0 for
/// a closed, edge-manifold, consistently wound mesh.
[[nodiscard]] std::size_t unpaired_edges(const TriangleMesh& mesh);

/// Returns vertices minus edges plus triangles. For a closed mesh this is twice the shells minus twice the handles.
[[nodiscard]] long euler_characteristic(const TriangleMesh& mesh);

/// Returns the number of connected components. Triangles are connected by shared vertices.
[[nodiscard]] std::size_t shells(const TriangleMesh& mesh);

/// Returns the number of triangles with collinear corners, decided exactly.
[[nodiscard]] std::size_t degenerate_triangles(const TriangleMesh& mesh);

/// Returns the number of vertices that no triangle uses.
[[nodiscard]] std::size_t unused_vertices(const TriangleMesh& mesh);

/// Returns the number of pairs of triangles that intersect outside their shared vertices. The test is exact and tries
/// all pairs with overlapping boxes. Pairs that share an edge are skipped.
[[nodiscard]] std::size_t self_intersections(const TriangleMesh& mesh);

}  // namespace ricochet::meshes
