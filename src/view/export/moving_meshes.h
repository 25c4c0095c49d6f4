/// \file
/// Private to the library: the colliders that move, as a run's files hold them.
#pragma once

#include <cstdint>
#include <map>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/io/run_folder.h"

namespace ricochet {

/// The meshes of FrameFile::moving, by the number of their colliders. Throws InputError where it is no such file.
[[nodiscard]] std::map<std::uint32_t, TriangleMesh> read_moving_meshes(const FrameFile& file);

}  // namespace ricochet
