/// \file
/// The lights that a picture can be taken in: a sun or lamp, and a sky. Colours are linear light; brightness is in
/// units of the picture's exposure.
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

/// Lights by name.
enum class Lighting {
    day,       ///< a sun at middling height behind the camera's left shoulder
    noon,      ///< a high, white, hard sun under a deep blue sky
    overcast,  ///< a bright grey sky without a sun: soft shadows from above
    night,     ///< dark, with a little moonlight
    studio,    ///< one large lamp and a dim, even room with a grey backdrop
};

[[nodiscard]] std::optional<Lighting> lighting_from_name(std::string_view name);
/// All names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string_view> lighting_names();

/// Colours at three heights, mixed between them.
struct SkyColors {
    Vec3 zenith, horizon, below;
    double rise = 0.6;  ///< power of the height's sine by which horizon turns into zenith
    double fall = 2.5;  ///< slope by which it turns into what is below

    /// height: sine of the angle over the horizon, -1..1.
    [[nodiscard]] Vec3 at(double height) const;
};

/// Sun and sky over a picture.
struct Light {
    Vec3 up{0, 0, 1};
    Vec3 to_sun{0, 0, 1};         ///< of unit length
    Vec3 sun{3.4, 2.98, 2.42};    ///< light on a surface that faces the sun; zero: there is none
    double sky_brightness = 1.0;  ///< of the light that further bounces bring
    SkyColors sky_colors;         ///< light that comes from the sky
    SkyColors backdrop_colors;    ///< what the picture shows behind everything
    double sun_size = 0.025;  ///< tangent of half the sun's apparent size; larger than the real one for soft shadows

    /// Light from a direction that nothing blocks.
    [[nodiscard]] Vec3 sky(const Vec3& direction) const { return sky_colors.at(dot(direction, up)); }
    /// What the picture shows behind everything: brighter than the light that comes from there, and pale below.
    [[nodiscard]] Vec3 backdrop(const Vec3& direction) const { return backdrop_colors.at(dot(direction, up)); }
    [[nodiscard]] bool has_sun() const { return sun != Vec3{}; }
};

/// The sun's disc, for many directions to it.
class SunDisc {
public:
    explicit SunDisc(const Light& light);
    /// To a point of the disc; u and v in 0..1.
    [[nodiscard]] Vec3 direction(double u, double v) const {
        const DiscPoint at = on_disc({u, v});
        const Vec3 way = middle_ + at.x * across_ + at.y * along_;
        return (1.0 / length(way)) * way;
    }

private:
    Vec3 middle_, across_, along_;
};

/// The light of that name about a camera.
[[nodiscard]] Light light_for(Lighting lighting, const Camera& camera);

/// A direction about the normal with the density of the cosine law, of unit length to 1e-8; u and v in 0..1.
[[nodiscard]] inline Vec3 cosine_direction(const Vec3& normal, double u, double v) {
    const auto [first, second] = tangent_frame(normal);
    const DiscPoint at = on_disc({u, v});
    const double height = std::sqrt(std::max(0.0, 1.0 - u));
    return at.x * first + at.y * second + height * normal;
}

}  // namespace ricochet
