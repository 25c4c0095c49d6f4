#include "view/render/sprite_image.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "view/render/color_map.h"

namespace ricochet {

SpriteImage::SpriteImage(const Image& image)
    : half_width_(static_cast<double>(image.width) / std::max(image.width, image.height)),
      half_height_(static_cast<double>(image.height) / std::max(image.width, image.height)) {
    const auto linear = [](std::uint8_t byte) { return static_cast<float>(linear_from_srgb(byte / 255.0)); };
    Level level{image.width, image.height, {}};
    const std::size_t count = image.rgb.size() / 3;
    level.texels.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
        const float cover = image.alpha.empty() ? 1.0F : static_cast<float>(image.alpha[i]) / 255.0F;
        level.texels.push_back({cover * linear(image.rgb[3 * i]), cover * linear(image.rgb[3 * i + 1]),
                                cover * linear(image.rgb[3 * i + 2]), cover});
    }
    levels_.push_back(std::move(level));
    while (levels_.back().width > 1 || levels_.back().height > 1) levels_.push_back(half_of(levels_.back()));
}

// Returns the next coarser level. Each texel is the mean of the area that it covers in the finer level. The mean of the
// image is therefore preserved for odd sizes too.
SpriteImage::Level SpriteImage::half_of(const Level& level) {
    struct Part {
        std::size_t from = 0;
        float weight = 0.0F;
    };
    const auto parts = [](int size, int half, int k) {
        std::vector<Part> list;
        const double wide = static_cast<double>(size) / half;
        const double begin = k * wide;
        for (int i = static_cast<int>(begin); i < size && i < begin + wide; ++i) {
            const double covered = std::min(begin + wide, i + 1.0) - std::max(begin, static_cast<double>(i));
            if (covered > 0.0) list.push_back({static_cast<std::size_t>(i), static_cast<float>(covered / wide)});
        }
        return list;
    };
    Level out{std::max(1, level.width / 2), std::max(1, level.height / 2), {}};
    for (int y = 0; y < out.height; ++y) {
        const std::vector<Part> rows = parts(level.height, out.height, y);
        for (int x = 0; x < out.width; ++x) {
            Texel sum;
            for (const Part& column : parts(level.width, out.width, x)) {
                for (const Part& row : rows) {
                    const Texel& t = level.texels[row.from * static_cast<std::size_t>(level.width) + column.from];
                    const float weight = row.weight * column.weight;
                    sum.red += weight * t.red;
                    sum.green += weight * t.green;
                    sum.blue += weight * t.blue;
                    sum.cover += weight * t.cover;
                }
            }
            out.texels.push_back(sum);
        }
    }
    return out;
}

// Interpolates linearly between the four nearest texels.
SpriteTexel SpriteImage::at_level(const Level& level, double x, double y) {
    const double across = x * level.width - 0.5;
    const double down = y * level.height - 0.5;
    const double left = std::floor(across);
    const double top = std::floor(down);
    SpriteTexel out;
    for (int dy = 0; dy < 2; ++dy) {
        for (int dx = 0; dx < 2; ++dx) {
            const double column = left + dx;
            const double row = top + dy;
            const double weight = (1.0 - std::fabs(across - column)) * (1.0 - std::fabs(down - row));
            if (column < 0.0 || row < 0.0 || column >= level.width || row >= level.height) continue;
            const Texel& t = level.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(level.width) +
                                          static_cast<std::size_t>(column)];
            out.light += weight * Vec3{t.red, t.green, t.blue};
            out.cover += weight * t.cover;
        }
    }
    return out;
}

SpriteTexel SpriteImage::at(double x, double y, double texels) const {
    const auto last = static_cast<double>(levels_.size() - 1);
    const double level = std::clamp(std::log2(std::max(texels, 1.0)), 0.0, last);
    const auto finer = static_cast<std::size_t>(level);
    const double part = level - std::floor(level);
    const SpriteTexel fine = at_level(levels_[finer], x, y);
    if (!(part > 0.0)) return fine;
    const SpriteTexel coarse = at_level(levels_[finer + 1], x, y);
    return {(1.0 - part) * fine.light + part * coarse.light, (1.0 - part) * fine.cover + part * coarse.cover};
}

// The coarser levels together take a third of the finest level. The source image takes 4 bytes per pixel.
double SpriteImage::bytes(double pixels) { return pixels * (4.0 / 3.0 * sizeof(Texel) + 4.0); }

}  // namespace ricochet
