/// \file
/// Private to mesh_reader: Wavefront OBJ.
#pragma once

#include "ricochet/geometry/mesh/mesh_source.h"

namespace ricochet {

/// Reads OBJ text. Faces are grouped by the name in force at the face: its material (usemtl) if there is one, else its
/// group (g), else its object (o), else the empty name.
[[nodiscard]] ParsedMesh read_obj(const MeshSource& source);

/// True when the text's first statement is one that OBJ has.
[[nodiscard]] bool looks_like_obj(const MeshSource& source);

}  // namespace ricochet
