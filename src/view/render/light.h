/// \file
/// Lightings of a picture: a sun or lamp, and a sky. Colours are linear light. Brightness is in units of the picture's
/// exposure.
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
    day,       ///< a sun at middle height behind the camera's left shoulder
    noon,      ///< a high, white, hard sun under a deep blue sky
    overcast,  ///< a bright grey sky without a sun, with soft shadows from above
    night,     ///< dark, with faint moonlight
    studio,    ///< one large lamp and a dim, even room with a grey backdrop
};

[[nodiscard]] std::optional<Lighting> lighting_from_name(std::string_view name);
/// Returns all names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string_view> lighting_names();

/// Sky colours at three heights, interpolated between them.
struct SkyColors {
    Vec3 zenith, horizon, below;
    double rise = 0.6;  ///< exponent of the height's sine in the blend from horizon to zenith
    double fall = 2.5;  ///< slope of the blend from horizon to `below`

    /// Returns the colour at a height, given as the sine of the elevation above the horizon, in -1..1.
    [[nodiscard]] Vec3 at(double height) const;
};

/// Sun and sky of a picture.
struct Light {
    Vec3 up{0, 0, 1};
    Vec3 to_sun{0, 0, 1};         ///< of unit length
    Vec3 sun{3.4, 2.98, 2.42};    ///< light on a surface that faces the sun; zero: no sun
    double sky_brightness = 1.0;  ///< brightness of further bounces
    SkyColors sky_colors;         ///< light that surfaces receive from the sky
    SkyColors backdrop_colors;    ///< visible colours of the background
    double sun_size = 0.025;      ///< tangent of the sun's angular radius; larger than the real one for soft shadows

    /// Returns the light from an unoccluded direction.
    [[nodiscard]] Vec3 sky(const Vec3& direction) const { return sky_colors.at(dot(direction, up)); }
    /// Returns the visible background in a direction. It is brighter than the light from there, and pale below the
    /// horizon.
    [[nodiscard]] Vec3 backdrop(const Vec3& direction) const { return backdrop_colors.at(dot(direction, up)); }
    [[nodiscard]] bool has_sun() const { return sun != Vec3{}; }
};

/// The sun's disc, prepared for many sampled directions.
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

/// Returns the lighting preset for a camera.
[[nodiscard]] Light light_for(Lighting lighting, const Camera& camera);

/// Samples a direction around the normal with cosine-weighted density, of unit length to 1e-8. u and v are in 0..1.
[[nodiscard]] inline Vec3 cosine_direction(const Vec3& normal, double u, double v) {
    const auto [first, second] = tangent_frame(normal);
    const DiscPoint at = on_disc({u, v});
    const double height = std::sqrt(std::max(0.0, 1.0 - u));
    return at.x * first + at.y * second + height * normal;
}

}  // namespace ricochet
