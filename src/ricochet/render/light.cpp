#include "ricochet/render/light.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace ricochet {
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

}  // namespace ricochet
