/// \file
/// Private to the library: reader of a frame's moving colliders.
#pragma once

#include <cstdint>
#include <map>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "run/run_folder.h"

namespace ricochet {

/// Returns the meshes of the file FrameFile::moving, by collider index. Throws InputError if the file is not valid.
[[nodiscard]] std::map<std::uint32_t, TriangleMesh> read_moving_meshes(const FrameFile& file);

}  // namespace ricochet
