#include "view/render/sprites.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "ricochet/core/parallel.h"

namespace ricochet {

namespace {

constexpr std::size_t kRows = 16;        // rows per unit of parallel work
constexpr std::size_t kDiscs = 256;      // discs per unit of parallel work
constexpr double kSmallestRadius = 0.8;  // least radius on the screen, in pixels
constexpr double kGlowReach = 2.5;       // radius of a glowing disc, relative to the particle's radius

// Disc on the screen. Lengths except `depth` are in pixels.
struct Disc {
    double x = 0.0;
    double y = 0.0;
    double radius = 0.0;
    double depth = 0.0;
    double strength = 0.0;
    Vec3 color;
};

class Projector {
public:
    Projector(const Camera& camera, int width, int height)
        : camera_(camera),
          frame_(camera_frame(camera)),
          middle_x_(0.5 * width),
          middle_y_(0.5 * height),
          scale_(0.5 * height / half_height(camera)) {}

    // Projects a disc to the screen. Its strength is zero if it is invisible.
    [[nodiscard]] Disc project(const Sprites& sprites, std::size_t i, const Preview& preview) const {
        Disc disc;
        const Vec3 away = sprites.centers[i] - camera_.position;
        disc.depth = dot(away, frame_.forward);
        if (!is_finite(away) || !(disc.depth > 0.0) || !(sprites.radii[i] > 0.0)) return disc;
        disc.x = middle_x_ + scale_ * dot(away, frame_.right) / disc.depth;
        disc.y = middle_y_ - scale_ * dot(away, frame_.up) / disc.depth;
        const double radius = scale_ * sprites.radii[i] / disc.depth * (sprites.glow ? kGlowReach : 1.0);
        disc.radius = std::max(radius, kSmallestRadius);
        const double part = radius / disc.radius;
        if (disc.x + disc.radius < 0.0 || disc.x - disc.radius > 2.0 * middle_x_) return disc;
        if (disc.y + disc.radius < 0.0 || disc.y - disc.radius > 2.0 * middle_y_) return disc;
        const auto hit = preview.trace({camera_.position, normalized(away)});
        if (hit && hit->distance < length(away) - sprites.radii[i]) return disc;
        disc.strength = std::clamp(sprites.opacities[i], 0.0, 1.0) * part * part;
        disc.color = sprites.glow ? sprites.colors[i] : kSpriteDaylight * sprites.colors[i];
        return disc;
    }

private:
    const Camera& camera_;
    CameraFrame frame_;
    double middle_x_, middle_y_, scale_;
};

void lay_over(const Disc& disc, bool glow, std::size_t first_row, std::size_t last_row, int width, SpriteLayer& layer) {
    const double top = std::max(std::floor(disc.y - disc.radius), static_cast<double>(first_row));
    const double bottom = std::min(std::ceil(disc.y + disc.radius), static_cast<double>(last_row));
    const double left = std::max(std::floor(disc.x - disc.radius), 0.0);
    const double right = std::min(std::ceil(disc.x + disc.radius), static_cast<double>(width));
    for (double y = top; y < bottom; y += 1.0) {
        for (double x = left; x < right; x += 1.0) {
            const double dx = (x + 0.5 - disc.x) / disc.radius;
            const double dy = (y + 0.5 - disc.y) / disc.radius;
            const double rim = 1.0 - dx * dx - dy * dy;
            if (!(rim > 0.0)) continue;
            const double cover = disc.strength * rim * rim * (glow ? rim : 1.0);
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            if (glow) {
                layer.light[pixel] += cover * disc.color;
            } else {
                layer.light[pixel] = (1.0 - cover) * layer.light[pixel] + cover * disc.color;
                layer.transmittance[pixel] *= 1.0 - cover;
            }
        }
    }
}

}  // namespace

SpriteLayer draw_sprites(const Sprites& sprites, const Preview& preview, const Camera& camera, int width, int height) {
    if (sprites.image) return draw_images(sprites, preview, camera, width, height);
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    SpriteLayer layer{std::vector<Vec3>(pixels), std::vector<double>(pixels, 1.0)};
    std::vector<Disc> discs(sprites.centers.size());
    const Projector projector(camera, width, height);
    parallel_for_blocks(discs.size(), kDiscs, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) discs[i] = projector.project(sprites, i, preview);
    });
    std::erase_if(discs, [](const Disc& disc) { return !(disc.strength > 0.0); });
    std::stable_sort(discs.begin(), discs.end(), [](const Disc& a, const Disc& b) { return a.depth > b.depth; });
    parallel_for_blocks(static_cast<std::size_t>(height), kRows, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (const Disc& disc : discs) {
            if (disc.y + disc.radius < static_cast<double>(begin) || disc.y - disc.radius > static_cast<double>(end))
                continue;
            lay_over(disc, sprites.glow, begin, end, width, layer);
        }
    });
    return layer;
}

}  // namespace ricochet
