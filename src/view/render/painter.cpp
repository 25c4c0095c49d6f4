#include "view/render/painter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "view/render/tone.h"

namespace ricochet {
namespace {

constexpr double kNothing = std::numeric_limits<double>::infinity();

}  // namespace

Painter::Painter(const Preview& preview, const Camera& camera, const PictureOptions& options, std::vector<Lamp> lamps)
    : preview_(preview),
      camera_(camera),
      frame_(camera_frame(camera)),
      options_(options),
      has_glass_(preview.has_glass()),
      light_(light_for(options.lighting, camera)),
      sun_(light_),
      lamps_(std::move(lamps)),
      sun_middle_(sun_.direction(0.0, 0.0)),
      horizon_(options.background ? *options.background : light_.backdrop_colors.horizon),
      tangent_(half_height(camera)),
      half_pixel_(tangent_ / options.height),
      focus_(camera.focus_distance > 0.0 ? camera.focus_distance : length(camera.target - camera.position)),
      extent_(tangent_ * length(camera.target - camera.position)),
      tile_(std::pow(10.0, std::floor(std::log10(0.4 * extent_)))) {}

void Painter::pixels(std::span<const PixelPosition> pixel_positions, std::span<PixelLight> out,
                     const KnownSpheres& known) const {
    std::array<std::optional<PixelSamples>, kPacketRays> samples;
    std::vector<PixelSum> sums(pixel_positions.size(), PixelSum(options_.exposure));
    std::array<SampleState, kPacketRays> room;
    Hits hits;
    const std::span states(room.data(), pixel_positions.size());
    for (std::size_t k = 0; k < pixel_positions.size(); ++k) {
        samples[k].emplace(pixel_positions[k].x, pixel_positions[k].y);
        states[k].samples = &*samples[k];
    }
    for (int s = 0; s < options_.samples; ++s) {
        for (std::size_t k = 0; k < pixel_positions.size(); ++k) aim(states[k], pixel_positions[k], s);
        trace(states, known, hits);
        add_sun_light(states, known.shadows);
        add_sky_light(states, known.shadows);
        for (std::size_t k = 0; k < pixel_positions.size(); ++k) add(states[k], sums[k]);
    }
    if (options_.samples < kMostPixelRays) add_extra_rays(pixel_positions, states, sums, known);
    for (std::size_t k = 0; k < pixel_positions.size(); ++k) out[k] = sums[k].mean();
}

// Sets the camera ray for a sample of a pixel.
void Painter::aim(SampleState& state, const PixelPosition& pixel_position, int sample) const {
    state.sample = sample;
    const SamplePair at = state.get(SamplePurpose::pixel);
    const SamplePair lens = camera_.aperture > 0.0 ? state.get(SamplePurpose::lens) : SamplePair{};
    state.ray = camera_ray(pixel_position.x + at.u, pixel_position.y + at.v, lens);
    state.ray.time = state.samples->time(sample);
}

// Returns the number of extra rays per pixel. A pixel gets extra rays if its samples differ or can have missed an
// outline. The other pixels of the tile get some rays too, because their samples can have missed small objects.
std::array<int, kPacketRays> Painter::rays_wanted(std::span<const PixelPosition> pixel_positions,
                                                  std::span<const PixelSum> sums, const KnownSpheres& known) const {
    constexpr int kBeside = 4;
    constexpr double kHalfDiagonal = 1.42;  // half the diagonal of a pixel, in units of half its edge
    std::array<bool, kPacketRays> outlines{};
    if (known.listed && !known.listed->empty()) {
        std::array<PreviewRay, kPacketRays> middles;
        for (std::size_t k = 0; k < pixel_positions.size(); ++k) {
            middles[k] = camera_ray(pixel_positions[k].x + 0.5, pixel_positions[k].y + 0.5, {});
            middles[k].reach = sums[k].farthest();
        }
        outlines = outlines_about(std::span(middles.data(), pixel_positions.size()), *known.listed,
                                  kHalfDiagonal * half_pixel_);
    }
    std::array<int, kPacketRays> wanted{};
    for (std::size_t k = 0; k < pixel_positions.size(); ++k) wanted[k] = sums[k].rays_wanted(outlines[k]);
    const int beside = std::min(kBeside, *std::max_element(wanted.begin(), wanted.end()));
    for (std::size_t k = 0; k < pixel_positions.size(); ++k) {
        if (!outlines[k]) wanted[k] = std::max(wanted[k], beside);
    }
    return wanted;
}

// Traces the extra camera rays of the pixels, with shadow rays to the sun, and adds the results to `sums`.
void Painter::add_extra_rays(std::span<const PixelPosition> pixel_positions, std::span<SampleState> states,
                             std::span<PixelSum> sums, const KnownSpheres& known) const {
    std::array<SampleState, kPacketRays> room;
    Hits hits;
    std::array<PixelSum*, kPacketRays> whose{};
    std::size_t count = 0;
    const auto trace_all = [&] {
        trace(std::span(room.data(), count), known, hits);
        add_sun_light(std::span(room.data(), count), known.shadows);
        for (std::size_t j = 0; j < count; ++j) whose[j]->add(camera_ray_result(room[j]));
        count = 0;
    };
    const std::array<int, kPacketRays> wanted = rays_wanted(pixel_positions, sums, known);
    for (std::size_t k = 0; k < pixel_positions.size(); ++k) {
        const int end = std::min(kMostPixelRays, options_.samples + wanted[k]);
        for (int s = options_.samples; s < end; ++s) {
            room[count].samples = states[k].samples;
            aim(room[count], pixel_positions[k], s);
            whose[count++] = &sums[k];
            if (count == kPacketRays) trace_all();
        }
    }
    if (count > 0) trace_all();
}

void Painter::add(const SampleState& state, PixelSum& sum) const {
    const bool open = options_.transparent && !state.hit;
    const Vec3 light = open ? Vec3{} : solid_light(state);
    const Seen seen = through_glass(state.ray, state.hit ? state.hit->distance : kNothing, light);
    sum.add(camera_ray_result(state), light, tone_mapped(options_.exposure * seen.light), open ? seen.cover : 1.0);
}

CameraRayResult Painter::camera_ray_result(const SampleState& state) const {
    CameraRayResult out;
    const bool is_one_of_few = options_.samples < kMostPixelRays;
    if (!state.hit) {
        out.covers = !options_.transparent;
        if (out.covers && is_one_of_few) out.own = behind_everything(state.ray.direction);
        return out;
    }
    const PreviewHit& hit = *state.hit;
    const double pixel_size = 2.0 * tangent_ * hit.distance / options_.height;
    const double facing = std::max(0.05, std::fabs(dot(hit.face, state.ray.direction)));
    out.normal = hit.normal;
    out.albedo = state.color;
    out.distance = hit.distance;
    out.surface = state.surface;
    out.slope = pixel_size / facing;
    if (!is_one_of_few) return out;
    const double rise = 0.5 + 0.5 * dot(hit.normal, light_.up);
    const Vec3 sky = (1.0 - rise) * light_.sky_colors.below + rise * light_.sky_colors.zenith;
    out.own = faded(hit.emission + times(out.albedo, state.sun), state.left);
    out.plain = state.left * times(out.albedo, sky);
    return out;
}

std::optional<Vec3> Painter::sun_middle() const { return light_.has_sun() ? std::optional(sun_middle_) : std::nullopt; }

void Painter::quick_pixels(std::span<const PixelPosition> pixel_positions, std::span<PixelLight> out,
                           std::span<const SphereFind> finds, const SunShadows* shadows) const {
    std::array<PreviewRay, kPacketRays> room;
    std::array<std::optional<PreviewHit>, kPacketRays> hits;
    std::array<SunQuery, kPacketRays> queries;
    const std::span rays(room.data(), pixel_positions.size());
    for (std::size_t k = 0; k < pixel_positions.size(); ++k) {
        rays[k] = camera_ray(pixel_positions[k].x + 0.5, pixel_positions[k].y + 0.5, {});
        rays[k].time = 1.0;
    }
    trace_besides(rays, std::span(hits.data(), pixel_positions.size()), finds);
    for (std::size_t k = 0; k < pixel_positions.size(); ++k) {
        queries[k].hit = hits[k] ? &*hits[k] : nullptr;
        queries[k].to_sun = sun_middle_;
    }
    query_sun(std::span(queries.data(), pixel_positions.size()), shadows);
    for (std::size_t k = 0; k < pixel_positions.size(); ++k) {
        const PreviewHit* const hit = queries[k].hit;
        const bool open = options_.transparent && hit == nullptr;
        const Vec3 behind = open             ? Vec3{}
                            : hit == nullptr ? behind_everything(rays[k].direction)
                                             : quick_light(*hit, queries[k].light);
        const Seen shown = through_glass(rays[k], hit == nullptr ? kNothing : hit->distance, behind);
        out[k].light = tone_mapped(options_.exposure * shown.light);
        out[k].alpha = open ? shown.cover : 1.0;
    }
}

// Finds the first hit of each ray, from the known spheres and from traced rays.
void Painter::trace_besides(std::span<PreviewRay> rays, std::span<std::optional<PreviewHit>> hits,
                            std::span<const SphereFind> finds) const {
    if (finds.empty()) {
        preview_.trace(rays, hits);
        return;
    }
    for (std::size_t k = 0; k < rays.size(); ++k) rays[k].reach = finds[k].distance;
    preview_.trace(rays, hits, SphereRays::skipped);
    for (std::size_t k = 0; k < rays.size(); ++k) {
        rays[k].reach = kNothing;
        const double distance = hits[k] ? hits[k]->distance : kNothing;
        if (finds[k].distance < distance) hits[k].emplace(sphere_hit(finds[k], rays[k]));
    }
}

// Returns the hit on a sphere. The normal points from the centre to the hit point. If the distance to the centre rounds
// to 0, the normal is opposite to the ray.
PreviewHit Painter::sphere_hit(const SphereFind& find, const PreviewRay& ray) const {
    const Vec3 outward = ray.origin - preview_.spheres().centers[find.sphere] + find.distance * ray.direction;
    const double size = length(outward);
    return preview_.sphere_hit(find.sphere, find.distance, size > 0.0 ? outward / size : -ray.direction, ray);
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

void Painter::trace(std::span<SampleState> states, const KnownSpheres& known, Hits& hits) const {
    std::array<PreviewRay, kPacketRays> rays;
    std::array<SphereFind, kPacketRays> finds;
    for (std::size_t k = 0; k < states.size(); ++k) rays[k] = states[k].ray;
    const std::span asked(rays.data(), states.size());
    const std::span found(finds.data(), known.listed ? states.size() : 0);
    if (known.listed) meet_spheres(*known.listed, asked, found);
    trace_besides(asked, std::span(hits.data(), states.size()), found);
    for (std::size_t k = 0; k < states.size(); ++k) {
        states[k].surface = 0;
        states[k].hit = hits[k] ? &*hits[k] : nullptr;
        if (!hits[k]) continue;
        const bool is_known = known.listed && finds[k].distance == hits[k]->distance;
        states[k].surface = is_known ? finds[k].sphere + 1 : 0;
        states[k].color = surface_color(*hits[k]);
        states[k].left = hits[k]->kind == PreviewHit::Kind::plane ? nearness(*hits[k]) : 1.0;
    }
}

}  // namespace ricochet
