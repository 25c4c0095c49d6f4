/// \file
/// Reader of a run's frames. A frame is one file, or an index file with several pieces.
#pragma once

#include <filesystem>

#include "ricochet/io/vtk.h"

namespace ricochet {

/// Returns the particles of a frame (FrameFile::path) in the order of their ids. A .vtp file contains all particles; a
/// .pvtp file lists the pieces that are merged. The result equals the frame of a run with one process. Throws
/// InputError like read_vtp(), and also if the pieces do not match each other.
[[nodiscard]] VtkPolyData read_frame(const std::filesystem::path& path);

}  // namespace ricochet
