/// \file
/// The one meaning of "closed": which surfaces separate an inside from an outside.
///
/// A mesh is closed if every edge belongs to an even number of faces. Vertices at equal positions (0 and -0 too) are
/// one vertex, because programs duplicate vertices along seams of textures and normals. A face that repeats an earlier
/// one, in any winding, counts once. The winding has no influence: TopologyReport::inconsistent_edges counts where it
/// changes.
///
/// One exception keeps a sheet of which both sides are listed closed, as a body without an inside: in a shell that is
/// closed only if its repeated faces count, they count.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/geometry/mesh/mesh_topology.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// The faces that count where an inside is told from an outside.
struct ClosedSurface {
    bool closed = false;
    bool oriented = false;  ///< closed, and at each edge as many of the faces that count run along it as against it
    std::vector<std::uint32_t> left_out;  ///< repeated faces that do not count, in increasing order
};

/// Examines faces whose equal positions are joined. Time and memory are close to linear in the number of corners.
[[nodiscard]] ClosedSurface closed_surface(const FaceList& faces, const EdgeTable& edges);
/// Examines triangles, joined by position first.
[[nodiscard]] ClosedSurface closed_surface(const TriangleMesh& mesh);

/// Returns the mesh with each corner renamed to the first vertex at its position. Vertices and triangles keep their
/// numbers; the replaced vertices stay, unused.
[[nodiscard]] TriangleMesh joined_by_position(const TriangleMesh& mesh);

/// Returns the joined mesh without the triangles that closed_surface() leaves out: the boundary of its volume.
[[nodiscard]] TriangleMesh counted_surface(const TriangleMesh& mesh);

}  // namespace ricochet
