#include "ricochet/render/painter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "ricochet/render/tone.h"

namespace ricochet {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr double kMirror = 0.3;  // surfaces smoother than this show what is around them

Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

// Adds one sample to the means of a pixel; `sum_of_squares` of the luminance.
struct PixelSum {
    PixelLight sum;
    double sum_of_squares = 0.0;

    void add(const Vec3& shown) {
        sum.light += shown;
        const double bright = luminance(shown);
        sum_of_squares += bright * bright;
    }

    [[nodiscard]] PixelLight mean(int samples) const {
        PixelLight mean = sum;
        mean.light = sum.light / samples;
        mean.normal = sum.normal / samples;
        mean.albedo = sum.albedo / samples;
        mean.distance = sum.distance / samples;
        mean.slope = sum.slope / samples;
        mean.alpha = sum.alpha / samples;
        const double bright = luminance(mean.light);
        // Of one sample nothing is known: it may be off by as much as it is.
        const double spread = samples == 1 ? bright * bright : sum_of_squares / samples - bright * bright;
        mean.variance = std::max(0.0, spread) / std::max(1, samples - 1);
        return mean;
    }
};

}  // namespace

Painter::Painter(const Preview& preview, const Camera& camera, const PictureOptions& options, std::vector<Lamp> lamps)
    : preview_(preview),
      camera_(camera),
      frame_(camera_frame(camera)),
      options_(options),
      light_(light_for(options.lighting, camera)),
      lamps_(std::move(lamps)),
      tangent_(half_height(camera)),
      focus_(camera.focus_distance > 0.0 ? camera.focus_distance : length(camera.target - camera.position)),
      extent_(tangent_ * length(camera.target - camera.position)),
      tile_(std::pow(10.0, std::floor(std::log10(0.4 * extent_)))) {}

PixelLight Painter::pixel(int x, int y) const {
    const PixelSamples samples(x, y);
    PixelSum sum;
    sum.sum.alpha = 0.0;
    for (int s = 0; s < options_.samples; ++s) {
        const SamplePair at = samples.get(s, SamplePurpose::pixel);
        PreviewRay ray = camera_ray(x + at.u, y + at.v, samples.get(s, SamplePurpose::lens));
        ray.time = samples.time(s);
        const Seen seen_here = seen(ray, samples, s);
        sum.add(tone_mapped(options_.exposure * seen_here.light));
        sum.sum.alpha += seen_here.cover;
        if (!seen_here.hit) {
            sum.sum.albedo += {1, 1, 1};
            continue;
        }
        const PreviewHit& hit = *seen_here.hit;
        const double pixel_size = 2.0 * tangent_ * hit.distance / options_.height;
        const double facing = std::max(0.05, std::fabs(dot(hit.face, ray.direction)));
        sum.sum.normal += hit.normal;
        sum.sum.albedo += surface_color(hit);
        sum.sum.distance += hit.distance;
        sum.sum.slope += pixel_size / facing;
    }
    return sum.mean(options_.samples);
}

PixelLight Painter::quick_pixel(int x, int y) const {
    PreviewRay ray = camera_ray(x + 0.5, y + 0.5, {});
    ray.time = 1.0;
    const std::optional<PreviewHit> hit = preview_.trace(ray);
    const bool open = options_.transparent && !hit;
    Vec3 light;
    if (hit) light = quick_light(ray, *hit);
    if (!hit && !open) light = behind_everything(ray.direction);
    const Seen shown = through_glass(ray, hit ? hit->distance : kNothing, light);
    PixelLight pixel;
    pixel.light = tone_mapped(options_.exposure * shown.light);
    pixel.alpha = open ? shown.cover : 1.0;
    return pixel;
}

PreviewRay Painter::camera_ray(double x, double y, const SamplePair& lens) const {
    const double aspect = static_cast<double>(options_.width) / options_.height;
    const double across = (2.0 * x / options_.width - 1.0) * aspect * tangent_;
    const double along = (1.0 - 2.0 * y / options_.height) * tangent_;
    const Vec3 ahead = frame_.forward + across * frame_.right + along * frame_.up;
    if (!(camera_.aperture > 0.0)) return {camera_.position, normalized(ahead)};
    const double radius = 0.5 * camera_.aperture * std::sqrt(lens.u);
    const double angle = 2.0 * std::numbers::pi * lens.v;
    const Vec3 offset = radius * std::cos(angle) * frame_.right + radius * std::sin(angle) * frame_.up;
    return {camera_.position + offset, normalized(focus_ * ahead - offset)};
}

Vec3 Painter::behind_everything(const Vec3& direction) const {
    return options_.background ? *options_.background : light_.backdrop(direction);
}

Painter::Seen Painter::seen(const PreviewRay& ray, const PixelSamples& samples, int s) const {
    const std::optional<PreviewHit> hit = preview_.trace(ray);
    const bool open = options_.transparent && !hit;
    Seen out = through_glass(ray, hit ? hit->distance : kNothing, open ? Vec3{} : solid_light(ray, hit, samples, s));
    if (!open) out.cover = 1.0;
    out.hit = hit;
    return out;
}

// The light from behind, tinted and covered by the glass surfaces in front of it. Glass covers more where it is seen at
// a slant, which draws its outline.
Painter::Seen Painter::through_glass(PreviewRay ray, double distance, const Vec3& behind) const {
    constexpr int kMostSurfaces = 8;
    Vec3 light;
    double open = 1.0;
    for (int k = 0; k < kMostSurfaces; ++k) {
        const std::optional<PreviewHit> glass = preview_.trace_glass(ray);
        if (!glass || glass->distance >= distance) break;
        const double slant = 1.0 - std::fabs(dot(glass->normal, ray.direction));
        const double cover = 0.04 + 0.6 * slant * slant * slant;
        const double shade = 0.6 + 0.4 * std::fabs(dot(glass->normal, light_.to_sun));
        const Vec3 bright = light_.has_sun() ? light_.sun : light_.sky_colors.zenith;
        light += open * cover * shade * (times(glass->color, bright) + gloss(*glass, ray));
        open *= 1.0 - cover;
        PreviewHit beyond = *glass;
        beyond.face = -glass->face;
        const Vec3 next = off_surface(beyond);
        distance -= length(next - ray.origin);
        ray.origin = next;
    }
    return {light + open * behind, std::nullopt, 1.0 - open};
}

Vec3 Painter::solid_light(const PreviewRay& ray, const std::optional<PreviewHit>& hit, const PixelSamples& samples,
                          int s) const {
    if (!hit) return behind_everything(ray.direction);
    const Vec3 color = surface_color(*hit);
    Vec3 light = hit->emission + times(color, sun_light(*hit, samples.get(s, SamplePurpose::sun)));
    light += times(color, sky_light(*hit, samples, s));
    if (!lamps_.empty()) light += times(color, lamp_light(*hit, samples.get(s, SamplePurpose::lamp)));
    if (hit->roughness < 1.0) light += gloss(*hit, ray);
    return hit->kind == PreviewHit::Kind::plane ? faded(light, *hit, ray) : light;
}

// Without rays but the one to the sun.
Vec3 Painter::quick_light(const PreviewRay& ray, const PreviewHit& hit) const {
    constexpr double kOpenSky = 0.7;  // the part of the sky that is seen from a surface among others
    const Vec3 color = surface_color(hit);
    const Vec3 light = hit.emission + times(color, sun_light(hit, {}) + kOpenSky * light_.sky(hit.normal));
    return hit.kind == PreviewHit::Kind::plane ? faded(light, hit, ray) : light;
}

// Light of the sun on a surface, unless something stands in between.
Vec3 Painter::sun_light(const PreviewHit& hit, const SamplePair& at) const {
    if (!light_.has_sun()) return {};
    const Vec3 to_sun = light_.sun_direction(at.u, at.v);
    const double cosine = dot(hit.normal, to_sun);
    if (cosine <= 0.0) return {};
    return preview_.occluded({off_surface(hit) + hit.lift, to_sun, hit.time}) ? Vec3{} : cosine * light_.sun;
}

// Light of one lamp, chosen by what each would give if nothing stood in between, for all of them.
Vec3 Painter::lamp_light(const PreviewHit& hit, const SamplePair& at) const {
    const auto given = [&](const Lamp& lamp) {
        const Vec3 way = lamp.position - hit.point;
        const double distance = std::max(length(way), lamp.radius);
        return std::max(0.0, dot(hit.normal, way)) / (distance * distance * distance);
    };
    double total = 0.0;
    for (const Lamp& lamp : lamps_) total += given(lamp) * luminance(lamp.intensity);
    if (!(total > 0.0)) return {};
    double left = at.u * total;
    const Lamp* chosen = nullptr;
    for (const Lamp& lamp : lamps_) {
        const double part = given(lamp) * luminance(lamp.intensity);
        if (!(part > 0.0)) continue;
        chosen = &lamp;
        left -= part;
        if (left < 0.0) break;
    }
    const Vec3 start = off_surface(hit) + hit.lift;
    const Vec3 way = chosen->position - start;
    if (preview_.occluded({start, normalized(way), hit.time, length(way)})) return {};
    return chosen->intensity * (total / luminance(chosen->intensity));
}

// Light from one direction of the sky, or from the sunlit surface that is seen instead of it.
Vec3 Painter::sky_light(const PreviewHit& hit, const PixelSamples& samples, int s) const {
    const SamplePair at = samples.get(s, SamplePurpose::sky);
    const Vec3 direction = cosine_direction(hit.normal, at.u, at.v);
    const std::optional<PreviewHit> other = preview_.trace({off_surface(hit) + hit.lift, direction, hit.time});
    if (!other) return light_.sky(direction);
    const Vec3 sun = sun_light(*other, samples.get(s, SamplePurpose::far_sun));
    constexpr Vec3 kFarSky{0.22, 0.25, 0.30};  // stands for all further bounces
    return other->emission + times(other->color, sun + light_.sky_brightness * kFarSky);
}

// A highlight of the sky and its brightest part; on smooth surfaces of what is around.
Vec3 Painter::gloss(const PreviewHit& hit, const PreviewRay& ray) const {
    const double facing = -dot(hit.normal, ray.direction);
    const Vec3 mirrored = ray.direction + 2.0 * facing * hit.normal;
    const double grazing = 1.0 - std::clamp(facing, 0.0, 1.0);
    const double smooth = 1.0 - hit.roughness;
    const double fresnel = 0.04 + 0.5 * std::pow(grazing, 5.0) * std::min(1.0, smooth / (1.0 - kSphereRoughness));
    // The lobe of a rough surface: Beckmann's width as the power of a cosine (B. Walter et al., EGSR 2007).
    const double width = std::max(0.02, hit.roughness * hit.roughness);
    const double power = std::max(1.0, 2.0 / (width * width) - 2.0);
    const double peak = std::max(0.0, dot(mirrored, light_.to_sun));
    const double spot = 4.0 * std::pow(peak, power) * std::clamp(std::sqrt(power / 60.0), 0.1, 8.0);
    Vec3 around = 0.5 * light_.sky(mirrored);
    if (hit.roughness < kMirror) {
        if (const auto other = preview_.trace({off_surface(hit) + hit.lift, mirrored, hit.time})) {
            around = other->emission + times(other->color, sun_light(*other, {0.5, 0.5}) + light_.sky(other->normal));
            return fresnel * around;
        }
        around = behind_everything(mirrored);
    }
    return fresnel * (around + spot * light_.sun);
}

// Starting points of further rays stand off the surface by what single precision cannot tell apart.
Vec3 Painter::off_surface(const PreviewHit& hit) const {
    constexpr double kSinglePrecision = 2e-6;
    const double scale = std::max(max_abs(hit.point - preview_.origin()), hit.distance);
    return hit.point + kSinglePrecision * scale * hit.face;
}

// Planes carry a faint chequer that gives the eye a scale.
Vec3 Painter::surface_color(const PreviewHit& hit) const {
    if (hit.kind != PreviewHit::Kind::plane) return hit.color;
    const auto [u, v] = tangent_frame(hit.normal);
    const double cells = std::floor(dot(hit.point, u) / tile_) + std::floor(dot(hit.point, v) / tile_);
    const bool odd = cells - 2.0 * std::floor(0.5 * cells) > 0.5;
    const double fade = std::exp(-hit.distance / (12.0 * extent_));
    return hit.color * (odd ? 1.0 : 1.0 - 0.10 * fade);
}

// Planes go on for ever; far away they turn into the horizon.
Vec3 Painter::faded(const Vec3& light, const PreviewHit& hit, const PreviewRay& ray) const {
    const double reach = hit.distance / (14.0 * extent_);
    const double left = std::exp(-reach * reach);
    const Vec3 level = ray.direction - dot(ray.direction, light_.up) * light_.up;
    return left * light + (1.0 - left) * behind_everything(length(level) > 1e-9 ? normalized(level) : level);
}

}  // namespace ricochet
