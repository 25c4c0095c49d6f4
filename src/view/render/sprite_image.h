/// \file
/// Image of sprites, which can be sampled at any size.
/// Method: mipmaps, L. Williams, "Pyramidal Parametrics", SIGGRAPH 1983.
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/image.h"

namespace ricochet {

/// Light and coverage of a point of an image.
struct SpriteTexel {
    Vec3 light;          ///< linear light, premultiplied by cover
    double cover = 0.0;  ///< 0..1
};

/// Image with mipmap levels. It is transparent outside its bounds.
class SpriteImage {
public:
    /// `image` must have at least one pixel.
    explicit SpriteImage(const Image& image);

    /// Returns half the width, in a unit in which half the longer edge is 1. half_height() uses the same unit.
    [[nodiscard]] double half_width() const { return half_width_; }
    [[nodiscard]] double half_height() const { return half_height_; }
    [[nodiscard]] int width() const { return levels_[0].width; }
    [[nodiscard]] int height() const { return levels_[0].height; }
    /// Samples the image. (x, y) is (0, 0) at the upper left corner and (1, 1) at the lower right corner. `texels` is
    /// the number of texels per pixel of the picture, along an edge.
    [[nodiscard]] SpriteTexel at(double x, double y, double texels) const;
    /// Returns the memory of an image with the given number of pixels, in bytes.
    [[nodiscard]] static double bytes(double pixels);

private:
    struct Texel {
        float red = 0.0F, green = 0.0F, blue = 0.0F, cover = 0.0F;
    };
    struct Level {
        int width = 0;
        int height = 0;
        std::vector<Texel> texels;
    };

    [[nodiscard]] static Level half_of(const Level& level);
    [[nodiscard]] static SpriteTexel at_level(const Level& level, double x, double y);

    std::vector<Level> levels_;
    double half_width_, half_height_;
};

}  // namespace ricochet
