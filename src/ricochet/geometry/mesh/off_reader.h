/// \file
/// Private to mesh_reader: OFF, the text format of Geomview.
#pragma once

#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {

/// Reads OFF text with any of the prefixes ST, C and N; every vertex and every face stands on a line of its own. Values
/// after the coordinates and after a face's indices (colours, normals, texture) must be numbers and are not used.
[[nodiscard]] ParsedMesh read_off(const MeshSource& source);

/// True when the text's first word is the keyword OFF with some of its prefixes.
[[nodiscard]] bool looks_like_off(const MeshSource& source);

}  // namespace ricochet
