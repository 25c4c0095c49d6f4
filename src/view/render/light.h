/// \file
/// Lightings of a picture: a sun or lamp, and a sky. Colours are linear light. The picture's exposure multiplies all
/// brightness.
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"
#include "view/render/camera.h"
#include "view/render/sampling.h"

namespace ricochet {

/// Lighting presets by name.
enum class Lighting {
    day,       ///< a sun at middle height, to the left of the camera and behind it
    noon,      ///< a high white sun with hard shadows, and a deep blue sky
    overcast,  ///< a bright grey sky without a sun, with soft shadows from above
    night,     ///< dark, with faint moonlight
    studio,    ///< one large lamp, dim and even light from all sides, and a grey background
};

[[nodiscard]] std::optional<Lighting> lighting_from_name(std::string_view name);
/// Returns all names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string_view> lighting_names();

/// Sky colours at the zenith, at the horizon and below it. Colours at other heights are blended.
struct SkyColors {
    Vec3 zenith, horizon, below;
    double rise = 0.6;  ///< exponent of the sine of the elevation in the blend from horizon to zenith
    double fall = 2.5;  ///< slope of the blend from horizon to `below`

    /// Returns the colour at a height in -1..1, which is the sine of the elevation above the horizon.
    [[nodiscard]] Vec3 at(double height) const;
};

/// Sun and sky of a picture.
struct Light {
    Vec3 up{0, 0, 1};
    Vec3 to_sun{0, 0, 1};         ///< of unit length
    Vec3 sun{3.4, 2.98, 2.42};    ///< light that a surface facing the sun receives; zero: no sun
    double sky_brightness = 1.0;  ///< factor for the light of second and further bounces
    SkyColors sky_colors;         ///< light that surfaces receive from the sky
    SkyColors backdrop_colors;    ///< colours of the visible background
    /// Tangent of the sun's angular radius; larger than the real sun's for softer shadows.
    double sun_size = 0.025;

    /// Returns the sky's light from a direction in which nothing occludes the sky.
    [[nodiscard]] Vec3 sky(const Vec3& direction) const { return sky_colors.at(dot(direction, up)); }
    /// Returns the colour of the visible background in a direction. The background is brighter than the sky's light
    /// from that direction, and pale below the horizon.
    [[nodiscard]] Vec3 backdrop(const Vec3& direction) const { return backdrop_colors.at(dot(direction, up)); }
    [[nodiscard]] bool has_sun() const { return sun != Vec3{}; }
};

/// Disc of the sun, prepared for sampling many directions.
class SunDisc {
public:
    explicit SunDisc(const Light& light);
    /// Returns the unit direction to a point of the disc. u and v are in 0..1.
    [[nodiscard]] Vec3 direction(double u, double v) const {
        const DiscPoint at = on_disc({u, v});
        const Vec3 spread = middle_ + at.x * across_ + at.y * along_;
        return (1.0 / length(spread)) * spread;
    }

private:
    Vec3 middle_, across_, along_;
};

/// Returns the light of a preset. The direction to the sun depends on the camera.
[[nodiscard]] Light light_for(Lighting lighting, const Camera& camera);

/// Returns a unit direction around the normal (its length is accurate to 1e-8). For uniform u and v in 0..1, the
/// density of the directions is proportional to the cosine of the angle to the normal.
[[nodiscard]] inline Vec3 cosine_direction(const Vec3& normal, double u, double v) {
    const auto [first, second] = tangent_frame(normal);
    const DiscPoint at = on_disc({u, v});
    const double height = std::sqrt(std::max(0.0, 1.0 - u));
    return at.x * first + at.y * second + height * normal;
}

}  // namespace ricochet
