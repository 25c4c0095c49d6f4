#include "view/render/image.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <fmt/format.h>
#include <stb/stb_image.h>

#include <algorithm>
#include <memory>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/core/printable.h"
#include "run/regular_file.h"

namespace ricochet {

std::array<int, 3> Image::pixel(int x, int y) const {
    const std::size_t at =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[at], rgb[at + 1], rgb[at + 2]};
}

namespace {

std::vector<std::uint8_t> with_alpha(const Image& image) {
    std::vector<std::uint8_t> rgba(4 * image.alpha.size());
    for (std::size_t i = 0; i < image.alpha.size(); ++i) {
        std::copy_n(image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                    rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
        rgba[4 * i + 3] = image.alpha[i];
    }
    return rgba;
}

}  // namespace

std::string png_bytes(const Image& image) {
    std::string bytes;
    const auto append = [](void* target, void* data, int size) {
        static_cast<std::string*>(target)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    const std::vector<std::uint8_t> rgba = with_alpha(image);
    const int channels = rgba.empty() ? 3 : 4;
    const std::uint8_t* data = rgba.empty() ? image.rgb.data() : rgba.data();
    if (stbi_write_png_to_func(append, &bytes, image.width, image.height, channels, data, channels * image.width) ==
        0) {
        throw RunError("the picture cannot be packed as PNG: memory is short");
    }
    return bytes;
}

namespace {

/// Returns the reason of the decoder's last failure as printable text, because the reason can quote bytes of the file.
/// Returns a default reason if the decoder gives none.
std::string failure_reason() {
    const char* const reason = stbi_failure_reason();
    return reason == nullptr ? "a chunk does not fit in the file" : printable(reason, 60);
}

}  // namespace

Image read_png(const std::filesystem::path& path) {
    constexpr std::uint64_t kMostBytes = 0x7fffffff;  // limit of the decoder's byte counter
    const std::string bytes = read_regular_file(path, kMostBytes, "a PNG file");
    const auto refuse = [&](const std::string& what) { throw InputError(fmt::format("{}: {}", path.string(), what)); };
    if (bytes.empty()) refuse("is empty, expected a PNG file");
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    Image image;
    int channels = 0;
    if (stbi_info_from_memory(data, size, &image.width, &image.height, &channels) == 0) {
        refuse(fmt::format("is not a PNG file that can be read ({}), expected one", failure_reason()));
    }
    const double pixels = static_cast<double>(image.width) * static_cast<double>(image.height);
    if (pixels > kMostPixelsRead) {
        refuse(fmt::format("has {} x {} pixels, expected at most {:.0f}", image.width, image.height, kMostPixelsRead));
    }
    require_memory(12.0 * pixels, path.string());
    const std::unique_ptr<stbi_uc, void (*)(void*)> decoded(
        stbi_load_from_memory(data, size, &image.width, &image.height, &channels, 4), &stbi_image_free);
    if (!decoded) refuse(fmt::format("is damaged ({}), expected a PNG file", failure_reason()));
    const bool has_alpha = channels == 2 || channels == 4;
    for (std::size_t i = 0; i < static_cast<std::size_t>(pixels); ++i) {
        image.rgb.insert(image.rgb.end(), decoded.get() + 4 * i, decoded.get() + 4 * i + 3);
        if (has_alpha) image.alpha.push_back(decoded.get()[4 * i + 3]);
    }
    return image;
}

void write_png(const std::filesystem::path& path, const Image& image) { write_file(path, png_bytes(image)); }

}  // namespace ricochet
