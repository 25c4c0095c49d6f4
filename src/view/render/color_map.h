/// \file
/// Numbers as colours, and what colours mean between files and light.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Colour maps by name; all but turbo are even to the eye.
/// Sources: viridis, plasma, inferno and magma by S. van der Walt and N. Smith (2015, CC0), turbo by A. Mikhailov
/// (2019), each read off at nine knots.
enum class ColorMap { viridis, plasma, turbo, inferno, magma };

[[nodiscard]] std::optional<ColorMap> color_map_from_name(std::string_view name);
/// All names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string_view> color_map_names();

/// Linear-light colour of t; t below 0 or above 1 takes the end's colour, NaN a neutral grey.
[[nodiscard]] Vec3 map_color(ColorMap map, double t);

/// Linear-light value of an sRGB channel value in 0..1, and back.
[[nodiscard]] double linear_from_srgb(double value);
[[nodiscard]] double srgb_from_linear(double value);

/// An interval of values.
struct ValueRange {
    double low = 0.0;
    double high = 1.0;
};
/// From the 1st to the 99th hundredth of the finite values, so that a few strays do not take the colours from the rest.
/// Widened where all are equal; [0, 1] when there is none.
[[nodiscard]] ValueRange robust_range(std::vector<double> values);

}  // namespace ricochet
