/// \file
/// The image of sprites, looked up at any size.
/// Method: L. Williams, "Pyramidal Parametrics", SIGGRAPH 1983 (levels of halved size, mixed).
#pragma once

#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/image.h"

namespace ricochet {

/// Light and cover of an image's place.
struct SpriteTexel {
    Vec3 light;          ///< linear, times cover
    double cover = 0.0;  ///< 0..1
};

/// Nothing is around the image.
class SpriteImage {
public:
    /// image: at least a pixel.
    explicit SpriteImage(const Image& image);

    /// Half the width and half the height, the longer one 1.
    [[nodiscard]] double half_width() const { return half_width_; }
    [[nodiscard]] double half_height() const { return half_height_; }
    [[nodiscard]] int width() const { return levels_[0].width; }
    [[nodiscard]] int height() const { return levels_[0].height; }
    /// x, y: from the upper left corner, in 0..1. texels: of the image to a pixel of the picture.
    [[nodiscard]] SpriteTexel at(double x, double y, double texels) const;
    /// Bytes that an image of so many pixels takes.
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
