#include "view/render/picture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "ricochet/core/loop_stop.h"
#include "ricochet/core/parallel.h"
#include "view/render/filter.h"
#include "view/render/lamps.h"
#include "view/render/painter.h"
#include "view/render/sphere_view.h"
#include "view/render/sun_shadows.h"
#include "view/render/tone.h"

namespace ricochet {
namespace {

// Size of a tile of pixels that are processed together, in pixels.
constexpr int kTileWidth = 4;
constexpr int kTileHeight = 2;
static_assert(kTileWidth * kTileHeight == kPacketRays);

Float3 single(const Vec3& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

std::size_t pixel_count(const PictureOptions& options) {
    return static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
}

// Picture before filtering, and the alpha of its pixels if it has an alpha channel.
struct Sampled {
    NoisyPicture picture;
    std::vector<float> alpha;

    void store(const PixelPosition& pixel_position, const PixelLight& pixel) {
        const std::size_t index = static_cast<std::size_t>(pixel_position.y) * static_cast<std::size_t>(picture.width) +
                                  static_cast<std::size_t>(pixel_position.x);
        picture.light[index] = single(pixel.light);
        if (!alpha.empty()) alpha[index] = static_cast<float>(pixel.alpha);
        if (picture.features.empty()) return;
        picture.variance[index] = static_cast<float>(pixel.variance);
        picture.features[index] = {single(pixel.normal), single(pixel.albedo), static_cast<float>(pixel.distance),
                                   static_cast<float>(pixel.slope)};
    }
};

// Returns the lamps of glowing sprites and lines.
std::vector<Lamp> lamps_in(std::span<const Sprites> layers, const Preview& preview) {
    constexpr std::size_t kMostLamps = 48;
    const auto glowing = std::find_if(layers.begin(), layers.end(), [](const Sprites& layer) { return layer.glow; });
    return lamps_of(glowing == layers.end() ? Sprites{} : *glowing, preview.glowing_lines(), kMostLamps);
}

// All layers of sprites, merged. Covering layers and additive light are stored separately. The function lay_over()
// divides the light of covering layers by their coverage, but additive light has no coverage. Both are empty if there
// is nothing to draw.
struct LaidOver {
    SpriteLayer cover;
    std::vector<Vec3> glow;
};
LaidOver laid_over_each_other(std::span<const Sprites> layers, const Preview& preview, const Camera& camera,
                              const PictureOptions& options) {
    LaidOver all;
    for (const Sprites& sprites : layers) {
        if (sprites.empty()) continue;
        SpriteLayer next = draw_sprites(sprites, preview, camera, options.width, options.height);
        for (std::size_t i = 0; i < all.glow.size(); ++i) {
            all.glow[i] = next.transmittance[i] * all.glow[i] + (sprites.glow ? next.light[i] : Vec3{});
        }
        SpriteLayer& cover = all.cover;
        if (sprites.glow) {
            if (all.glow.empty()) all.glow = std::move(next.light);
        } else if (cover.light.empty()) {
            cover = std::move(next);
        } else {
            for (std::size_t i = 0; i < cover.light.size(); ++i) {
                cover.light[i] = next.light[i] + next.transmittance[i] * cover.light[i];
                cover.transmittance[i] *= next.transmittance[i];
            }
        }
    }
    return all;
}

// Calls paint(pixel_positions, lights) for each tile in the rows [begin, end) of a picture, and stores the results.
template <class Paint>
void paint_tiles(int begin, int end, Sampled& out, const Paint& paint) {
    std::array<PixelPosition, kPacketRays> pixel_positions;
    std::array<PixelLight, kPacketRays> lights;
    const int width = out.picture.width;
    for (int top = begin; top < end; top += kTileHeight) {
        for (int left = 0; left < width; left += kTileWidth) {
            poll_loop_stop();
            std::size_t count = 0;
            for (int y = top; y < std::min(top + kTileHeight, end); ++y) {
                for (int x = left; x < std::min(left + kTileWidth, width); ++x) pixel_positions[count++] = {x, y};
            }
            paint(std::span<const PixelPosition>(pixel_positions.data(), count), std::span(lights.data(), count));
            for (std::size_t k = 0; k < count; ++k) out.store(pixel_positions[k], lights[k]);
        }
    }
}

// Visible spheres of a draft and their shadows, computed without rays if this is faster.
class DraftSpheres {
public:
    DraftSpheres(const Preview& preview, const Camera& camera, const PictureOptions& options, const Painter& painter)
        : width_(options.width), view_(preview.spheres(), camera, options.width, options.height) {
        pays_ = view_.pays() && !view_.empty();
        const auto sun = painter.sun_middle();
        if (sun && pays_) shadows_.emplace(preview.spheres(), *sun);
        if (shadows_ && !shadows_->is_faster_than_rays()) shadows_.reset();
        if (!pays_ || (sun && !shadows_)) preview.prepare_sphere_rays();
    }

    // Paints the rows [begin, end) of one band of the view.
    void paint(const Painter& painter, int begin, int end, Sampled& out) const {
        std::vector<SphereFind> finds;
        if (pays_) {
            finds.resize(static_cast<std::size_t>(end - begin) * static_cast<std::size_t>(width_));
            view_.find(begin / SphereView::band_rows(), finds);
        }
        std::array<SphereFind, kPacketRays> here;
        paint_tiles(begin, end, out, [&](std::span<const PixelPosition> pixel_positions, std::span<PixelLight> lights) {
            for (std::size_t k = 0; k < pixel_positions.size() && !finds.empty(); ++k) {
                here[k] =
                    finds[static_cast<std::size_t>(pixel_positions[k].y - begin) * static_cast<std::size_t>(width_) +
                          static_cast<std::size_t>(pixel_positions[k].x)];
            }
            const std::span<const SphereFind> seen(here.data(), finds.empty() ? 0 : pixel_positions.size());
            painter.quick_pixels(pixel_positions, lights, seen, shadows_ ? &*shadows_ : nullptr);
        });
    }

private:
    int width_;
    SphereView view_;
    bool pays_ = false;
    std::optional<SunShadows> shadows_;
};

// Visible spheres and their shadows, computed without rays if the spheres do not move and if this is faster. The
// spheres that camera rays can hit are listed for each tile if the camera is a pinhole camera.
class TiledSpheres {
public:
    TiledSpheres(const Preview& preview, const Camera& camera, const PictureOptions& options, const Painter& painter) {
        if (preview.spheres().centers.empty() || preview.spheres_move()) return;
        if (!(camera.aperture > 0.0)) {
            view_.emplace(preview.spheres(), camera, options.width, options.height, WithinPixel::anywhere);
            if (!view_->pays()) view_.reset();
        }
        // Above these limits, rays find the shadows. The grid of shadows takes up to 400 bytes per sphere, and rays to
        // a wide sun cross too many cells.
        constexpr std::size_t kMostSpheres = 500000;
        constexpr double kWidestSun = 0.1;
        if (preview.spheres().centers.size() > kMostSpheres || painter.sun_slope() > kWidestSun) return;
        if (const auto sun = painter.sun_middle()) {
            shadows_.emplace(preview.spheres(), *sun);
            if (!shadows_->is_faster_than_rays(painter.sun_slope())) shadows_.reset();
        }
    }

    // Paints the rows [begin, end) of one row of tiles.
    void paint(const Painter& painter, int begin, int end, Sampled& out) const {
        constexpr std::size_t kMost = 256;  // number of spheres in a tile above which rays are faster
        SphereTiles tiles;
        if (view_) tiles = view_->tiles(begin, end, kTileWidth);
        paint_tiles(begin, end, out, [&](std::span<const PixelPosition> pixel_positions, std::span<PixelLight> lights) {
            KnownSpheres known{{}, shadows_ ? &*shadows_ : nullptr};
            if (view_) known.listed = tiles.of(static_cast<std::size_t>(pixel_positions[0].x / kTileWidth));
            if (known.listed && known.listed->size() > kMost) known.listed.reset();
            painter.pixels(pixel_positions, lights, known);
        });
    }

private:
    std::optional<SphereView> view_;
    std::optional<SunShadows> shadows_;
};

Sampled sampled(const Preview& preview, const Camera& camera, const PictureOptions& options, std::vector<Lamp> lamps) {
    const Painter painter(preview, camera, options, std::move(lamps));
    std::optional<DraftSpheres> draft;
    std::optional<TiledSpheres> tiled;
    if (options.quick) {
        draft.emplace(preview, camera, options, painter);
    } else {
        tiled.emplace(preview, camera, options, painter);
    }
    const std::size_t pixels = pixel_count(options);
    // A draft is not filtered and needs only the light.
    const std::size_t filtered = options.quick ? 0 : pixels;
    Sampled out{{options.width, options.height, std::vector<Float3>(pixels), std::vector<float>(filtered),
                 std::vector<PixelFeatures>(filtered)},
                std::vector<float>(options.transparent ? pixels : 0)};
    const auto rows = static_cast<std::size_t>(options.height);
    std::atomic<std::size_t> rows_done{0};
    const int block = options.quick ? SphereView::band_rows() : kTileHeight;
    parallel_for_blocks(rows, static_cast<std::size_t>(block), [&](std::size_t, std::size_t begin, std::size_t end) {
        const auto [top, bottom] = std::pair(static_cast<int>(begin), static_cast<int>(end));
        if (draft) {
            draft->paint(painter, top, bottom, out);
        } else {
            tiled->paint(painter, top, bottom, out);
        }
        for (std::size_t row = begin; row < end && options.progress; ++row) {
            options.progress(static_cast<double>(++rows_done) / static_cast<double>(rows));
        }
    });
    return out;
}

// Composites the layers over a pixel. The colour of a layer is tone-mapped as if the layer were opaque, and is
// multiplied by the coverage afterwards. In the opposite order, thin layers would be too bright.
void lay_over(const LaidOver& layers, std::size_t i, double exposure, Vec3& light, double& alpha) {
    if (!layers.cover.light.empty()) {
        const double open = layers.cover.transmittance[i];
        if (open < 1.0) {
            const Vec3 shown = tone_mapped(exposure / (1.0 - open) * layers.cover.light[i]);
            light = open * light + (1.0 - open) * shown;
            alpha = 1.0 - open * (1.0 - alpha);
        }
    }
    if (!layers.glow.empty()) {
        const Vec3 shown = tone_mapped(exposure * layers.glow[i]);
        light += shown;
        alpha = std::max(alpha, std::min(1.0, luminance(shown)));
    }
}

// Stores the bytes of a pixel. The light is divided by alpha, because colours of PNG files are not premultiplied.
void store_pixel(Image& image, std::size_t index, Vec3 light, double alpha) {
    if (!image.alpha.empty()) {
        if (alpha > 0.0) light = light / alpha;
        image.alpha[index] = static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(alpha, 0.0, 1.0)));
    }
    std::uint8_t* pixel = &image.rgb[3 * index];
    pixel[0] = display_channel(light.x);
    pixel[1] = display_channel(light.y);
    pixel[2] = display_channel(light.z);
}

}  // namespace

Image render_picture(const Preview& preview, const Camera& camera, const PictureOptions& options,
                     std::span<const Sprites> layers) {
    const bool are_drawn =
        std::any_of(layers.begin(), layers.end(), [](const Sprites& layer) { return !layer.empty(); });
    if (!options.quick || are_drawn) preview.prepare_sphere_rays();
    const LaidOver over = laid_over_each_other(layers, preview, camera, options);
    Sampled all = sampled(preview, camera, options, options.quick ? std::vector<Lamp>{} : lamps_in(layers, preview));
    if (options.filter && !options.quick) filter_noise(all.picture);
    const std::size_t pixels = pixel_count(options);
    Image image{options.width, options.height, {}, {}};
    image.rgb.resize(3 * pixels);
    if (options.transparent) image.alpha.resize(pixels);
    parallel_for_blocks(pixels, 4096, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Float3& shown = all.picture.light[i];
            Vec3 light{shown.x, shown.y, shown.z};
            double alpha = options.transparent ? all.alpha[i] : 1.0;
            lay_over(over, i, options.exposure, light, alpha);
            store_pixel(image, i, light, alpha);
        }
    });
    return image;
}

double picture_bytes(int width, int height, bool has_sprites) {
    // Bytes per pixel of the picture, of the copy that is packed, and of the packed data, whose buffer grows by
    // doubling.
    constexpr double kPixel = 5.0 * 4.0;
    constexpr double kFiltered = 2.0 * (sizeof(Float3) + sizeof(float)) + sizeof(PixelFeatures) + sizeof(float);
    constexpr double kSprites = sizeof(Vec3) + sizeof(double);
    return static_cast<double>(width) * static_cast<double>(height) *
           (kPixel + kFiltered + (has_sprites ? kSprites : 0.0));
}

}  // namespace ricochet
