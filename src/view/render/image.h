/// \file
/// Pictures in memory and as PNG files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ricochet {

/// RGB picture in sRGB, with 8 bits per channel and an optional alpha channel. The first row is at the top.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;      ///< 3 * width * height bytes
    std::vector<std::uint8_t> alpha{};  ///< width * height bytes, 255 for opaque; empty: the whole picture is opaque

    /// Returns red, green and blue of a pixel. x increases to the right, and y downward.
    [[nodiscard]] std::array<int, 3> pixel(int x, int y) const;
};

/// Largest number of pixels of a PNG file that read_png() accepts.
inline constexpr double kMostPixelsRead = 4096.0 * 4096.0;
/// Reads a PNG file. The image has an alpha channel if the file has one. Throws InputError if the file is not PNG, is
/// damaged, exceeds kMostPixelsRead or does not fit in memory.
[[nodiscard]] Image read_png(const std::filesystem::path& path);
/// Returns the picture as the bytes of a PNG file. Throws RunError if memory is short.
[[nodiscard]] std::string png_bytes(const Image& image);
/// Writes a PNG file. The file appears under its name only when it is complete. Throws the exceptions of AtomicFile.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace ricochet
