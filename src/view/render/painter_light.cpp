// Light from surfaces: sun, sky and lamps, glass, and highlights.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "view/render/painter.h"
#include "view/render/tone.h"

namespace ricochet {
namespace {

constexpr double kMirror = 0.3;  // roughness below which surfaces reflect their surroundings

// Returns a point of the lamp's disc, which is perpendicular to the line from the hit to the lamp. The point is in
// front of the surface. u and v are in 0..1.
Vec3 point_of(const Lamp& lamp, const PreviewHit& hit, double u, double v) {
    const Vec3 to_light = lamp.position - hit.point;
    const auto [a, b] = tangent_frame(normalized(to_light));
    const DiscPoint at = on_disc({u, v});
    const Vec3 off = std::min(lamp.radius, 0.5 * length(to_light)) * (at.x * a + at.y * b);
    return dot(hit.normal, to_light + off) > 0.0 ? lamp.position + off : lamp.position - off;
}

}  // namespace

// Returns the light `behind`, partly covered by the glass surfaces on the ray. Glass covers more at a grazing angle,
// which makes its outline visible.
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

Vec3 Painter::solid_light(const SampleState& state) const {
    if (!state.hit) return behind_everything(state.ray.direction);
    const PreviewHit& hit = *state.hit;
    Vec3 light = hit.emission + times(state.color, state.sun + state.sky);
    if (!lamps_.empty()) light += times(state.color, lamp_light(hit, state.get(SamplePurpose::lamp)));
    if (hit.roughness < 1.0) light += gloss(hit, state.ray, state.sun != Vec3{});
    return faded(light, state.left);
}

// Returns the light of a surface for a draft. `sun` is the sun's light on the surface. No rays are traced.
Vec3 Painter::quick_light(const PreviewHit& hit, const Vec3& sun) const {
    constexpr double kOpenSky = 0.7;  // assumed share of the sky that other surfaces do not occlude
    const Vec3 color = surface_color(hit);
    const Vec3 light = hit.emission + times(color, sun + kOpenSky * light_.sky(hit.normal));
    return hit.kind == PreviewHit::Kind::plane ? faded(light, nearness(hit)) : light;
}

// Computes the sun's light on surfaces, with shadows. Queries without a hit are skipped.
void Painter::query_sun(std::span<SunQuery> queries, const SunShadows* shadows) const {
    if (!light_.has_sun()) return;
    std::array<PreviewRay, kPacketRays> rays;
    std::array<std::size_t, kPacketRays> whose{};
    std::size_t count = 0;
    for (std::size_t k = 0; k < queries.size(); ++k) {
        if (queries[k].hit == nullptr) continue;
        const PreviewHit& hit = *queries[k].hit;
        const double cosine = dot(hit.normal, queries[k].to_sun);
        if (cosine <= 0.0) continue;
        const Vec3 start = off_surface(hit) + hit.lift;
        if (shadows != nullptr && shadows->is_shadowed(start, queries[k].to_sun)) continue;
        queries[k].light = cosine * light_.sun;
        rays[count] = {start, queries[k].to_sun, hit.time};
        whose[count++] = k;
    }
    const SphereRays by_rays = shadows == nullptr ? SphereRays::traced : SphereRays::skipped;
    const std::array<bool, kPacketRays> dark = preview_.occluded(std::span(rays.data(), count), by_rays);
    for (std::size_t j = 0; j < count; ++j) {
        if (dark[j]) queries[whose[j]].light = {};
    }
}

Vec3 Painter::sun_light(const PreviewHit& hit, const Vec3& to_sun) const {
    SunQuery query{&hit, to_sun};
    query_sun(std::span(&query, 1));
    return query.light;
}

// Returns true if any part of the sun is on the visible side of the surface.
bool Painter::faces_sun(const PreviewHit& hit) const {
    return light_.has_sun() && dot(hit.normal, sun_middle_) > -light_.sun_size;
}

void Painter::add_sun_light(std::span<SampleState> states, const SunShadows* shadows) const {
    if (!light_.has_sun()) return;
    std::array<SunQuery, kPacketRays> queries;
    for (std::size_t k = 0; k < states.size(); ++k) {
        queries[k] = {};
        if (!states[k].hit || !faces_sun(*states[k].hit)) continue;
        const SamplePair at = states[k].get(SamplePurpose::sun);
        queries[k] = {states[k].hit, sun_.direction(at.u, at.v)};
    }
    query_sun(std::span(queries.data(), states.size()), shadows);
    for (std::size_t k = 0; k < states.size(); ++k) states[k].sun = queries[k].light;
}

// Adds the sky's light from one sampled direction. If a surface occludes the sky in this direction, the light of this
// surface is added instead.
void Painter::add_sky_light(std::span<SampleState> states, const SunShadows* shadows) const {
    std::array<std::optional<PreviewHit>, kPacketRays> others;
    std::array<PreviewRay, kPacketRays> rays;
    std::array<SampleState*, kPacketRays> whose;
    std::array<SunQuery, kPacketRays> queries;
    std::size_t count = 0;
    for (SampleState& state : states) {
        if (!state.hit) continue;
        const SamplePair at = state.get(SamplePurpose::sky);
        rays[count] = {off_surface(*state.hit) + state.hit->lift, cosine_direction(state.hit->normal, at.u, at.v),
                       state.hit->time};
        whose[count++] = &state;
    }
    // Glowing lines are excluded, because lamps already represent their light.
    preview_.trace(std::span(rays.data(), count), std::span(others.data(), count), SphereRays::traced,
                   GlowRays::skipped);
    for (std::size_t k = 0; k < count; ++k) {
        queries[k] = {};
        if (!others[k]) {
            whose[k]->sky = light_.sky(rays[k].direction);
        } else if (faces_sun(*others[k])) {
            const SamplePair sun_at = whose[k]->get(SamplePurpose::far_sun);
            queries[k] = {&*others[k], sun_.direction(sun_at.u, sun_at.v)};
        }
    }
    query_sun(std::span(queries.data(), count), shadows);
    constexpr Vec3 kFarSky{0.22, 0.25, 0.30};  // assumed light on the other surface, without sunlight
    for (std::size_t k = 0; k < count; ++k) {
        if (!others[k]) continue;
        whose[k]->sky =
            others[k]->emission + times(others[k]->color, queries[k].light + light_.sky_brightness * kFarSky);
    }
}

// Returns an estimate of the light of all lamps from one sampled lamp. The probability of a lamp is proportional to its
// unoccluded light.
Vec3 Painter::lamp_light(const PreviewHit& hit, const SamplePair& at) const {
    const auto given = [&](const Lamp& lamp) {
        const Vec3 to_light = lamp.position - hit.point;
        const double distance = std::max(length(to_light), lamp.radius);
        return std::max(0.0, dot(hit.normal, to_light)) / (distance * distance * distance);
    };
    double total = 0.0;
    for (const Lamp& lamp : lamps_) total += given(lamp) * luminance(lamp.intensity);
    if (!(total > 0.0)) return {};
    double left = at.u * total;
    // Second random number, 0..1: position of the first random number within the chosen lamp's share.
    double within = 0.0;
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
    const Vec3 to_light = point_of(*chosen, hit, within, at.v) - start;
    if (preview_.occluded({start, normalized(to_light), hit.time, length(to_light)})) return {};
    return chosen->intensity * (total / luminance(chosen->intensity));
}

// Returns the mirrored light of the sky and the sun. Surfaces with a roughness below kMirror reflect other surfaces
// too.
Vec3 Painter::gloss(const PreviewHit& hit, const PreviewRay& ray, bool in_sun) const {
    const double facing = -dot(hit.normal, ray.direction);
    const Vec3 mirrored = ray.direction + 2.0 * facing * hit.normal;
    const double grazing = 1.0 - std::clamp(facing, 0.0, 1.0);
    const double smooth = 1.0 - hit.roughness;
    const double grazing2 = grazing * grazing;
    const double fresnel =
        0.04 + 0.5 * grazing2 * grazing2 * grazing * std::min(1.0, smooth / (1.0 - kSphereRoughness));
    // The highlight is a power of a cosine. The power is derived from the width of a Beckmann distribution (B. Walter
    // et al., EGSR 2007).
    const double width = std::max(0.02, hit.roughness * hit.roughness);
    const double power = std::max(1.0, 2.0 / (width * width) - 2.0);
    Vec3 around = 0.5 * light_.sky(mirrored);
    if (hit.roughness < kMirror) {
        if (const auto other = preview_.trace({off_surface(hit) + hit.lift, mirrored, hit.time})) {
            around = other->emission +
                     times(other->color, sun_light(*other, sun_.direction(0.5, 0.5)) + light_.sky(other->normal));
            return fresnel * around;
        }
        around = behind_everything(mirrored);
    }
    if (in_sun) {
        constexpr double kDark = 30.0;  // highlights below exp(-kDark) are invisible
        const double peak = std::max(0.0, dot(mirrored, light_.to_sun));
        const double shine = power * (1.0 - peak) < kDark ? std::pow(peak, power) : 0.0;
        around += 4.0 * shine * std::clamp(std::sqrt(power / 60.0), 0.1, 8.0) * light_.sun;
    }
    return fresnel * around;
}

// Returns the origin of secondary rays. The origin is offset from the surface by the rounding error of single
// precision.
Vec3 Painter::off_surface(const PreviewHit& hit) const {
    constexpr double kSinglePrecision = 2e-6;
    const double scale = std::max(max_abs(hit.point - preview_.origin()), hit.distance);
    return hit.point + kSinglePrecision * scale * hit.face;
}

// Returns the colour of a surface. Planes have a faint chequer that shows the scale, unless they are plain.
Vec3 Painter::surface_color(const PreviewHit& hit) const {
    if (hit.kind != PreviewHit::Kind::plane || hit.is_plain) return hit.color;
    const auto [u, v] = tangent_frame(hit.normal);
    const double cells = std::floor(dot(hit.point, u) / tile_) + std::floor(dot(hit.point, v) / tile_);
    const bool odd = cells - 2.0 * std::floor(0.5 * cells) > 0.5;
    return odd ? hit.color : hit.color * (1.0 - 0.10 * std::exp(-hit.distance / (12.0 * extent_)));
}

// Blends light with the background at the horizon. `left` is the share of the light. Planes are infinite and fade out
// with distance.
Vec3 Painter::faded(const Vec3& light, double left) const { return left * light + (1.0 - left) * horizon_; }

// Returns the share of a plane's own colour that remains at its distance.
double Painter::nearness(const PreviewHit& hit) const {
    const double reach = hit.distance / (14.0 * extent_);
    return std::exp(-reach * reach);
}

}  // namespace ricochet
