/// \file
/// Measurements as text.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/measurement.h"

namespace ricochet::bench {

/// An array of objects, one a row; null where there is no number.
[[nodiscard]] std::string to_json(std::span<const Row> rows);

/// For a terminal: a header and one row each.
[[nodiscard]] std::vector<std::vector<std::string>> to_table(std::span<const Row> rows);

}  // namespace ricochet::bench
