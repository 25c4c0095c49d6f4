/// \file
/// Private to mesh_reader: PLY, ASCII and both binary byte orders.
#pragma once

#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {

/// Reads the elements vertex (x, y, z of any type), face (list vertex_indices or vertex_index) and tristrips
/// (list vertex_indices, -1 starts a new strip); everything else is skipped. In an ASCII file every element stands on a
/// line of its own. Triangles of a strip that repeat a vertex only turn the strip; they are not faces.
[[nodiscard]] ParsedMesh read_ply(const MeshSource& source);

}  // namespace ricochet
