/// \file
/// Reads the frames of a run, whole ones and those in pieces.
#pragma once

#include <filesystem>

#include "ricochet/io/vtk.h"

namespace ricochet {

/// The particles of a frame (FrameFile::path) in the order of their ids: of a .vtp file, or of all pieces that a .pvtp
/// file lists, as one process would have written them. Throws InputError like read_vtp(), also where pieces do not fit
/// together.
[[nodiscard]] VtkPolyData read_frame(const std::filesystem::path& path);

}  // namespace ricochet
