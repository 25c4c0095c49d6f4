/// \file
/// Range checks on shape parameters.
#pragma once

#include <string_view>

namespace ricochet::meshes {

/// Range of lengths, in metres: wide enough for any scene, and far from the limits of double precision.
inline constexpr double kShortest = 1e-6;
inline constexpr double kLongest = 1e6;

/// Throws InputError, naming the option, if a value is outside [lowest, highest] or not a number.
void require_between(std::string_view shape, std::string_view option, double value, double lowest, double highest);
void require_between(std::string_view shape, std::string_view option, int value, int lowest, int highest);

/// Throws InputError if a value is outside [kShortest, kLongest].
void require_length(std::string_view shape, std::string_view option, double value);

}  // namespace ricochet::meshes
