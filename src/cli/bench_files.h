// Folder of benchmark results, with one folder per machine and one table and one picture per suite, and its plots.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/bench/load.h"
#include "lab/bench/measurement.h"
#include "lab/bench/records.h"

namespace ricochet::cli {

/// Folder for the results of one machine.
class BenchResults {
public:
    /// Creates DIR/MACHINE and checks whether it is writable. Throws InputError if the path is not a folder or the
    /// folder cannot be created.
    BenchResults(const std::filesystem::path& folder, bench::Environment environment);

    /// Writes SUITE.csv and SUITE.gp and draws SUITE.png. Existing files are replaced. Returns an empty text, or the
    /// reason why there is no picture in one line. Throws RunError if a file cannot be written.
    [[nodiscard]] std::string write(const std::string& suite, std::vector<bench::Record> records,
                                    const std::string& plot_script) const;

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
    bench::Environment environment_;
};

// Plots of the benchmark results.

/// Returns a gnuplot script, including the numbers, that draws SUITE.png in its working folder. There must be at least
/// one row. The suites draw:
/// - `size`: the cost over the number of triangles.
/// - `count`: rates over the number of particles.
/// - `threads`: the speedup.
/// - `radius` and `response`: the costs side by side.
/// - Other suites: the ratios.
/// All suites except `threads` draw only the rows with the most threads.
[[nodiscard]] std::string plot_script(std::string_view suite, std::span<const bench::Row> rows);

/// Returns a gnuplot script for mesh files: the speed of reading and building.
[[nodiscard]] std::string plot_script(std::span<const bench::LoadRow> rows);

}  // namespace ricochet::cli
