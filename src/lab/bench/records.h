/// \file
/// What was measured and with what, as named fields, JSON, CSV and tables. docs/bench.md lists the names.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "lab/bench/load.h"
#include "lab/bench/measurement.h"
#include "lab/bench/ratios.h"

namespace ricochet::bench {

// What numbers were measured with: machine, compiler, libraries.

struct Environment {
    std::string machine;  ///< machine_slug()
    std::string cpu;      ///< as the processor calls itself
    int hardware_threads = 0;
    std::string compiler;     ///< with its version
    std::string build_type;   ///< CMake's
    std::string build_flags;  ///< the compiler's, without those for warnings
    std::string ray_library;
    std::string thread_library;
    std::string date;  ///< UTC, as in 2024-05-31T18:00:00Z
    std::string ricochet;
};

/// A name for machines of the same kind, fit for a folder: the processor's model in small letters, digits and hyphens,
/// and its threads, as in "xeon-platinum-8488c-2t". What every model of a maker says is left out.
[[nodiscard]] std::string machine_slug(std::string_view cpu, int hardware_threads);

/// Here and now. version: of ricochet.
[[nodiscard]] Environment this_environment(std::string_view version);

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
/// To be appended to those of a row.
[[nodiscard]] Record record_of(const Environment& environment);

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
