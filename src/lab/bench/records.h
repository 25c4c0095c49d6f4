/// \file
/// Results and their environment as named fields, JSON, CSV and tables. docs/bench.md lists the names.
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

// Environment of a measurement: machine, compiler, libraries.

struct Environment {
    std::string machine;  ///< machine_slug()
    std::string cpu;      ///< model name that the processor reports
    int hardware_threads = 0;
    std::string compiler;     ///< with its version
    std::string build_type;   ///< CMake's
    std::string build_flags;  ///< the compiler's, without warning flags
    std::string ray_library;
    std::string thread_library;
    std::string date;  ///< UTC, as in 2024-05-31T18:00:00Z
    std::string ricochet;
};

/// Returns a folder name for machines of the same kind, as in "xeon-platinum-8488c-2t". It contains the processor's
/// model in small letters, digits and hyphens, and the number of its threads. Words that all models of a maker share
/// are left out.
[[nodiscard]] std::string machine_slug(std::string_view cpu, int hardware_threads);

/// Returns the present environment. `version` is that of ricochet.
[[nodiscard]] Environment this_environment(std::string_view version);

/// A value; std::monostate if there is none.
using Cell = std::variant<std::monostate, std::string, std::uint64_t, double>;

struct Field {
    std::string_view name;
    Cell value;
};

/// The fields of one row, always in the same order.
using Record = std::vector<Field>;

[[nodiscard]] Record record_of(const Row& row);
/// Returns the same fields, empty if they do not apply to files, followed by the fields of files.
[[nodiscard]] Record record_of(const LoadRow& row);
/// Returns fields that are appended to the fields of a row.
[[nodiscard]] Record record_of(const Environment& environment);

/// Returns an array with one object per record. Values that are missing or not finite are null.
[[nodiscard]] std::string to_json(std::span<const Record> records);

/// Returns a header and one line per record (RFC 4180). Cells are empty for values that are null in JSON. All records
/// must have the same fields.
[[nodiscard]] std::string to_csv(std::span<const Record> records);

// Measurements as tables for a terminal: a header and one line per row.

using Table = std::vector<std::vector<std::string>>;

/// Returns a table. Columns that only some suites use are left out if no row has a number.
[[nodiscard]] Table to_table(std::span<const Row> rows);
[[nodiscard]] Table to_table(std::span<const LoadRow> rows);
[[nodiscard]] Table to_table(std::span<const RatioChange> changes);

}  // namespace ricochet::bench
