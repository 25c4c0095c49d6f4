/// \file
/// Private to mesh_reader: STL, ASCII and binary.
#pragma once

#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {

/// True when the size is exactly what the triangle count at byte 80 asks for; the header's text does not matter.
[[nodiscard]] bool has_binary_stl_size(const MeshSource& source);

/// True when the text starts with the word "solid".
[[nodiscard]] bool starts_with_solid(const MeshSource& source);

/// Reads STL and joins corners of equal coordinates. The facets' normals are not used: the corners say it better.
[[nodiscard]] ParsedMesh read_stl(const MeshSource& source);

}  // namespace ricochet
