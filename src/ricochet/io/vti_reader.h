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

/// Reads one array of the point data of an image: the named one, or the first with three components.
/// - Accepts XML files of one piece, little endian, uncompressed, with axes that are not rotated.
/// - Accepts arrays in Float32 or Float64 as text, inline base64, appended raw data or appended base64.
/// Allocations never exceed the file's size by more than a constant factor. Throws InputError with the file's name,
/// the line or byte, and the expected content.
/// Source of the format: VTK File Formats, "XML File Formats", Kitware.
[[nodiscard]] VectorGrid read_vti(const std::filesystem::path& path, std::string_view array = {});

}  // namespace ricochet
