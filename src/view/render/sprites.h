/// \file
/// Particles as soft discs that face the camera. They add light (sparks) or cover the background (spray, smoke). The
/// bytes are the same for any thread count: discs are composited from far to near, and ties keep the given order.
/// Method: W. T. Reeves, "Particle Systems", ACM TOG 2(2), 1983, section 2.5 (particles as points of light that add
/// up); T. Porter, T. Duff, "Compositing Digital Images", SIGGRAPH 1984 (the operator "over").
#pragma once

#include <memory>
#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/camera.h"
#include "view/render/preview.h"
#include "view/render/sprite_image.h"

namespace ricochet {

/// Light on sprites that do not glow.
inline constexpr double kSpriteDaylight = 1.8;

/// Soft discs, or copies of an image. The first four vectors have the same length.
struct Sprites {
    std::vector<Vec3> centers;
    std::vector<double> radii;                   ///< in m; discs smaller than a pixel are widened and dimmed
                                                 ///< accordingly
    std::vector<Vec3> colors;                    ///< linear light
    std::vector<double> opacities;               ///< 0..1, at the disc's middle
    bool glow = false;                           ///< for discs: additive light instead of compositing from far to near
    std::shared_ptr<const SpriteImage> image{};  ///< used instead of discs; its colours are multiplied by `colors`
    std::vector<double> angles{};                ///< rotation of images, counterclockwise, in radians; empty: upright

    [[nodiscard]] bool empty() const { return centers.empty(); }
};

/// Contribution of sprites to each pixel. Rows start at the top.
struct SpriteLayer {
    std::vector<Vec3> light;            ///< linear light added
    std::vector<double> transmittance;  ///< visible share of the background, 0..1
};

/// Draws sprites for a picture of the given size. A disc is left out if its middle is behind a solid mesh, plane or
/// sphere. An image is hidden part by part.
[[nodiscard]] SpriteLayer draw_sprites(const Sprites& sprites, const Preview& preview, const Camera& camera, int width,
                                       int height);

/// Draws sprites that have an image.
[[nodiscard]] SpriteLayer draw_images(const Sprites& sprites, const Preview& preview, const Camera& camera, int width,
                                      int height);

}  // namespace ricochet
