/// \file
/// Renders a picture of colliders and particles: sun with soft shadows, sky light, one bounce of light between
/// surfaces. The same scene and options give the same bytes for any thread count.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "ricochet/core/vec3.h"
#include "view/render/camera.h"
#include "view/render/image.h"
#include "view/render/light.h"
#include "view/render/preview.h"
#include "view/render/sprites.h"

namespace ricochet {

/// Options of a rendered picture.
struct PictureOptions {
    int width = 1280;  ///< pixels, 1..16384
    int height = 720;  ///< pixels, 1..16384
    int samples = 16;  ///< rays per pixel, 1..4096
    /// Renders a draft: one ray through the middle of each pixel, hard shadows, sky light by the surface's slope
    /// alone. A draft has no light between surfaces and no blur. It ignores `samples` and `filter`.
    bool quick = false;
    double exposure = 1.0;
    Lighting lighting = Lighting::day;
    std::optional<Vec3> background;  ///< linear light of the background, instead of the lighting's own
    bool transparent = false;        ///< no background: the picture has an alpha channel
    bool filter = true;              ///< remove the noise, see filter_noise()
    /// Called repeatedly, from any thread, with the finished share, 0..1. Can be empty.
    std::function<void(double)> progress;
};

/// Renders the picture. Sprites are composited over everything else and tone-mapped separately, each layer over the
/// previous layers. The first glowing layer lights its surroundings, as glowing lines of the preview do.
[[nodiscard]] Image render_picture(const Preview& preview, const Camera& camera, const PictureOptions& options,
                                   std::span<const Sprites> layers);
[[nodiscard]] inline Image render_picture(const Preview& preview, const Camera& camera, const PictureOptions& options,
                                          const Sprites& sprites = {}) {
    return render_picture(preview, camera, options, std::span(&sprites, 1));
}

/// Returns the peak memory of render_picture() and PNG packing together, in bytes, without the scene.
[[nodiscard]] double picture_bytes(int width, int height, bool has_sprites);

}  // namespace ricochet
