/// \file
/// Reads back the .vtp files that vtk.h writes.
#pragma once

#include <filesystem>

#include "ricochet/io/vtk.h"

namespace ricochet {

/// Reads a .vtp file as write_vtp() lays it out; other dialects of the format are refused. Nothing is allocated that
/// the file's size does not justify. Throws InputError with the file's name, the place and what was expected.
[[nodiscard]] VtkPolyData read_vtp(const std::filesystem::path& path);

}  // namespace ricochet
