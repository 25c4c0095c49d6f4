// Folder of benchmark results, and the plots in it. The results of each machine are in one subfolder, with one table
// and one picture for each suite.
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

    /// Writes SUITE.csv and SUITE.gp and draws SUITE.png. Existing files are replaced. Returns an empty text, or one
    /// line with the reason why no picture was drawn. Throws RunError if a file cannot be written.
    [[nodiscard]] std::string write(const std::string& suite, std::vector<bench::Record> records,
                                    const std::string& plot_script) const;

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
    bench::Environment environment_;
};

// Plots of the benchmark results.

/// Returns a gnuplot script that contains the numbers and draws SUITE.png in its working folder. Requires at least one
/// row. The suites draw:
/// - `size`: the cost over the number of triangles.
/// - `count`: rates over the number of particles.
/// - `threads`: the speedup.
/// - `radius`, `response` and `moving`: relative costs as bars.
/// - `pairs`: seconds of computation for one simulated second.
/// - Other suites: the ratios.
/// For all suites except `threads`, only the rows with the largest number of threads are drawn.
[[nodiscard]] std::string plot_script(std::string_view suite, std::span<const bench::Row> rows);

/// Returns a gnuplot script that draws the speed of reading mesh files and of building their acceleration structures.
[[nodiscard]] std::string plot_script(std::span<const bench::LoadRow> rows);

}  // namespace ricochet::cli
