/// \file
/// Range checks on shape parameters.
#pragma once

#include <string_view>

namespace ricochet::meshes {

/// Lengths in metres: large and small enough for any scene, far from the ends of double precision.
inline constexpr double kShortest = 1e-6;
inline constexpr double kLongest = 1e6;

/// Throws InputError when a value is outside [lowest, highest] (or not a number), naming the option as the user typed
/// it.
void require_between(std::string_view shape, std::string_view option, double value, double lowest, double highest);
void require_between(std::string_view shape, std::string_view option, int value, int lowest, int highest);

/// The same for [kShortest, kLongest].
void require_length(std::string_view shape, std::string_view option, double value);

}  // namespace ricochet::meshes
