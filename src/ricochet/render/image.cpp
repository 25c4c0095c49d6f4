#include "ricochet/render/image.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include <algorithm>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"

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

void write_png(const std::filesystem::path& path, const Image& image) { write_file(path, png_bytes(image)); }

}  // namespace ricochet
