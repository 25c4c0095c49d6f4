/// \file
/// Measurements as named fields, and these as JSON and CSV. docs/bench.md lists the names.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "bench/load_measurement.h"
#include "bench/measurement.h"

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

}  // namespace ricochet::bench
