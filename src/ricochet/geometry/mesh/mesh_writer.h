/// \file
/// Mesh files written from triangle meshes. Every file is written under a temporary name and renamed when complete.
#pragma once

#include <filesystem>

#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"

namespace ricochet {

/// Writes the mesh in the format of the name's extension (.obj, .ply, .stl, .off in any case): OBJ and OFF as text with
/// as many digits as bring back the same double (17 at most), PLY as binary little endian with double coordinates, STL
/// as binary. STL stores single precision and no shared vertices: coordinates are rounded to the nearest float.
/// Throws InputError for another extension and for an STL coordinate beyond single precision, RunError when the disk
/// refuses.
void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& path);

/// The same in a given format, whatever the name.
void write_mesh(const TriangleMesh& mesh, const std::filesystem::path& path, MeshFormat format);

}  // namespace ricochet
