/// \file
/// Colour maps, and conversion between sRGB and linear light.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Colour maps by name. All maps except turbo are perceptually uniform.
/// Sources: viridis, plasma, inferno and magma by S. van der Walt and N. Smith (2015, CC0), turbo by A. Mikhailov
/// (2019). Each map is sampled at nine knots.
enum class ColorMap { viridis, plasma, turbo, inferno, magma };

[[nodiscard]] std::optional<ColorMap> color_map_from_name(std::string_view name);
/// Returns all names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string_view> color_map_names();

/// Returns the colour of the map at t, in linear light. Values outside 0..1 are clamped. NaN gives a neutral grey.
[[nodiscard]] Vec3 map_color(ColorMap map, double t);

/// Converts a channel value in 0..1 from sRGB to linear light. srgb_from_linear() is the inverse.
[[nodiscard]] double linear_from_srgb(double value);
[[nodiscard]] double srgb_from_linear(double value);

/// An interval of values.
struct ValueRange {
    double low = 0.0;
    double high = 1.0;
};
/// Returns the range from the 1st to the 99th percentile of the finite values, so that outliers do not compress the
/// colours. If these percentiles are equal, the range is widened slightly. An empty list gives [0, 1].
[[nodiscard]] ValueRange robust_range(std::vector<double> values);

}  // namespace ricochet
