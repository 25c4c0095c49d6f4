/// \file
/// Pictures in memory and as PNG files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ricochet {

/// An RGB picture, 8 bits a channel, sRGB, rows from the top, with an alpha channel where it has one.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;      ///< 3 * width * height bytes
    std::vector<std::uint8_t> alpha{};  ///< width * height bytes, 255 for opaque; or empty: all of it is

    /// Red, green and blue of a pixel; x to the right, y down.
    [[nodiscard]] std::array<int, 3> pixel(int x, int y) const;
};

/// Most pixels of a PNG file that is read.
inline constexpr double kMostPixelsRead = 4096.0 * 4096.0;
/// Reads a PNG file; alpha where it has some. Throws InputError when it is none, damaged, or larger than
/// kMostPixelsRead or the memory.
[[nodiscard]] Image read_png(const std::filesystem::path& path);
/// The picture as the bytes of a PNG file. Throws RunError when memory is short.
[[nodiscard]] std::string png_bytes(const Image& image);
/// Writes a PNG file, which appears under its name only when it is complete. Throws like AtomicFile.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace ricochet
