/// \file
/// Makes a picture of colliders and particles: sun with soft shadows, sky light, one bounce of light between surfaces.
/// The same scene and options give the same bytes for any thread count.
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

/// How a picture is made.
struct PictureOptions {
    int width = 1280;  ///< pixels, 1..16384
    int height = 720;  ///< pixels, 1..16384
    int samples = 16;  ///< rays a pixel, 1..4096
    /// A draft: one ray through the middle of each pixel, hard shadows, the sky's light by the surface's slope alone,
    /// no light from surface to surface, no blur. samples and filter have no part in it.
    bool quick = false;
    double exposure = 1.0;
    Lighting lighting = Lighting::day;
    std::optional<Vec3> background;  ///< linear light behind everything, instead of the light's own
    bool transparent = false;        ///< nothing behind everything: the picture has an alpha channel
    bool filter = true;              ///< take the noise out, see filter_noise()
    /// Called now and then, from any thread, with the part that is done, 0..1. May be empty.
    std::function<void(double)> progress;
};

/// sprites: laid over the picture of everything else, brought to the display's range by themselves; each layer over
/// those before it. The first of those that glow lights what is around, as lines of the preview that shine do.
[[nodiscard]] Image render_picture(const Preview& preview, const Camera& camera, const PictureOptions& options,
                                   std::span<const Sprites> layers);
[[nodiscard]] inline Image render_picture(const Preview& preview, const Camera& camera, const PictureOptions& options,
                                          const Sprites& sprites = {}) {
    return render_picture(preview, camera, options, std::span(&sprites, 1));
}

/// Memory that render_picture() and packing as PNG need together at their peak, bytes, without what they show.
[[nodiscard]] double picture_bytes(int width, int height, bool has_sprites);

}  // namespace ricochet
