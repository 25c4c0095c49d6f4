/// \file
/// From light to the display's range.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Brightness to display range: L (1 + L / white^2) / (1 + L) on the luminance, colours kept.
/// Method: E. Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, eq. 4.
[[nodiscard]] Vec3 tone_mapped(const Vec3& light);

/// sRGB channel of a linear value, 0..255.
[[nodiscard]] std::uint8_t display_channel(double linear);

/// Brightness to the eye of a linear colour.
[[nodiscard]] inline double luminance(const Vec3& light) {
    return 0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z;
}

}  // namespace ricochet
