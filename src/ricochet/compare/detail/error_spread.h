/// \file
/// How large a set of numbers is.
#pragma once

#include <vector>

#include "ricochet/compare/figures.h"

namespace ricochet::detail {

/// The middle one, or the mean of the middle two; kNoNumber of nothing.
[[nodiscard]] double median(std::vector<double> values);
/// The smallest value that at least this share (0..1) of all does not exceed (nearest rank); kNoNumber of nothing.
[[nodiscard]] double percentile(std::vector<double> values, double share);
/// Of errors >= 0; the root of the mean square is summed in the order given.
[[nodiscard]] ErrorSpread spread_of(const std::vector<double>& errors);

}  // namespace ricochet::detail
