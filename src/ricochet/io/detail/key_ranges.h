/// \file
/// Ranges that many keys of the scene format share.
#pragma once

#include "ricochet/core/tolerances.h"
#include "ricochet/io/detail/scene_keys.h"

namespace ricochet::detail {

inline constexpr Range kPositive{.lower = 0.0, .lower_open = true};
inline constexpr Range kNotNegative{.lower = 0.0};
inline constexpr Range kCoordinate{.lower = -kLargestCoordinate, .upper = kLargestCoordinate};
inline constexpr Range kLength{.lower = 0.0, .upper = kLargestCoordinate, .lower_open = true};
inline constexpr Range kCount{.lower = 0.0, .upper = 4294967295.0};

}  // namespace ricochet::detail
