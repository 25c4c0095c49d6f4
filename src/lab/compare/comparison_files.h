/// \file
/// Files of a comparison: results, gnuplot script, data of the script, and report. docs/compare.md describes the files.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "lab/compare/comparison.h"

namespace ricochet {

/// Data for the report that a Comparison does not contain.
struct ComparisonSource {
    std::string version;                 ///< version of ricochet
    std::string scene;                   ///< path of the scene file, as given by the user
    std::vector<std::string> overrides;  ///< changed scene values, as PATH=VALUE
    int threads = 0;
    std::vector<std::string> warnings;  ///< warnings of the scene
};

/// Returns the text of compare.json: settings, reference and rows. Numbers that are not finite become null.
[[nodiscard]] std::string comparison_json(const Comparison& comparison, const ComparisonSource& source);
/// Returns the text of compare.csv (RFC 4180): a header and one line per row. Numbers have enough digits to read back
/// the same bits. Numbers that are not finite become empty cells.
[[nodiscard]] std::string comparison_csv(const Comparison& comparison);

/// Returns the text of compare.dat for gnuplot, with the columns of compare.csv. It has one block per response and one
/// line per time step.
[[nodiscard]] std::string comparison_points(const Comparison& comparison);
/// Returns the text of compare_energy.dat. It has one block per row. Each line of a block has a time, in s, and the
/// energy error at this time.
[[nodiscard]] std::string comparison_energies(const Comparison& comparison);
/// Returns the text of compare.gp. This gnuplot script draws kComparisonPictures from both data files in the current
/// folder. If the variable `ending` is set before the script runs, the script appends its value to the names of the
/// pictures.
[[nodiscard]] std::string comparison_script(const Comparison& comparison);

/// Returns the report in Markdown. `pictures` lists the existing files of kComparisonPictures. `remark` explains
/// missing pictures in one sentence.
[[nodiscard]] std::string comparison_markdown(const Comparison& comparison, const ComparisonSource& source,
                                              const std::vector<std::string>& pictures, const std::string& remark);
/// Returns the report as one HTML page. Only the pictures are separate files.
[[nodiscard]] std::string comparison_html(const Comparison& comparison, const ComparisonSource& source,
                                          const std::vector<std::string>& pictures, const std::string& remark);

/// Returns the table for a terminal, which has a header, one line per row, and the most important columns.
[[nodiscard]] std::vector<std::vector<std::string>> comparison_table(const Comparison& comparison);

// Columns of the files compare.json, compare.csv and compare.dat.

/// Text, a count, or a number. A missing number is not finite.
using ComparisonCell = std::variant<std::string, std::uint64_t, double>;

struct ComparisonColumn {
    const char* name;  ///< name in the files; values of columns with the prefix `cost_` are not reproducible
    ComparisonCell (*cell)(const ComparisonRow& row, const Comparison& comparison);
};

/// Returns the columns in the order of the files. docs/compare.md explains each column.
[[nodiscard]] const std::vector<ComparisonColumn>& comparison_columns();

/// Returns the index of a column by its name, from 0. Throws std::invalid_argument for an unknown name.
[[nodiscard]] std::size_t column_index(const std::string& name);
/// Returns the value of a cell as a number, or kNoNumber for text.
[[nodiscard]] double number_of(const ComparisonCell& cell);
/// Returns a state hash in the form that reports print.
[[nodiscard]] std::string hash_text(std::uint64_t hash);

}  // namespace ricochet
