/// \file
/// The mesh file formats that are read and written.
#pragma once

#include <filesystem>
#include <optional>

namespace ricochet {

enum class MeshFormat { kObj, kPly, kStl, kOff };

/// "OBJ", "PLY", "STL" or "OFF".
[[nodiscard]] const char* mesh_format_name(MeshFormat format);

/// Format by the file name's extension (.obj, .ply, .stl, .off in any case); nothing when it is another one or none.
[[nodiscard]] std::optional<MeshFormat> mesh_format_of(const std::filesystem::path& path);

}  // namespace ricochet
