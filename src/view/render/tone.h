/// \file
/// Tone mapping: conversion of light to the display's range.
#pragma once

#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Returns the luminance of a colour in linear light (Rec. 709 primaries).
[[nodiscard]] inline double luminance(const Vec3& light) {
    return 0.2126 * light.x + 0.7152 * light.y + 0.0722 * light.z;
}

/// Returns the product of two colours, channel by channel, for example of light and of the surface that reflects it.
[[nodiscard]] inline Vec3 times(const Vec3& a, const Vec3& b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }

/// Maps light to the display's range. The luminance L becomes L (1 + L / white^2) / (1 + L), and the hue is preserved.
/// Method: E. Reinhard et al., "Photographic Tone Reproduction for Digital Images", SIGGRAPH 2002, eq. 4.
[[nodiscard]] inline Vec3 tone_mapped(const Vec3& light) {
    constexpr double kWhite = 3.0;
    const double bright = luminance(light);
    if (!(bright > 0.0)) return {};
    return light * ((1.0 + bright * (1.0 / (kWhite * kWhite))) / (1.0 + bright));
}

/// Returns the sRGB channel, 0..255, of a value in linear light.
[[nodiscard]] std::uint8_t display_channel(double linear);

}  // namespace ricochet
