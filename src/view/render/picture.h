/// \file
/// Rendering of a picture of colliders and particles, with soft shadows of the sun, sky light, and one bounce of light
/// between surfaces. The same scene and options give the same bytes for any thread count.
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
    /// Renders a draft with one ray through the middle of each pixel and hard shadows. The sky's light depends only on
    /// the direction of the surface normal. A draft has no light between surfaces and no motion or focus blur. It
    /// ignores `samples` and `filter`.
    bool quick = false;
    double exposure = 1.0;
    Lighting lighting = Lighting::day;
    std::optional<Vec3> background;  ///< background colour in linear light, instead of the background of the lighting
    bool transparent = false;        ///< the picture has an alpha channel instead of a background
    bool filter = true;              ///< noise is removed, see filter_noise()
    /// Callback that receives the finished share, 0..1, repeatedly and from any thread. Can be empty.
    std::function<void(double)> progress;
};

/// Renders the picture. The layers of sprites are composited in order over everything else, and tone-mapped separately.
/// The first glowing layer lights its surroundings, like the glowing lines of the preview.
[[nodiscard]] Image render_picture(const Preview& preview, const Camera& camera, const PictureOptions& options,
                                   std::span<const Sprites> layers);
[[nodiscard]] inline Image render_picture(const Preview& preview, const Camera& camera, const PictureOptions& options,
                                          const Sprites& sprites = {}) {
    return render_picture(preview, camera, options, std::span(&sprites, 1));
}

/// Returns the peak memory of rendering and packing as PNG, in bytes. The memory of the scene is not included.
[[nodiscard]] double picture_bytes(int width, int height, bool has_sprites);

}  // namespace ricochet
