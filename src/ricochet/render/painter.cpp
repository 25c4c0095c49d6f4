#include "ricochet/render/painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "ricochet/render/tone.h"

namespace ricochet {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();
constexpr double kMirror = 0.3;  // surfaces smoother than this show what is around them

Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

// A point of the lamp's disc that faces a surface, and that lies before it; u and v in 0..1.
Vec3 point_of(const Lamp& lamp, const PreviewHit& hit, double u, double v) {
    const Vec3 way = lamp.position - hit.point;
    const auto [a, b] = tangent_frame(normalized(way));
    const DiscPoint at = on_disc({u, v});
    const Vec3 off = std::min(lamp.radius, 0.5 * length(way)) * (at.x * a + at.y * b);
    return dot(hit.normal, way + off) > 0.0 ? lamp.position + off : lamp.position - off;
}

}  // namespace

Painter::Painter(const Preview& preview, const Camera& camera, const PictureOptions& options, std::vector<Lamp> lamps)
    : preview_(preview),
      camera_(camera),
      frame_(camera_frame(camera)),
      options_(options),
      has_glass_(preview.has_glass()),
      light_(light_for(options.lighting, camera)),
      lamps_(std::move(lamps)),
      sun_middle_(light_.sun_direction(0.0, 0.0)),
      horizon_(options.background ? *options.background : light_.backdrop_colors.horizon),
      tangent_(half_height(camera)),
      half_pixel_(tangent_ / options.height),
      focus_(camera.focus_distance > 0.0 ? camera.focus_distance : length(camera.target - camera.position)),
      extent_(tangent_ * length(camera.target - camera.position)),
      tile_(std::pow(10.0, std::floor(std::log10(0.4 * extent_)))) {}

void Painter::pixels(std::span<const PixelPlace> places, std::span<PixelLight> out) const {
    std::array<std::optional<PixelSamples>, kPacketRays> samples;
    std::array<PixelSum, kPacketRays> sums;
    std::array<Look, kPacketRays> room;
    const std::span looks(room.data(), places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        samples[k].emplace(places[k].x, places[k].y);
        sums[k] = PixelSum(options_.exposure);
        looks[k].samples = &*samples[k];
    }
    for (int s = 0; s < options_.samples; ++s) {
        for (std::size_t k = 0; k < places.size(); ++k) aim(looks[k], places[k], s);
        trace(looks);
        add_sun_light(looks);
        add_sky_light(looks);
        for (std::size_t k = 0; k < places.size(); ++k) add(looks[k], sums[k]);
    }
    if (options_.samples < kGlances) add_glances(places, looks, std::span(sums.data(), places.size()));
    for (std::size_t k = 0; k < places.size(); ++k) out[k] = sums[k].mean();
}

// Towards a sample of a pixel.
void Painter::aim(Look& look, const PixelPlace& place, int sample) const {
    look.sample = sample;
    const SamplePair at = look.get(SamplePurpose::pixel);
    const SamplePair lens = camera_.aperture > 0.0 ? look.get(SamplePurpose::lens) : SamplePair{};
    look.ray = camera_ray(place.x + at.u, place.y + at.v, lens);
    look.ray.time = look.samples->time(sample);
}

// More rays from the camera, and to the sun, for pixels whose samples see different things, and some for those beside
// them, whose samples may have missed what is small.
void Painter::add_glances(std::span<const PixelPlace> places, std::span<Look> looks, std::span<PixelSum> sums) const {
    constexpr int kBeside = 4;
    std::array<Look, kPacketRays> room;
    std::array<PixelSum*, kPacketRays> whose{};
    std::size_t count = 0;
    const auto look_at_all = [&] {
        trace(std::span(room.data(), count));
        add_sun_light(std::span(room.data(), count));
        for (std::size_t j = 0; j < count; ++j) whose[j]->add(glance(room[j]));
        count = 0;
    };
    std::array<int, kPacketRays> wanted{};
    for (std::size_t k = 0; k < places.size(); ++k) wanted[k] = sums[k].rays_wanted();
    const int beside = std::min(kBeside, *std::max_element(wanted.begin(), wanted.end()));
    for (std::size_t k = 0; k < places.size(); ++k) {
        const int end = std::min(kGlances, options_.samples + std::max(wanted[k], beside));
        for (int s = options_.samples; s < end; ++s) {
            room[count].samples = looks[k].samples;
            aim(room[count], places[k], s);
            whose[count++] = &sums[k];
            if (count == kPacketRays) look_at_all();
        }
    }
    if (count > 0) look_at_all();
}

void Painter::add(const Look& look, PixelSum& sum) const {
    const bool open = options_.transparent && !look.hit;
    const Vec3 light = open ? Vec3{} : solid_light(look);
    const Seen seen = through_glass(look.ray, look.hit ? look.hit->distance : kNothing, light);
    sum.add(glance(look), light, tone_mapped(options_.exposure * seen.light), open ? seen.cover : 1.0);
}

Glance Painter::glance(const Look& look) const {
    Glance out;
    const bool is_one_of_few = options_.samples < kGlances;
    if (!look.hit) {
        out.covers = !options_.transparent;
        if (out.covers && is_one_of_few) out.own = behind_everything(look.ray.direction);
        return out;
    }
    const PreviewHit& hit = *look.hit;
    const double pixel_size = 2.0 * tangent_ * hit.distance / options_.height;
    const double facing = std::max(0.05, std::fabs(dot(hit.face, look.ray.direction)));
    out.normal = hit.normal;
    out.albedo = surface_color(hit);
    out.distance = hit.distance;
    out.slope = pixel_size / facing;
    if (!is_one_of_few) return out;
    const double rise = 0.5 + 0.5 * dot(hit.normal, light_.up);
    const Vec3 sky = (1.0 - rise) * light_.sky_colors.below + rise * light_.sky_colors.zenith;
    const double left = hit.kind == PreviewHit::Kind::plane ? nearness(hit) : 1.0;
    out.own = left * (hit.emission + times(out.albedo, look.sun)) + (1.0 - left) * horizon_;
    out.plain = left * times(out.albedo, sky);
    return out;
}

std::optional<Vec3> Painter::sun_middle() const { return light_.has_sun() ? std::optional(sun_middle_) : std::nullopt; }

void Painter::quick_pixels(std::span<const PixelPlace> places, std::span<PixelLight> out,
                           std::span<const SphereFind> finds, const SunShadows* shadows) const {
    std::array<PreviewRay, kPacketRays> room;
    std::array<std::optional<PreviewHit>, kPacketRays> hits;
    std::array<SunAsk, kPacketRays> asks;
    const std::span rays(room.data(), places.size());
    for (std::size_t k = 0; k < places.size(); ++k) {
        rays[k] = camera_ray(places[k].x + 0.5, places[k].y + 0.5, {});
        rays[k].time = 1.0;
    }
    trace_quickly(rays, std::span(hits.data(), places.size()), finds);
    for (std::size_t k = 0; k < places.size(); ++k) {
        asks[k].hit = hits[k] ? &*hits[k] : nullptr;
        asks[k].to_sun = sun_middle_;
    }
    ask_sun(std::span(asks.data(), places.size()), shadows);
    for (std::size_t k = 0; k < places.size(); ++k) {
        const PreviewHit* const hit = asks[k].hit;
        const bool open = options_.transparent && hit == nullptr;
        const Vec3 behind = open             ? Vec3{}
                            : hit == nullptr ? behind_everything(rays[k].direction)
                                             : quick_light(*hit, asks[k].light);
        const Seen shown = through_glass(rays[k], hit == nullptr ? kNothing : hit->distance, behind);
        out[k].light = tone_mapped(options_.exposure * shown.light);
        out[k].alpha = open ? shown.cover : 1.0;
    }
}

// The first thing on each ray, of what is told of spheres and what rays find.
void Painter::trace_quickly(std::span<PreviewRay> rays, std::span<std::optional<PreviewHit>> hits,
                            std::span<const SphereFind> finds) const {
    if (finds.empty()) {
        preview_.trace(rays, hits);
        return;
    }
    for (std::size_t k = 0; k < rays.size(); ++k) rays[k].reach = finds[k].distance;
    preview_.trace(rays, hits, SphereRays::left_out);
    for (std::size_t k = 0; k < rays.size(); ++k) {
        rays[k].reach = kNothing;
        const double distance = hits[k] ? hits[k]->distance : kNothing;
        if (finds[k].distance < distance) hits[k].emplace(sphere_hit(finds[k], rays[k]));
    }
}

PreviewHit Painter::sphere_hit(const SphereFind& find, const PreviewRay& ray) const {
    const Vec3 point = ray.origin + find.distance * ray.direction;
    return preview_.sphere_hit(find.sphere, find.distance, normalized(point - preview_.spheres().centers[find.sphere]),
                               ray);
}

PreviewRay Painter::camera_ray(double x, double y, const SamplePair& lens) const {
    const double across = (2.0 * x - options_.width) * half_pixel_;
    const double along = (options_.height - 2.0 * y) * half_pixel_;
    const Vec3 ahead = frame_.forward + across * frame_.right + along * frame_.up;
    if (!(camera_.aperture > 0.0)) return {camera_.position, (1.0 / length(ahead)) * ahead};
    const DiscPoint at = on_disc(lens);
    const Vec3 offset = 0.5 * camera_.aperture * (at.x * frame_.right + at.y * frame_.up);
    return {camera_.position + offset, normalized(focus_ * ahead - offset)};
}

Vec3 Painter::behind_everything(const Vec3& direction) const {
    return options_.background ? *options_.background : light_.backdrop(direction);
}

void Painter::trace(std::span<Look> looks) const {
    std::array<PreviewRay, kPacketRays> rays;
    std::array<std::optional<PreviewHit>, kPacketRays> hits;
    for (std::size_t k = 0; k < looks.size(); ++k) rays[k] = looks[k].ray;
    preview_.trace(std::span(rays.data(), looks.size()), std::span(hits.data(), looks.size()));
    for (std::size_t k = 0; k < looks.size(); ++k) looks[k].hit = hits[k];
}

// The light from behind, tinted and covered by the glass surfaces in front of it. Glass covers more where it is seen at
// a slant, which draws its outline.
Painter::Seen Painter::through_glass(PreviewRay ray, double distance, const Vec3& behind) const {
    constexpr int kMostSurfaces = 8;
    if (!has_glass_) return {behind, 0.0};
    Vec3 light;
    double open = 1.0;
    for (int k = 0; k < kMostSurfaces; ++k) {
        const std::optional<PreviewHit> glass = preview_.trace_glass(ray);
        if (!glass || glass->distance >= distance) break;
        const double slant = 1.0 - std::fabs(dot(glass->normal, ray.direction));
        const double cover = 0.04 + 0.6 * slant * slant * slant;
        const double shade = 0.6 + 0.4 * std::fabs(dot(glass->normal, light_.to_sun));
        const Vec3 bright = light_.has_sun() ? light_.sun : light_.sky_colors.zenith;
        light += open * cover * shade * (times(glass->color, bright) + gloss(*glass, ray, true));
        open *= 1.0 - cover;
        PreviewHit beyond = *glass;
        beyond.face = -glass->face;
        const Vec3 next = off_surface(beyond);
        distance -= length(next - ray.origin);
        ray.origin = next;
    }
    return {light + open * behind, 1.0 - open};
}

Vec3 Painter::solid_light(const Look& look) const {
    if (!look.hit) return behind_everything(look.ray.direction);
    const PreviewHit& hit = *look.hit;
    const Vec3 color = surface_color(hit);
    Vec3 light = hit.emission + times(color, look.sun);
    light += times(color, look.sky);
    if (!lamps_.empty()) light += times(color, lamp_light(hit, look.get(SamplePurpose::lamp)));
    if (hit.roughness < 1.0) light += gloss(hit, look.ray, look.sun != Vec3{});
    return hit.kind == PreviewHit::Kind::plane ? faded(light, hit) : light;
}

// Without rays but the one to the sun.
Vec3 Painter::quick_light(const PreviewHit& hit, const Vec3& sun) const {
    constexpr double kOpenSky = 0.7;  // the part of the sky that is seen from a surface among others
    const Vec3 color = surface_color(hit);
    const Vec3 light = hit.emission + times(color, sun + kOpenSky * light_.sky(hit.normal));
    return hit.kind == PreviewHit::Kind::plane ? faded(light, hit) : light;
}

// Light of the sun on surfaces, unless something stands in between. Asks without a hit stay as they are.
void Painter::ask_sun(std::span<SunAsk> asks, const SunShadows* shadows) const {
    if (!light_.has_sun()) return;
    std::array<PreviewRay, kPacketRays> rays;
    std::array<std::size_t, kPacketRays> whose{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < asks.size(); ++k) {
        if (asks[k].hit == nullptr) continue;
        const PreviewHit& hit = *asks[k].hit;
        const double cosine = dot(hit.normal, asks[k].to_sun);
        if (cosine <= 0.0) continue;
        const Vec3 start = off_surface(hit) + hit.lift;
        if (shadows != nullptr && shadows->covers(start)) continue;
        asks[k].light = cosine * light_.sun;
        rays[count] = {start, asks[k].to_sun, hit.time};
        whose[count++] = k;
    }
    const SphereRays by_rays = shadows == nullptr ? SphereRays::met : SphereRays::left_out;
    const std::array<bool, kPacketRays> dark = preview_.occluded(std::span(rays.data(), count), by_rays);
    for (std::size_t j = 0; j < count; ++j) {
        if (dark[j]) asks[whose[j]].light = {};
    }
}

Vec3 Painter::sun_light(const PreviewHit& hit, const Vec3& to_sun) const {
    SunAsk ask{&hit, to_sun};
    ask_sun(std::span(&ask, 1));
    return ask.light;
}

void Painter::add_sun_light(std::span<Look> looks) const {
    if (!light_.has_sun()) return;
    std::array<SunAsk, kPacketRays> asks;
    for (std::size_t k = 0; k < looks.size(); ++k) {
        asks[k] = {};
        if (!looks[k].hit) continue;
        const SamplePair at = looks[k].get(SamplePurpose::sun);
        asks[k] = {&*looks[k].hit, light_.sun_direction(at.u, at.v)};
    }
    ask_sun(std::span(asks.data(), looks.size()));
    for (std::size_t k = 0; k < looks.size(); ++k) looks[k].sun = asks[k].light;
}

// Light from one direction of the sky, or from the sunlit surface that is seen instead of it.
void Painter::add_sky_light(std::span<Look> looks) const {
    std::array<std::optional<PreviewHit>, kPacketRays> others;
    std::array<SunAsk, kPacketRays> asks;
    for (std::size_t k = 0; k < looks.size(); ++k) {
        asks[k] = {};
        if (!looks[k].hit) continue;
        const PreviewHit& hit = *looks[k].hit;
        const SamplePair at = looks[k].get(SamplePurpose::sky);
        const Vec3 direction = cosine_direction(hit.normal, at.u, at.v);
        others[k] = preview_.trace({off_surface(hit) + hit.lift, direction, hit.time});
        looks[k].sky = others[k] ? Vec3{} : light_.sky(direction);
        if (!others[k] || !light_.has_sun()) continue;
        const SamplePair sun_at = looks[k].get(SamplePurpose::far_sun);
        asks[k] = {&*others[k], light_.sun_direction(sun_at.u, sun_at.v)};
    }
    ask_sun(std::span(asks.data(), looks.size()));
    constexpr Vec3 kFarSky{0.22, 0.25, 0.30};  // stands for all further bounces
    for (std::size_t k = 0; k < looks.size(); ++k) {
        if (!looks[k].hit || !others[k]) continue;
        looks[k].sky = others[k]->emission + times(others[k]->color, asks[k].light + light_.sky_brightness * kFarSky);
    }
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
    double within = 0.0;  // the lamp's part, 0..1: what is left of the number that chose it
    const Lamp* chosen = nullptr;
    for (const Lamp& lamp : lamps_) {
        const double part = given(lamp) * luminance(lamp.intensity);
        if (!(part > 0.0)) continue;
        chosen = &lamp;
        within = std::min(left / part, 1.0);
        left -= part;
        if (left < 0.0) break;
    }
    const Vec3 start = off_surface(hit) + hit.lift;
    const Vec3 way = point_of(*chosen, hit, within, at.v) - start;
    if (preview_.occluded({start, normalized(way), hit.time, length(way)})) return {};
    return chosen->intensity * (total / luminance(chosen->intensity));
}

// A highlight of the sky and its brightest part; on smooth surfaces of what is around.
Vec3 Painter::gloss(const PreviewHit& hit, const PreviewRay& ray, bool in_sun) const {
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
            around = other->emission +
                     times(other->color, sun_light(*other, light_.sun_direction(0.5, 0.5)) + light_.sky(other->normal));
            return fresnel * around;
        }
        around = behind_everything(mirrored);
    }
    return fresnel * (in_sun ? around + spot * light_.sun : around);
}

// Starting points of further rays stand off the surface by what single precision cannot tell apart.
Vec3 Painter::off_surface(const PreviewHit& hit) const {
    constexpr double kSinglePrecision = 2e-6;
    const double scale = std::max(max_abs(hit.point - preview_.origin()), hit.distance);
    return hit.point + kSinglePrecision * scale * hit.face;
}

// Planes carry, unless they are plain, a faint chequer that gives the eye a scale.
Vec3 Painter::surface_color(const PreviewHit& hit) const {
    if (hit.kind != PreviewHit::Kind::plane || hit.is_plain) return hit.color;
    const auto [u, v] = tangent_frame(hit.normal);
    const double cells = std::floor(dot(hit.point, u) / tile_) + std::floor(dot(hit.point, v) / tile_);
    const bool odd = cells - 2.0 * std::floor(0.5 * cells) > 0.5;
    return odd ? hit.color : hit.color * (1.0 - 0.10 * std::exp(-hit.distance / (12.0 * extent_)));
}

// Planes go on for ever; far away they turn into what is behind everything on the horizon.
Vec3 Painter::faded(const Vec3& light, const PreviewHit& hit) const {
    const double left = nearness(hit);
    return left * light + (1.0 - left) * horizon_;
}

// What is left of a plane's own look.
double Painter::nearness(const PreviewHit& hit) const {
    const double reach = hit.distance / (14.0 * extent_);
    return std::exp(-reach * reach);
}

}  // namespace ricochet
