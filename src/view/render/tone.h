/// \file
/// From light to the display's range.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Brightness to the eye of a linear colour.
[[nodiscard]] inline double luminance(const Vec3& light) {
    return 0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z;
}

/// Channel by channel: what a surface of one colour sends of light of the other.
[[nodiscard]] inline Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// Brightness to display range: L (1 + L / white^2) / (1 + L) on the luminance, colours kept.
/// Method: E. Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, eq. 4.
[[nodiscard]] inline Vec3 tone_mapped(const Vec3& light) {
    constexpr double kWhite = 3.0;
    const double bright = luminance(light);
    if (!(bright > 0.0)) return {};
    return light * ((1.0 + bright * (1.0 / (kWhite * kWhite))) / (1.0 + bright));
}

/// sRGB channel of a linear value, 0..255.
[[nodiscard]] std::uint8_t display_channel(double linear);

}  // namespace ricochet
