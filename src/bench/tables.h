/// \file
/// Measurements as tables for a terminal: a header and one row each.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/load_measurement.h"
#include "bench/measurement.h"
#include "bench/ratios.h"

namespace ricochet::bench {

using Table = std::vector<std::vector<std::string>>;

/// Columns that have no number in any row are left out where only some suites have them.
[[nodiscard]] Table to_table(std::span<const Row> rows);
[[nodiscard]] Table to_table(std::span<const LoadRow> rows);
[[nodiscard]] Table to_table(std::span<const RatioChange> changes);

}  // namespace ricochet::bench
