// Draws sprites with an image as squares that face the camera, from far to near. A pixel of a sprite is visible if no
// solid object is nearer.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "ricochet/core/parallel.h"
#include "view/render/sprites.h"

namespace ricochet {
namespace {

constexpr std::size_t kRows = 16;        // rows per unit of parallel work
constexpr double kSmallestRadius = 0.8;  // least radius on the screen, in pixels
constexpr int kProbes = 4;               // number of rays per pixel that find solid objects in front of the sprites

// Square on the screen. Lengths except `depth` are in pixels.
struct Square {
    double x = 0.0;
    double y = 0.0;
    double radius = 0.0;  // half the longer edge
    double reach = 0.0;   // half the diagonal of the image
    double cosine = 1.0;
    double sine = 0.0;
    double depth = 0.0;  // distance along the direction of view, in m
    double strength = 0.0;
    Vec3 color;
};

class Screen {
public:
    Screen(const Camera& camera, int width, int height)
        : camera_(camera),
          frame_(camera_frame(camera)),
          width_(width),
          height_(height),
          scale_(0.5 * height / half_height(camera)) {}

    // Projects a sprite to the screen. Its strength is zero if it is invisible.
    [[nodiscard]] Square square(const Sprites& sprites, std::size_t i) const {
        Square out;
        const Vec3 away = sprites.centers[i] - camera_.position;
        out.depth = dot(away, frame_.forward);
        if (!is_finite(away) || !(out.depth > 0.0) || !(sprites.radii[i] > 0.0)) return out;
        out.x = 0.5 * width_ + scale_ * dot(away, frame_.right) / out.depth;
        out.y = 0.5 * height_ - scale_ * dot(away, frame_.up) / out.depth;
        const double radius = scale_ * sprites.radii[i] / out.depth;
        out.radius = std::max(radius, kSmallestRadius);
        out.reach = out.radius * std::hypot(sprites.image->half_width(), sprites.image->half_height());
        if (out.x + out.reach < 0.0 || out.x - out.reach > width_) return out;
        if (out.y + out.reach < 0.0 || out.y - out.reach > height_) return out;
        if (!sprites.angles.empty()) {
            out.cosine = std::cos(sprites.angles[i]);
            out.sine = std::sin(sprites.angles[i]);
        }
        const double part = radius / out.radius;
        out.strength = std::clamp(sprites.opacities[i], 0.0, 1.0) * part * part;
        out.color = kSpriteDaylight * sprites.colors[i];
        return out;
    }

    // Returns the depth of the first solid object at a point of the screen, in m.
    [[nodiscard]] double solid_depth(const Preview& preview, double x, double y) const {
        const Vec3 ahead =
            frame_.forward + (x - 0.5 * width_) / scale_ * frame_.right + (0.5 * height_ - y) / scale_ * frame_.up;
        const auto hit = preview.trace({camera_.position, normalized(ahead), 1.0});
        return hit ? hit->distance / length(ahead) : std::numeric_limits<double>::infinity();
    }

private:
    const Camera& camera_;
    CameraFrame frame_;
    double width_, height_, scale_;
};

// Depths of solid objects in some rows of the picture. The rays of a pixel are traced on the first request.
class SolidDepths {
public:
    SolidDepths(const Preview& preview, const Screen& screen, std::size_t first_row, std::size_t rows, int width)
        : preview_(preview),
          screen_(screen),
          first_row_(first_row),
          width_(static_cast<std::size_t>(width)),
          depths_(rows * width_),
          known_(rows * width_, 0) {}

    // Returns the share of a pixel in which no solid object is nearer than `depth`.
    [[nodiscard]] double open_part(std::size_t x, std::size_t y, double depth) {
        const std::size_t at = (y - first_row_) * width_ + x;
        std::array<double, kProbes>& here = depths_[at];
        if (known_[at] == 0) {
            known_[at] = 1;
            for (int k = 0; k < kProbes; ++k) {
                here[static_cast<std::size_t>(k)] =
                    screen_.solid_depth(preview_, static_cast<double>(x) + 0.25 + 0.5 * (k % 2),
                                        static_cast<double>(y) + 0.25 + 0.5 * (k / 2));
            }
        }
        return static_cast<double>(std::count_if(here.begin(), here.end(), [&](double d) { return d > depth; })) /
               kProbes;
    }

private:
    const Preview& preview_;
    const Screen& screen_;
    std::size_t first_row_;
    std::size_t width_;
    std::vector<std::array<double, kProbes>> depths_;
    std::vector<char> known_;
};

struct Rows {
    std::size_t first = 0;
    std::size_t last = 0;
    int width = 0;
};

void lay_over(const Square& square, const Sprites& sprites, const Rows& rows, SolidDepths& depths, SpriteLayer& layer) {
    const SpriteImage& image = *sprites.image;
    const double half_width = square.radius * image.half_width();
    const double half_height = square.radius * image.half_height();
    const double texels = std::max(image.width(), image.height()) / (2.0 * square.radius);
    const double top = std::max(std::floor(square.y - square.reach), static_cast<double>(rows.first));
    const double bottom = std::min(std::ceil(square.y + square.reach), static_cast<double>(rows.last));
    const double left = std::max(std::floor(square.x - square.reach), 0.0);
    const double right = std::min(std::ceil(square.x + square.reach), static_cast<double>(rows.width));
    for (double y = top; y < bottom; y += 1.0) {
        for (double x = left; x < right; x += 1.0) {
            const double dx = x + 0.5 - square.x;
            const double dy = square.y - y - 0.5;
            const double along = 0.5 + 0.5 * (square.cosine * dx + square.sine * dy) / half_width;
            const double down = 0.5 - 0.5 * (square.cosine * dy - square.sine * dx) / half_height;
            const SpriteTexel texel = image.at(along, down, texels);
            if (!(texel.cover > 0.0)) continue;
            const auto column = static_cast<std::size_t>(x);
            const auto row = static_cast<std::size_t>(y);
            const double strength = square.strength * depths.open_part(column, row, square.depth);
            if (!(strength > 0.0)) continue;
            const Vec3& color = square.color;
            const Vec3 light =
                strength * Vec3{color.x * texel.light.x, color.y * texel.light.y, color.z * texel.light.z};
            const std::size_t pixel = row * static_cast<std::size_t>(rows.width) + column;
            const double open = 1.0 - strength * texel.cover;
            layer.light[pixel] = open * layer.light[pixel] + light;
            layer.transmittance[pixel] *= open;
        }
    }
}

}  // namespace

SpriteLayer draw_images(const Sprites& sprites, const Preview& preview, const Camera& camera, int width, int height) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    SpriteLayer layer{std::vector<Vec3>(pixels), std::vector<double>(pixels, 1.0)};
    const Screen screen(camera, width, height);
    std::vector<Square> squares;
    for (std::size_t i = 0; i < sprites.centers.size(); ++i) {
        const Square square = screen.square(sprites, i);
        if (square.strength > 0.0) squares.push_back(square);
    }
    std::stable_sort(squares.begin(), squares.end(),
                     [](const Square& a, const Square& b) { return a.depth > b.depth; });
    parallel_for_blocks(static_cast<std::size_t>(height), kRows, [&](std::size_t, std::size_t begin, std::size_t end) {
        SolidDepths depths(preview, screen, begin, end - begin, width);
        for (const Square& square : squares) {
            if (square.y + square.reach < static_cast<double>(begin)) continue;
            if (square.y - square.reach > static_cast<double>(end)) continue;
            lay_over(square, sprites, {begin, end, width}, depths, layer);
        }
    });
    return layer;
}

}  // namespace ricochet
