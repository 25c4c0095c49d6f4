/// \file
/// The light of a picture: a sun and a sky. Colours are linear light; brightness is in units of the picture's exposure.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/render/camera.h"

namespace ricochet {

/// Sun and sky over a picture.
struct Daylight {
    Vec3 up{0, 0, 1};
    Vec3 to_sun{0, 0, 1};         ///< of unit length
    Vec3 sun{3.4, 2.98, 2.42};    ///< light on a surface that faces the sun
    double sky_brightness = 1.0;  ///< factor of what comes from the sky
    Vec3 backdrop_tint{1, 1, 1};  ///< factors of what the picture shows behind everything
    double sun_size = 0.025;  ///< tangent of half the sun's apparent size; larger than the real one for soft shadows

    /// Light from a direction with nothing in the way.
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

}  // namespace ricochet
