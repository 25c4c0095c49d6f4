/// \file
/// What a sound closed mesh must satisfy, decided on the index list alone and with exact predicates.
#pragma once

#include <cstddef>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet::meshes {

/// Directed edges that do not occur exactly once together with exactly one opposite: 0 for a closed, edge-manifold,
/// consistently wound mesh.
[[nodiscard]] std::size_t unpaired_edges(const TriangleMesh& mesh);

/// Vertices minus edges plus triangles; twice the number of shells minus twice the number of handles for a closed mesh.
[[nodiscard]] long euler_characteristic(const TriangleMesh& mesh);

/// Connected parts, joined through shared vertices.
[[nodiscard]] std::size_t shells(const TriangleMesh& mesh);

/// Triangles with collinear corners, decided exactly.
[[nodiscard]] std::size_t degenerate_triangles(const TriangleMesh& mesh);

/// Vertices that no triangle uses.
[[nodiscard]] std::size_t unused_vertices(const TriangleMesh& mesh);

/// Pairs of triangles that intersect anywhere but in the vertices they share, decided exactly by brute force over pairs
/// with overlapping boxes. Pairs that share an edge are left out.
[[nodiscard]] std::size_t self_intersections(const TriangleMesh& mesh);

}  // namespace ricochet::meshes
