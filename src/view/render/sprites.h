/// \file
/// Particles as soft discs that face the camera. Discs add light (sparks) or cover the background (spray, smoke). Discs
/// are composited from far to near, and discs at equal depth in the given order. The picture is therefore the same for
/// any thread count.
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

/// Factor of the colours of sprites that do not glow.
inline constexpr double kSpriteDaylight = 1.8;

/// Soft discs, or copies of an image. The first four vectors have the same length, and `angles` too if it is not empty.
struct Sprites {
    std::vector<Vec3> centers;
    /// In m; discs smaller than a pixel are enlarged and dimmed accordingly.
    std::vector<double> radii;
    std::vector<Vec3> colors;       ///< linear light
    std::vector<double> opacities;  ///< 0..1, at the disc's middle
    bool glow = false;              ///< only for discs: adds light instead of covering the background
    /// Image that replaces the discs; `colors` multiplies its colours; null: discs.
    std::shared_ptr<const SpriteImage> image{};
    /// Counterclockwise rotation of each image, in radians; empty: all images are upright.
    std::vector<double> angles{};

    [[nodiscard]] bool empty() const { return centers.empty(); }
};

/// Contribution of sprites to each pixel. The first row is at the top.
struct SpriteLayer {
    std::vector<Vec3> light;            ///< added linear light
    std::vector<double> transmittance;  ///< visible share of the background, 0..1
};

/// Draws sprites for a picture of the given size. A disc is left out if a solid object hides its middle. For images,
/// visibility is tested in each pixel.
[[nodiscard]] SpriteLayer draw_sprites(const Sprites& sprites, const Preview& preview, const Camera& camera, int width,
                                       int height);

/// Draws sprites that have an image.
[[nodiscard]] SpriteLayer draw_images(const Sprites& sprites, const Preview& preview, const Camera& camera, int width,
                                      int height);

}  // namespace ricochet
