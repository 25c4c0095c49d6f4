#include "ricochet/render/image.h"

#define STB_IMAGE_WRITE_IMPLEMENTATION
#define STB_IMAGE_WRITE_STATIC
#include <stb/stb_image_write.h>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"

namespace ricochet {

std::array<int, 3> Image::pixel(int x, int y) const {
    const std::size_t at =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[at], rgb[at + 1], rgb[at + 2]};
}

std::string png_bytes(const Image& image) {
    std::string bytes;
    const auto append = [](void* target, void* data, int size) {
        static_cast<std::string*>(target)->append(static_cast<const char*>(data), static_cast<std::size_t>(size));
    };
    if (stbi_write_png_to_func(append, &bytes, image.width, image.height, 3, image.rgb.data(), 3 * image.width) == 0) {
        throw RunError("the picture cannot be packed as PNG: memory is short");
    }
    return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) { write_file(path, png_bytes(image)); }

}  // namespace ricochet
