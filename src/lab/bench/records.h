/// \file
/// Results and their environment as named fields, JSON, CSV and tables. docs/bench.md lists the names of the fields.
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
    std::string machine;  ///< name of the machine, see machine_slug()
    std::string cpu;      ///< model name of the processor
    int hardware_threads = 0;
    std::string compiler;     ///< name and version
    std::string build_type;   ///< build type of CMake
    std::string build_flags;  ///< flags of the compiler, without warning flags
    std::string ray_library;
    std::string thread_library;
    std::string date;  ///< UTC, as in 2024-05-31T18:00:00Z
    std::string ricochet;
};

/// Returns a folder name that is the same for machines of the same kind, such as "xeon-platinum-8488c-2t". The name
/// consists of the words of the processor's model in lower case, and of the number of threads. Words that all models of
/// a manufacturer share are left out.
[[nodiscard]] std::string machine_slug(std::string_view cpu, int hardware_threads);

/// Returns the current environment. `version` is the version of ricochet.
[[nodiscard]] Environment this_environment(std::string_view version);

/// Value of a field; std::monostate if there is no value.
using Cell = std::variant<std::monostate, std::string, std::uint64_t, double>;

struct Field {
    std::string_view name;
    Cell value;
};

/// Fields of one row. All rows have the same order of fields.
using Record = std::vector<Field>;

[[nodiscard]] Record record_of(const Row& row);
/// Returns all fields of a Row, followed by the fields that only measurements of mesh files have. Fields that do not
/// apply to mesh files are empty.
[[nodiscard]] Record record_of(const LoadRow& row);
/// Returns fields that callers append to the fields of a row.
[[nodiscard]] Record record_of(const Environment& environment);

/// Returns a JSON array with one object per record. Values that are missing or not finite are null.
[[nodiscard]] std::string to_json(std::span<const Record> records);

/// Returns a CSV text (RFC 4180) with a header and one line per record. Values that are missing or not finite become
/// empty cells. All records must have the same fields.
[[nodiscard]] std::string to_csv(std::span<const Record> records);

// Measurements as tables for a terminal. A table has a header and one line per row.

using Table = std::vector<std::vector<std::string>>;

/// Returns a table. Columns that apply only to some suites are left out if no row has a value.
[[nodiscard]] Table to_table(std::span<const Row> rows);
[[nodiscard]] Table to_table(std::span<const LoadRow> rows);
[[nodiscard]] Table to_table(std::span<const RatioChange> changes);

}  // namespace ricochet::bench
