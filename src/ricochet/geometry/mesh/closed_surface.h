/// \file
/// Definition of "closed": the surfaces that separate an inside from an outside.
///
/// A mesh is closed if every edge belongs to an even number of faces. Vertices at equal positions (0 and -0 are equal)
/// count as one vertex, because programs duplicate vertices along seams of textures and normals. A face that repeats an
/// earlier one, in any winding, counts once. The winding of other faces has no influence.
///
/// There is one exception. A sheet has two sides if faces repeat earlier ones in the opposite winding. If a shell is
/// closed only when both sides of its sheets count, both sides count. Such a sheet is closed, as a body without an
/// inside. A face that repeats an earlier one in the same winding is a copy, and never counts.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/geometry/mesh/edge_table.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// The faces that count when an inside is distinguished from an outside.
struct ClosedSurface {
    bool closed = false;
    bool oriented = false;                ///< closed, and equally many counted faces use each edge in both directions
    std::vector<std::uint32_t> left_out;  ///< repeated faces that do not count, in increasing order
};

/// Calls use(triangle) for all triangles of a mesh that are not left out. left_out: in increasing order.
template <class Use>
void for_each_counted(const TriangleMesh& mesh, const std::vector<std::uint32_t>& left_out, const Use& use) {
    auto skipped = left_out.begin();
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (skipped != left_out.end() && *skipped == t) {
            ++skipped;
        } else {
            use(t);
        }
    }
}

/// Examines faces whose vertices at equal positions are already joined. Time and memory are close to linear in the
/// number of corners.
[[nodiscard]] ClosedSurface closed_surface(const FaceList& faces, const EdgeTable& edges);
/// Joins vertices at equal positions and examines the triangles.
[[nodiscard]] ClosedSurface closed_surface(const TriangleMesh& mesh);

/// Returns the mesh with each corner renamed to the first vertex at its position. Vertices and triangles keep their
/// indices. Replaced vertices remain in the list, unused.
[[nodiscard]] TriangleMesh joined_by_position(const TriangleMesh& mesh);

/// Returns the boundary of the mesh's volume: the result of joined_by_position() without the triangles that
/// closed_surface() leaves out.
[[nodiscard]] TriangleMesh counted_surface(const TriangleMesh& mesh);

}  // namespace ricochet
