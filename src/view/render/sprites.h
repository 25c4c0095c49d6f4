/// \file
/// Particles as soft discs that face the camera: light that adds up (sparks), or a haze that covers what is behind
/// (spray, smoke). The same bytes for any thread count: discs are laid over each other from far to near, ties in the
/// order given.
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

/// Soft discs, or pictures where there is an image; the four vectors have the same length.
struct Sprites {
    std::vector<Vec3> centers;
    std::vector<double> radii;                   ///< m; discs smaller than a pixel are widened and dimmed alike
    std::vector<Vec3> colors;                    ///< linear light
    std::vector<double> opacities;               ///< 0..1, at the disc's middle
    bool glow = false;                           ///< of discs: light that adds up, instead of cover from far to near
    std::shared_ptr<const SpriteImage> image{};  ///< instead of discs, in its own colours times those above
    std::vector<double> angles{};                ///< of images, radians against the clock; empty: upright

    [[nodiscard]] bool empty() const { return centers.empty(); }
};

/// What sprites do to each pixel, rows from the top.
struct SpriteLayer {
    std::vector<Vec3> light;            ///< linear light added
    std::vector<double> transmittance;  ///< part of what is behind that is still seen, 0..1
};

/// Sprites in front of a picture of the given size. A disc whose middle is behind a solid mesh, plane or sphere is left
/// out; of images every part that is behind one.
[[nodiscard]] SpriteLayer draw_sprites(const Sprites& sprites, const Preview& preview, const Camera& camera, int width,
                                       int height);

/// The same for sprites that have an image.
[[nodiscard]] SpriteLayer draw_images(const Sprites& sprites, const Preview& preview, const Camera& camera, int width,
                                      int height);

}  // namespace ricochet
