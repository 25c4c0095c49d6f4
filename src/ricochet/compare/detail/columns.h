/// \file
/// The columns of a comparison's table, as compare.json and compare.csv name them.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "ricochet/compare/comparison.h"

namespace ricochet::detail {

/// Text, a count, or a number that may be none (not finite).
using Cell = std::variant<std::string, std::uint64_t, double>;

struct Column {
    const char* name;  ///< those that begin with `cost_` differ from one comparison to the next
    Cell (*cell)(const ComparisonRow& row, const Comparison& comparison);
};

/// In the order in which they are written. docs/compare.md says what each means.
[[nodiscard]] const std::vector<Column>& comparison_columns();

/// Place of a column by its name, from 0. Throws std::invalid_argument for a name that is none.
[[nodiscard]] std::size_t column_index(const std::string& name);
/// A cell as a number; kNoNumber for text.
[[nodiscard]] double number_of(const Cell& cell);
/// A state's hash as reports print it.
[[nodiscard]] std::string hash_text(std::uint64_t hash);

}  // namespace ricochet::detail
