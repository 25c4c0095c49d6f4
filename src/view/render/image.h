/// \file
/// Pictures in memory and as PNG files.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace ricochet {

/// An RGB picture with 8 bits per channel, in sRGB. Rows start at the top. It can have an alpha channel.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> rgb;      ///< 3 * width * height bytes
    std::vector<std::uint8_t> alpha{};  ///< width * height bytes, 255 for opaque; empty: the whole picture is opaque

    /// Returns red, green and blue of a pixel, with x to the right and y down.
    [[nodiscard]] std::array<int, 3> pixel(int x, int y) const;
};

/// Largest number of pixels of a PNG file that can be read.
inline constexpr double kMostPixelsRead = 4096.0 * 4096.0;
/// Reads a PNG file, with alpha if the file has it. Throws InputError if the file is not PNG, is damaged, exceeds
/// kMostPixelsRead or does not fit in memory.
[[nodiscard]] Image read_png(const std::filesystem::path& path);
/// Returns the picture as the bytes of a PNG file. Throws RunError if memory is short.
[[nodiscard]] std::string png_bytes(const Image& image);
/// Writes a PNG file. The file appears under its name only when it is complete. Throws the exceptions of AtomicFile.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace ricochet
