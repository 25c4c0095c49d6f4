/// \file
/// Measurements as named fields, and these as JSON and CSV. docs/bench.md lists the names.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bench/load.h"
#include "bench/measurement.h"
#include "bench/ratios.h"

namespace ricochet::bench {

/// A value; std::monostate where there is none.
using Cell = std::variant<std::monostate, std::string, std::uint64_t, double>;

struct Field {
    std::string_view name;
    Cell value;
};

/// The fields of one row, always in the same order.
using Record = std::vector<Field>;

[[nodiscard]] Record record_of(const Row& row);
/// The same fields, empty where files have none, and those of files.
[[nodiscard]] Record record_of(const LoadRow& row);

/// An array of objects, one a record; null where there is no value or it is not finite.
[[nodiscard]] std::string to_json(std::span<const Record> records);

/// A header and one line a record (RFC 4180), nothing where JSON has null. Records have the same fields.
[[nodiscard]] std::string to_csv(std::span<const Record> records);

// Measurements as tables for a terminal: a header and one row each.

using Table = std::vector<std::vector<std::string>>;

/// Columns that have no number in any row are left out where only some suites have them.
[[nodiscard]] Table to_table(std::span<const Row> rows);
[[nodiscard]] Table to_table(std::span<const LoadRow> rows);
[[nodiscard]] Table to_table(std::span<const RatioChange> changes);

}  // namespace ricochet::bench
