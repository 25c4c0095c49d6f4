/// \file
/// A comparison as files: the numbers, the pictures' script and its data, the report. docs/compare.md describes them.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "lab/compare/comparison.h"

namespace ricochet {

/// What a comparison does not know by itself, for its report.
struct ComparisonSource {
    std::string version;                 ///< of ricochet
    std::string scene;                   ///< the scene file as it was named
    std::vector<std::string> overrides;  ///< PATH=VALUE
    int threads = 0;
    std::vector<std::string> warnings;  ///< of the scene
};

/// The text of compare.json: settings, reference and rows. Numbers that are not finite become null.
[[nodiscard]] std::string comparison_json(const Comparison& comparison, const ComparisonSource& source);
/// The text of compare.csv (RFC 4180): a header and one line a row; numbers read back to the same bits, empty where not
/// finite.
[[nodiscard]] std::string comparison_csv(const Comparison& comparison);

/// The text of compare.dat: for gnuplot one block a response, one line a time step, the columns of compare.csv.
[[nodiscard]] std::string comparison_points(const Comparison& comparison);
/// The text of compare_energy.dat: one block a row, lines of time (s) and energy error.
[[nodiscard]] std::string comparison_energies(const Comparison& comparison);
/// The text of compare.gp, a gnuplot script that draws kComparisonPictures from both, in the folder it is run in. A
/// variable `ending` set before it is appended to the pictures' names.
[[nodiscard]] std::string comparison_script(const Comparison& comparison);

/// The report. pictures: those of kComparisonPictures that are there; remark: a sentence for where they are missing.
[[nodiscard]] std::string comparison_markdown(const Comparison& comparison, const ComparisonSource& source,
                                              const std::vector<std::string>& pictures, const std::string& remark);
/// The same as one HTML page; only the pictures are files beside it.
[[nodiscard]] std::string comparison_html(const Comparison& comparison, const ComparisonSource& source,
                                          const std::vector<std::string>& pictures, const std::string& remark);

/// The short table for a terminal: a header and one row each.
[[nodiscard]] std::vector<std::vector<std::string>> comparison_table(const Comparison& comparison);

// The columns of a comparison's table, as compare.json and compare.csv name them.

/// Text, a count, or a number that may be none (not finite).
using ComparisonCell = std::variant<std::string, std::uint64_t, double>;

struct ComparisonColumn {
    const char* name;  ///< those that begin with `cost_` differ from one comparison to the next
    ComparisonCell (*cell)(const ComparisonRow& row, const Comparison& comparison);
};

/// In the order in which they are written. docs/compare.md says what each means.
[[nodiscard]] const std::vector<ComparisonColumn>& comparison_columns();

/// Index of a column by its name, from 0. Throws std::invalid_argument for a name that is none.
[[nodiscard]] std::size_t column_index(const std::string& name);
/// A cell as a number; kNoNumber for text.
[[nodiscard]] double number_of(const ComparisonCell& cell);
/// A state's hash as reports print it.
[[nodiscard]] std::string hash_text(std::uint64_t hash);

}  // namespace ricochet
