/// \file
/// The light of a picture: a sun and a sky. Colours are linear light; brightness is in units of the picture's exposure.
#include "ricochet/render/picture.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "ricochet/core/parallel.h"
#include "ricochet/core/vec3.h"
#include "ricochet/render/camera.h"
#include "ricochet/render/color_map.h"

namespace ricochet {

namespace {

constexpr std::size_t kRows = 16;        // rows per unit of parallel work
constexpr std::size_t kDiscs = 256;      // discs per unit of parallel work
constexpr double kSmallestRadius = 0.8;  // pixels
constexpr double kGlowReach = 2.5;       // a glow's radius over the particle's
constexpr double kDaylight = 1.8;        // light on a haze

// A disc on the screen, in pixels.
struct Disc {
    double x = 0.0;
    double y = 0.0;
    double radius = 0.0;
    double depth = 0.0;
    double strength = 0.0;
    Vec3 color;
};

class Projector {
public:
    Projector(const Camera& camera, int width, int height)
        : camera_(camera),
          frame_(camera_frame(camera)),
          middle_x_(0.5 * width),
          middle_y_(0.5 * height),
          scale_(0.5 * height / std::tan(0.5 * camera.fov_degrees * std::numbers::pi / 180.0)) {}

    // A disc of no strength where there is nothing to be seen.
    [[nodiscard]] Disc project(const Sprites& sprites, std::size_t i, const Preview& preview) const {
        Disc disc;
        const Vec3 away = sprites.centers[i] - camera_.position;
        disc.depth = dot(away, frame_.forward);
        if (!is_finite(away) || !(disc.depth > 0.0) || !(sprites.radii[i] > 0.0)) return disc;
        disc.x = middle_x_ + scale_ * dot(away, frame_.right) / disc.depth;
        disc.y = middle_y_ - scale_ * dot(away, frame_.up) / disc.depth;
        const double radius = scale_ * sprites.radii[i] / disc.depth * (sprites.glow ? kGlowReach : 1.0);
        disc.radius = std::max(radius, kSmallestRadius);
        const double part = radius / disc.radius;
        if (disc.x + disc.radius < 0.0 || disc.x - disc.radius > 2.0 * middle_x_) return disc;
        if (disc.y + disc.radius < 0.0 || disc.y - disc.radius > 2.0 * middle_y_) return disc;
        const auto hit = preview.trace({camera_.position, normalized(away)});
        if (hit && hit->distance < length(away) - sprites.radii[i]) return disc;
        disc.strength = std::clamp(sprites.opacities[i], 0.0, 1.0) * part * part;
        disc.color = sprites.glow ? sprites.colors[i] : kDaylight * sprites.colors[i];
        return disc;
    }

private:
    const Camera& camera_;
    CameraFrame frame_;
    double middle_x_, middle_y_, scale_;
};

void lay_over(const Disc& disc, bool glow, std::size_t first_row, std::size_t last_row, int width, SpriteLayer& layer) {
    const double top = std::max(std::floor(disc.y - disc.radius), static_cast<double>(first_row));
    const double bottom = std::min(std::ceil(disc.y + disc.radius), static_cast<double>(last_row));
    const double left = std::max(std::floor(disc.x - disc.radius), 0.0);
    const double right = std::min(std::ceil(disc.x + disc.radius), static_cast<double>(width));
    for (double y = top; y < bottom; y += 1.0) {
        for (double x = left; x < right; x += 1.0) {
            const double dx = (x + 0.5 - disc.x) / disc.radius;
            const double dy = (y + 0.5 - disc.y) / disc.radius;
            const double rim = 1.0 - dx * dx - dy * dy;
            if (!(rim > 0.0)) continue;
            const double cover = disc.strength * rim * rim * (glow ? rim : 1.0);
            const std::size_t pixel =
                static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            if (glow) {
                layer.light[pixel] += cover * disc.color;
            } else {
                layer.light[pixel] = (1.0 - cover) * layer.light[pixel] + cover * disc.color;
                layer.transmittance[pixel] *= 1.0 - cover;
            }
        }
    }
}

}  // namespace

SpriteLayer draw_sprites(const Sprites& sprites, const Preview& preview, const Camera& camera, int width, int height) {
    const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
    SpriteLayer layer{std::vector<Vec3>(pixels), std::vector<double>(pixels, 1.0)};
    std::vector<Disc> discs(sprites.centers.size());
    const Projector projector(camera, width, height);
    parallel_for_blocks(discs.size(), kDiscs, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) discs[i] = projector.project(sprites, i, preview);
    });
    std::erase_if(discs, [](const Disc& disc) { return !(disc.strength > 0.0); });
    std::stable_sort(discs.begin(), discs.end(), [](const Disc& a, const Disc& b) { return a.depth > b.depth; });
    parallel_for_blocks(static_cast<std::size_t>(height), kRows, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (const Disc& disc : discs) {
            if (disc.y + disc.radius < static_cast<double>(begin) || disc.y - disc.radius > static_cast<double>(end))
                continue;
            lay_over(disc, sprites.glow, begin, end, width, layer);
        }
    });
    return layer;
}

/// Sun and sky over a picture.
struct Daylight {
    Vec3 up{0, 0, 1};
    Vec3 to_sun{0, 0, 1};         ///< of unit length
    Vec3 sun{3.4, 2.98, 2.42};    ///< light on a surface that faces the sun
    double sky_brightness = 1.0;  ///< factor of what comes from the sky
    Vec3 backdrop_tint{1, 1, 1};  ///< factors of what the picture shows behind everything
    double sun_size = 0.025;  ///< tangent of half the sun's apparent size; larger than the real one for soft shadows

    /// Light from a direction that nothing blocks.
    [[nodiscard]] Vec3 sky(const Vec3& direction) const;
    /// What the picture shows behind everything: brighter than the light that comes from there, and pale below.
    [[nodiscard]] Vec3 backdrop(const Vec3& direction) const;
    /// A direction towards a point of the sun's disk; u and v in 0..1.
    [[nodiscard]] Vec3 sun_direction(double u, double v) const;
};

/// Daylight with the sun behind the camera's left shoulder.
[[nodiscard]] Daylight daylight_for(const Camera& camera);
/// A dark night with a little moonlight from there.
[[nodiscard]] Daylight night_for(const Camera& camera);

/// A direction about the normal with the density of the cosine law; u and v in 0..1.
[[nodiscard]] Vec3 cosine_direction(const Vec3& normal, double u, double v);

namespace {

constexpr Vec3 kZenith{0.20, 0.36, 0.68};
constexpr Vec3 kHorizon{0.62, 0.70, 0.80};
constexpr Vec3 kBelow{0.36, 0.34, 0.32};

Vec3 mix(const Vec3& a, const Vec3& b, double t) { return (1.0 - t) * a + t * b; }

}  // namespace

Vec3 Daylight::sky(const Vec3& direction) const {
    const double height = dot(direction, up);
    if (height < 0.0) return sky_brightness * mix(kHorizon, kBelow, std::min(1.0, -2.5 * height));
    return sky_brightness * mix(kHorizon, kZenith, std::pow(std::min(1.0, height), 0.6));
}

Vec3 Daylight::backdrop(const Vec3& direction) const {
    constexpr Vec3 kTop{0.60, 1.10, 2.10};
    constexpr Vec3 kLevel{2.30, 2.55, 2.80};
    constexpr Vec3 kBottom{1.70, 1.70, 1.68};
    const double height = dot(direction, up);
    const Vec3 light = height < 0.0 ? mix(kLevel, kBottom, std::min(1.0, -1.6 * height))
                                    : mix(kLevel, kTop, std::pow(std::min(1.0, height), 0.7));
    return {light.x * backdrop_tint.x, light.y * backdrop_tint.y, light.z * backdrop_tint.z};
}

Vec3 Daylight::sun_direction(double u, double v) const {
    const auto [first, second] = tangent_frame(to_sun);
    const double radius = sun_size * std::sqrt(u);
    const double angle = 2.0 * std::numbers::pi * v;
    return normalized(to_sun + radius * std::cos(angle) * first + radius * std::sin(angle) * second);
}

Daylight daylight_for(const Camera& camera) {
    Daylight light;
    light.up = camera.up;
    const CameraFrame frame = camera_frame(camera);
    Vec3 ahead = frame.forward - dot(frame.forward, camera.up) * camera.up;
    ahead = length(ahead) > 1e-6 ? normalized(ahead) : frame.up;
    light.to_sun = normalized(-0.78 * frame.right - 0.25 * ahead + 0.72 * camera.up);
    return light;
}

Daylight night_for(const Camera& camera) {
    Daylight light = daylight_for(camera);
    light.sun = {0.10, 0.13, 0.20};
    light.sky_brightness = 0.05;
    light.backdrop_tint = {0.003, 0.0045, 0.008};
    return light;
}

Vec3 cosine_direction(const Vec3& normal, double u, double v) {
    const auto [first, second] = tangent_frame(normal);
    const double radius = std::sqrt(u);
    const double angle = 2.0 * std::numbers::pi * v;
    const double height = std::sqrt(std::max(0.0, 1.0 - u));
    return normalized(radius * std::cos(angle) * first + radius * std::sin(angle) * second + height * normal);
}

namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

// Numbers that a sample needs: position in the pixel, position on the sun (twice), direction into the sky.
enum Dimension { kPixelX, kPixelY, kSunU, kSunV, kSkyU, kSkyV, kFarSunU, kFarSunV, kDimensions };

// Powers of 1/phi where phi is the root of x^9 = x + 1: an additive sequence that fills the 8-cube evenly.
// Method: M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018.
std::array<double, kDimensions> additive_steps() {
    double phi = 1.1;
    for (int i = 0; i < 64; ++i) phi = std::pow(1.0 + phi, 1.0 / (kDimensions + 1));
    std::array<double, kDimensions> steps{};
    double power = 1.0;
    for (double& step : steps) step = (power /= phi);
    return steps;
}

// A well-mixed 32-bit value. Method: the integer finaliser of the hash "lowbias32", C. Wellons, 2018.
std::uint32_t mixed(std::uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    x ^= x >> 16;
    return x;
}

// The samples of one pixel: the same additive sequence everywhere, shifted by the pixel's own random offset.
class PixelSamples {
public:
    PixelSamples(const std::array<double, kDimensions>& steps, std::uint32_t x, std::uint32_t y) : steps_(steps) {
        for (std::uint32_t d = 0; d < kDimensions; ++d) {
            offset_[d] = mixed(x + mixed(y + mixed(d))) * (1.0 / 4294967296.0);
        }
    }
    [[nodiscard]] double get(int sample, Dimension d) const {
        const double value = offset_[d] + (sample + 1) * steps_[d];
        return value - std::floor(value);
    }

private:
    const std::array<double, kDimensions>& steps_;
    std::array<double, kDimensions> offset_{};
};

Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

// Brightness to display range: L (1 + L / white^2) / (1 + L) on the luminance, colours kept.
// Method: E. Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, eq. 4.
Vec3 tone_mapped(const Vec3& light) {
    constexpr double kWhite = 3.0;
    const double luminance = 0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z;
    if (!(luminance > 0.0)) return {};
    const double shown = luminance * (1.0 + luminance / (kWhite * kWhite)) / (1.0 + luminance);
    return light * (shown / luminance);
}

std::uint8_t channel(double linear) {
    return static_cast<std::uint8_t>(std::lround(255.0 * srgb_from_linear(std::clamp(linear, 0.0, 1.0))));
}

class Painter {
public:
    Painter(const Preview& preview, const Camera& camera, const PictureOptions& options)
        : preview_(preview),
          camera_(camera),
          frame_(camera_frame(camera)),
          options_(options),
          daylight_(options.night ? night_for(camera) : daylight_for(camera)),
          steps_(additive_steps()),
          tangent_(std::tan(0.5 * camera.fov_degrees * std::numbers::pi / 180.0)),
          extent_(tangent_ * length(camera.target - camera.position)),
          tile_(std::pow(10.0, std::floor(std::log10(0.4 * extent_)))) {}

    [[nodiscard]] Vec3 pixel_light(int x, int y) const {
        const PixelSamples samples(steps_, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
        Vec3 sum;
        for (int s = 0; s < options_.samples; ++s) {
            const PreviewRay ray = camera_ray(x + samples.get(s, kPixelX), y + samples.get(s, kPixelY));
            sum += tone_mapped(options_.exposure * seen(ray, samples, s));
        }
        return sum / options_.samples;
    }

private:
    [[nodiscard]] PreviewRay camera_ray(double x, double y) const {
        const double aspect = static_cast<double>(options_.width) / options_.height;
        const double across = (2.0 * x / options_.width - 1.0) * aspect * tangent_;
        const double along = (1.0 - 2.0 * y / options_.height) * tangent_;
        return {camera_.position, normalized(frame_.forward + across * frame_.right + along * frame_.up)};
    }

    [[nodiscard]] Vec3 seen(const PreviewRay& ray, const PixelSamples& samples, int s) const {
        const std::optional<PreviewHit> hit = preview_.trace(ray);
        return through_glass(ray, hit ? hit->distance : kNothing, solid_light(ray, hit, samples, s));
    }

    // The light from behind, tinted and covered by the glass surfaces in front of it. Glass covers more where it is
    // seen at a slant, which draws its outline.
    [[nodiscard]] Vec3 through_glass(PreviewRay ray, double distance, const Vec3& behind) const {
        constexpr int kMostSurfaces = 8;
        Vec3 light;
        double open = 1.0;
        for (int k = 0; k < kMostSurfaces; ++k) {
            const std::optional<PreviewHit> glass = preview_.trace_glass(ray);
            if (!glass || glass->distance >= distance) break;
            const double slant = 1.0 - std::fabs(dot(glass->normal, ray.direction));
            const double cover = 0.04 + 0.6 * slant * slant * slant;
            const double shade = 0.6 + 0.4 * std::fabs(dot(glass->normal, daylight_.to_sun));
            light += open * cover * shade * (times(glass->color, daylight_.sun) + gloss(*glass, ray));
            open *= 1.0 - cover;
            const PreviewHit beyond = {glass->distance, glass->point, glass->normal, -glass->face, {}, glass->kind};
            const Vec3 next = off_surface(beyond);
            distance -= length(next - ray.origin);
            ray.origin = next;
        }
        return light + open * behind;
    }

    [[nodiscard]] Vec3 solid_light(const PreviewRay& ray, const std::optional<PreviewHit>& hit,
                                   const PixelSamples& samples, int s) const {
        if (!hit) return daylight_.backdrop(ray.direction);
        const Vec3 color = surface_color(*hit);
        Vec3 light = times(color, sun_light(*hit, samples.get(s, kSunU), samples.get(s, kSunV)));
        light += times(color, sky_light(*hit, samples, s));
        if (hit->kind == PreviewHit::Kind::sphere) light += gloss(*hit, ray);
        return hit->kind == PreviewHit::Kind::plane ? faded(light, *hit, ray) : light;
    }

    // Light of the sun on a surface, unless something stands in between.
    [[nodiscard]] Vec3 sun_light(const PreviewHit& hit, double u, double v) const {
        const Vec3 to_sun = daylight_.sun_direction(u, v);
        const double cosine = dot(hit.normal, to_sun);
        if (cosine <= 0.0 || dot(hit.face, to_sun) <= 0.0) return {};
        return preview_.occluded({off_surface(hit), to_sun}) ? Vec3{} : cosine * daylight_.sun;
    }

    // Light from one direction of the sky, or from the sunlit surface that is seen instead of it.
    [[nodiscard]] Vec3 sky_light(const PreviewHit& hit, const PixelSamples& samples, int s) const {
        const Vec3 direction = cosine_direction(hit.normal, samples.get(s, kSkyU), samples.get(s, kSkyV));
        const std::optional<PreviewHit> other = preview_.trace({off_surface(hit), direction});
        if (!other) return daylight_.sky(direction);
        const Vec3 sun = sun_light(*other, samples.get(s, kFarSunU), samples.get(s, kFarSunV));
        constexpr Vec3 kFarSky{0.22, 0.25, 0.30};  // stands for all further bounces
        return times(other->color, sun + daylight_.sky_brightness * kFarSky);
    }

    // A soft highlight of the sky and its brightest part on particles.
    [[nodiscard]] Vec3 gloss(const PreviewHit& hit, const PreviewRay& ray) const {
        const double facing = -dot(hit.normal, ray.direction);
        const Vec3 mirrored = ray.direction + 2.0 * facing * hit.normal;
        const double grazing = 1.0 - std::clamp(facing, 0.0, 1.0);
        const double fresnel = 0.04 + 0.5 * std::pow(grazing, 5.0);
        const double sun_spot = std::pow(std::max(0.0, dot(mirrored, daylight_.to_sun)), 60.0);
        return fresnel * (0.5 * daylight_.sky(mirrored) + 4.0 * sun_spot * daylight_.sun);
    }

    // Starting points of further rays stand off the surface by what single precision cannot tell apart.
    [[nodiscard]] Vec3 off_surface(const PreviewHit& hit) const {
        constexpr double kSinglePrecision = 2e-6;
        const double scale = std::max(max_abs(hit.point - preview_.origin()), hit.distance);
        return hit.point + kSinglePrecision * scale * hit.face;
    }

    // Planes carry a faint chequer that gives the eye a scale.
    [[nodiscard]] Vec3 surface_color(const PreviewHit& hit) const {
        if (hit.kind != PreviewHit::Kind::plane) return hit.color;
        const auto [u, v] = tangent_frame(hit.normal);
        const double cells = std::floor(dot(hit.point, u) / tile_) + std::floor(dot(hit.point, v) / tile_);
        const bool odd = cells - 2.0 * std::floor(0.5 * cells) > 0.5;
        const double fade = std::exp(-hit.distance / (12.0 * extent_));
        return hit.color * (odd ? 1.0 : 1.0 - 0.10 * fade);
    }

    // Planes go on for ever; far away they turn into the horizon.
    [[nodiscard]] Vec3 faded(const Vec3& light, const PreviewHit& hit, const PreviewRay& ray) const {
        const double reach = hit.distance / (14.0 * extent_);
        const double left = std::exp(-reach * reach);
        const Vec3 level = ray.direction - dot(ray.direction, daylight_.up) * daylight_.up;
        return left * light + (1.0 - left) * daylight_.backdrop(length(level) > 1e-9 ? normalized(level) : level);
    }

    const Preview& preview_;
    Camera camera_;
    CameraFrame frame_;
    PictureOptions options_;
    Daylight daylight_;
    std::array<double, kDimensions> steps_;
    double tangent_;
    double extent_;  // half the height of what the picture shows at the target, m
    double tile_;    // edge of the chequer on planes, m
};

}  // namespace

Image render_picture(const Preview& preview, const Camera& camera, const PictureOptions& options,
                     const Sprites& sprites) {
    const Painter painter(preview, camera, options);
    SpriteLayer layer;
    if (!sprites.empty()) layer = draw_sprites(sprites, preview, camera, options.width, options.height);
    Image image{options.width, options.height, {}};
    const auto rows = static_cast<std::size_t>(options.height);
    image.rgb.resize(3 * static_cast<std::size_t>(options.width) * rows);
    std::atomic<std::size_t> rows_done{0};
    parallel_for_blocks(rows, 1, [&](std::size_t row, std::size_t, std::size_t) {
        for (int x = 0; x < options.width; ++x) {
            Vec3 light = painter.pixel_light(x, static_cast<int>(row));
            const std::size_t index = row * static_cast<std::size_t>(options.width) + static_cast<std::size_t>(x);
            if (!sprites.empty()) {
                light = layer.transmittance[index] * light + tone_mapped(options.exposure * layer.light[index]);
            }
            std::uint8_t* pixel = &image.rgb[3 * index];
            pixel[0] = channel(light.x);
            pixel[1] = channel(light.y);
            pixel[2] = channel(light.z);
        }
        if (options.progress) options.progress(static_cast<double>(++rows_done) / static_cast<double>(rows));
    });
    return image;
}

double picture_bytes(int width, int height, bool has_sprites) {
    // The picture, the copy from which PNG is packed, and what it is packed into, which grows by doubling.
    constexpr double kPixel = 5.0 * 3.0;
    constexpr double kSprites = sizeof(Vec3) + sizeof(double);
    return static_cast<double>(width) * static_cast<double>(height) * (kPixel + (has_sprites ? kSprites : 0.0));
}

}  // namespace ricochet
