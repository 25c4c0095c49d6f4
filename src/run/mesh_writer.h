/// \file
/// Writes triangle meshes to files. Every file is written under a temporary name and renamed when it is complete.
#pragma once

#include <filesystem>

#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Writes the mesh in the format of the name's extension (.obj, .ply, .stl, .off in any case). OBJ and OFF are text
/// with enough digits to restore the same double (17 at most). PLY is binary little endian with double coordinates, and
/// STL is binary. STL stores single precision and no shared vertices, so coordinates are rounded to the nearest float.
/// Throws InputError for other extensions, and for STL coordinates beyond single precision. Throws RunError if the file
/// cannot be written.
void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& path);

}  // namespace ricochet
