#include "cli/bench_results.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "cli/gnuplot.h"
#include "cli/interrupt.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"

namespace ricochet::cli {

BenchResults::BenchResults(const std::filesystem::path& folder, bench::Environment environment)
    : folder_(folder / environment.machine), environment_(std::move(environment)) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (!error && ::access(folder_.c_str(), W_OK | X_OK) != 0) error.assign(errno, std::generic_category());
    if (error) {
        throw InputError(fmt::format("--results {}: {} is no folder that can be written to ({}); name another one",
                                     folder.string(), folder_.string(), error.message()));
    }
}

std::string BenchResults::write(const std::string& suite, std::vector<bench::Record> records,
                                const std::string& plot_script) const {
    const bench::Record environment = record_of(environment_);
    for (bench::Record& record : records) record.insert(record.end(), environment.begin(), environment.end());
    const std::string script = suite + ".gp";
    write_file(folder_ / (suite + ".csv"), bench::to_csv(records));
    write_file(folder_ / script, plot_script);
    return draw_with_gnuplot(folder_, script, {suite + ".png"}, [] { return InterruptGuard::signal() != 0; });
}

}  // namespace ricochet::cli
