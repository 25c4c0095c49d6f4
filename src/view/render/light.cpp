#include "view/render/light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "view/render/tone.h"

namespace ricochet {
namespace {

constexpr std::array<std::string_view, 5> kNames = {"day", "noon", "overcast", "night", "studio"};

Vec3 mix(const Vec3& a, const Vec3& b, double t) { return (1.0 - t) * a + t * b; }

SkyColors scaled(const SkyColors& colors, const Vec3& tint) {
    return {times(colors.zenith, tint), times(colors.horizon, tint), times(colors.below, tint), colors.rise,
            colors.fall};
}

constexpr SkyColors kDaySky{{0.20, 0.36, 0.68}, {0.62, 0.70, 0.80}, {0.36, 0.34, 0.32}, 0.6, 2.5};
constexpr SkyColors kDayBackdrop{{0.60, 1.10, 2.10}, {2.30, 2.55, 2.80}, {1.70, 1.70, 1.68}, 0.7, 1.6};

// Returns the horizontal component of the direction of view, as a unit vector.
Vec3 ahead_of(const Camera& camera, const CameraFrame& frame) {
    const Vec3 ahead = frame.forward - dot(frame.forward, camera.up) * camera.up;
    return length(ahead) > 1e-6 ? normalized(ahead) : frame.up;
}

void set_noon(Light& light) {
    light.sun = {4.3, 4.15, 3.85};
    light.sun_size = 0.012;
    light.sky_colors = scaled(kDaySky, {0.8, 0.9, 1.1});
    light.backdrop_colors = {{0.28, 0.72, 2.0}, {1.75, 2.25, 2.9}, {1.5, 1.55, 1.6}, 0.55, 1.6};
}

void set_overcast(Light& light) {
    light.sun = {};
    light.sky_brightness = 1.6;
    light.sky_colors = {{2.0, 2.05, 2.15}, {1.15, 1.18, 1.22}, {0.34, 0.33, 0.32}, 0.8, 2.5};
    light.backdrop_colors = {{1.5, 1.58, 1.7}, {2.3, 2.36, 2.42}, {1.6, 1.6, 1.6}, 0.7, 1.6};
}

void set_night(Light& light) {
    light.sun = {0.10, 0.13, 0.20};
    light.sky_brightness = 0.05;
    light.sky_colors = scaled(kDaySky, {0.05, 0.05, 0.05});
    light.backdrop_colors = scaled(kDayBackdrop, {0.003, 0.0045, 0.008});
}

void set_studio(Light& light) {
    light.sun = {3.1, 3.0, 2.85};
    light.sun_size = 0.30;
    light.sky_brightness = 0.9;
    light.sky_colors = {{0.95, 0.97, 1.0}, {0.42, 0.42, 0.43}, {0.30, 0.29, 0.28}, 1.0, 2.5};
    light.backdrop_colors = {{0.30, 0.31, 0.33}, {0.62, 0.63, 0.65}, {0.95, 0.94, 0.93}, 0.5, 1.2};
}

}  // namespace

std::optional<Lighting> lighting_from_name(std::string_view name) {
    const auto found = std::find(kNames.begin(), kNames.end(), name);
    if (found == kNames.end()) return std::nullopt;
    return static_cast<Lighting>(found - kNames.begin());
}

std::vector<std::string_view> lighting_names() { return {kNames.begin(), kNames.end()}; }

Vec3 SkyColors::at(double height) const {
    if (height < 0.0) return mix(horizon, below, std::min(1.0, -fall * height));
    // Single precision takes a third of the time of double precision.
    return mix(horizon, zenith, std::pow(static_cast<float>(std::min(1.0, height)), static_cast<float>(rise)));
}

SunDisc::SunDisc(const Light& light) : middle_(light.to_sun) {
    const auto [first, second] = tangent_frame(light.to_sun);
    across_ = light.sun_size * first;
    along_ = light.sun_size * second;
}

Light light_for(Lighting lighting, const Camera& camera) {
    Light light;
    light.up = camera.up;
    light.sky_colors = kDaySky;
    light.backdrop_colors = kDayBackdrop;
    const CameraFrame frame = camera_frame(camera);
    const Vec3 ahead = ahead_of(camera, frame);
    light.to_sun = normalized(-0.78 * frame.right - 0.25 * ahead + 0.72 * camera.up);
    if (lighting == Lighting::noon) {
        set_noon(light);
        light.to_sun = normalized(-0.30 * frame.right - 0.18 * ahead + camera.up);
    } else if (lighting == Lighting::overcast) {
        set_overcast(light);
    } else if (lighting == Lighting::night) {
        set_night(light);
    } else if (lighting == Lighting::studio) {
        set_studio(light);
        light.to_sun = normalized(-0.55 * frame.right - 0.45 * ahead + 0.85 * camera.up);
    }
    return light;
}

}  // namespace ricochet
