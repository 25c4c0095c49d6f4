/// \file
/// Reads VTK files: the .vtp files that vtk.h writes, and vector fields from images (.vti).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "ricochet/dynamics/flows.h"
#include "ricochet/io/vtk.h"

namespace ricochet {

/// Reads a .vtp file as write_vtp() lays it out; other dialects of the format are refused. Nothing is allocated that
/// the file's size does not justify. Throws InputError with the file's name, the byte and what was expected.
[[nodiscard]] VtkPolyData read_vtp(const std::filesystem::path& path);

/// Largest .vti file that is read, bytes.
inline constexpr std::uint64_t kLargestGridFile = std::uint64_t{8} << 30;

/// Reads one array of the point data of an image: the one of that name, or the first with three components. XML files
/// of one piece, little endian, not compressed, axes not turned; arrays in Float32 or Float64 as text, inline base64,
/// or appended raw or in base64. Nothing is allocated that the file's size does not justify. Throws InputError with the
/// file's name, the line or byte, and what was expected.
/// Source of the format: VTK File Formats, "XML File Formats", Kitware.
[[nodiscard]] VectorGrid read_vti(const std::filesystem::path& path, std::string_view array = {});

}  // namespace ricochet
