// A folder of benchmark results: one folder a machine, one table and one picture a suite.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/environment.h"
#include "bench/records.h"

namespace ricochet::cli {

/// Where the results of one machine go.
class BenchResults {
public:
    /// Makes DIR/MACHINE and looks whether it can be written to. Throws InputError when something else than a folder
    /// is in the way or the folder cannot be made.
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

}  // namespace ricochet::cli
