/// \file
/// Files of a comparison: the numbers, the gnuplot script and its data, and the report. docs/compare.md describes them.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "lab/compare/comparison.h"

namespace ricochet {

/// Data for the report that is not part of a comparison.
struct ComparisonSource {
    std::string version;                 ///< version of ricochet
    std::string scene;                   ///< the scene file as it was named
    std::vector<std::string> overrides;  ///< PATH=VALUE
    int threads = 0;
    std::vector<std::string> warnings;  ///< warnings of the scene
};

/// Returns the text of compare.json: settings, reference and rows. Numbers that are not finite become null.
[[nodiscard]] std::string comparison_json(const Comparison& comparison, const ComparisonSource& source);
/// Returns the text of compare.csv (RFC 4180): a header and one line per row. Numbers read back to the same bits. Cells
/// of numbers that are not finite are empty.
[[nodiscard]] std::string comparison_csv(const Comparison& comparison);

/// Returns the text of compare.dat for gnuplot: one block per response, one line per time step, with the columns of
/// compare.csv.
[[nodiscard]] std::string comparison_points(const Comparison& comparison);
/// Returns the text of compare_energy.dat: one block per row, with lines of time (in s) and energy error.
[[nodiscard]] std::string comparison_energies(const Comparison& comparison);
/// Returns the text of compare.gp. This gnuplot script draws kComparisonPictures from both data files, in the folder in
/// which it runs. If a variable `ending` is set before it, the script appends it to the pictures' names.
[[nodiscard]] std::string comparison_script(const Comparison& comparison);

/// Returns the report in Markdown. `pictures` lists the existing files of kComparisonPictures. `remark` is a sentence
/// that explains missing ones.
[[nodiscard]] std::string comparison_markdown(const Comparison& comparison, const ComparisonSource& source,
                                              const std::vector<std::string>& pictures, const std::string& remark);
/// Returns the report as one HTML page. Only the pictures are separate files.
[[nodiscard]] std::string comparison_html(const Comparison& comparison, const ComparisonSource& source,
                                          const std::vector<std::string>& pictures, const std::string& remark);

/// Returns the short table for a terminal: a header and one line per row.
[[nodiscard]] std::vector<std::vector<std::string>> comparison_table(const Comparison& comparison);

// The columns of a comparison's table, as compare.json and compare.csv name them.

/// Text, a count, or a number that may be missing (not finite).
using ComparisonCell = std::variant<std::string, std::uint64_t, double>;

struct ComparisonColumn {
    const char* name;  ///< names that begin with `cost_` mark values that differ between comparisons
    ComparisonCell (*cell)(const ComparisonRow& row, const Comparison& comparison);
};

/// Returns the columns in the order in which they are written. docs/compare.md explains each.
[[nodiscard]] const std::vector<ComparisonColumn>& comparison_columns();

/// Returns the index of a column by its name, from 0. Throws std::invalid_argument for an unknown name.
[[nodiscard]] std::size_t column_index(const std::string& name);
/// Returns a cell as a number; kNoNumber for text.
[[nodiscard]] double number_of(const ComparisonCell& cell);
/// Returns a state hash in the form that reports print.
[[nodiscard]] std::string hash_text(std::uint64_t hash);

}  // namespace ricochet
