/// \file
/// Reader of vector fields from VTK images (.vti).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "ricochet/dynamics/flows.h"

namespace ricochet {

/// Size limit of a .vti file, in bytes.
inline constexpr std::uint64_t kLargestGridFile = std::uint64_t{8} << 30;

/// Reads one array of the point data of an image: the array with the given name, or the first array with three
/// components.
/// - Accepts XML files with one piece, in little endian, uncompressed, and with axes that are not rotated.
/// - Accepts arrays of Float32 or Float64 as text, inline base64, appended raw data or appended base64. Allocations
///   never exceed the file's size by more than a constant factor. Throws InputError with the name of the file, the line
///   or byte of the fault, and the expected content. Source of the format: VTK File Formats, "XML File Formats",
///   Kitware.
[[nodiscard]] VectorGrid read_vti(const std::filesystem::path& path, std::string_view array = {});

}  // namespace ricochet
