// A folder of benchmark results (one folder a machine, one table and one picture a suite), and its plots.
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

/// Where the results of one machine go.
class BenchResults {
public:
    /// Makes DIR/MACHINE and checks whether it can be written to. Throws InputError when something else than a folder
    /// stands there or the folder cannot be made.
    BenchResults(const std::filesystem::path& folder, bench::Environment environment);

    /// Writes SUITE.csv and SUITE.gp and draws SUITE.png, over those of an earlier run. Returns why there is no
    /// picture: empty, or one line. Throws RunError when a file cannot be written.
    [[nodiscard]] std::string write(const std::string& suite, std::vector<bench::Record> records,
                                    const std::string& plot_script) const;

    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

private:
    std::filesystem::path folder_;
    bench::Environment environment_;
};

// Pictures of the benchmark's numbers.

/// A gnuplot script, with the numbers in it, that draws SUITE.png in the folder it is run in: for `size` the cost over
/// the number of triangles, for `count` rates over the number of particles, for `threads` the speedup, for `radius` and
/// `response` the costs side by side, for the others the ratios. Of the other suites' rows those with the most threads
/// are drawn. At least one row.
[[nodiscard]] std::string plot_script(std::string_view suite, std::span<const bench::Row> rows);

/// The same for files: how fast they are read and built.
[[nodiscard]] std::string plot_script(std::span<const bench::LoadRow> rows);

}  // namespace ricochet::cli
