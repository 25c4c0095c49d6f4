/// \file
/// Reader of .vtp files that io/vtk.h writes.
#pragma once

#include <filesystem>

#include "ricochet/io/vtk.h"

namespace ricochet {

/// Reads a .vtp file in the layout of write_vtp(); other layouts of the format are refused. Allocated memory is at most
/// a constant multiple of the file's size. Throws InputError with the file's name, the byte and the expected content.
[[nodiscard]] VtkPolyData read_vtp(const std::filesystem::path& path);

}  // namespace ricochet
