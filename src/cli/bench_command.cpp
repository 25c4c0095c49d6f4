#include "cli/bench_command.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/cases.h"
#include "bench/measurement.h"
#include "bench/measurement_report.h"
#include "cli/interrupt.h"
#include "cli/option_values.h"
#include "cli/progress_line.h"
#include "cli/text_table.h"
#include "ricochet/core/atomic_file.h"

namespace ricochet {
namespace {

using cli::InterruptGuard;

constexpr int kSignalled = 128;  // exit code of a program that a signal ended, plus the signal

// The arguments as they stand on the command line.
struct BenchArguments {
    std::string suite = "quick";
    std::string json;
    std::string threads;
    std::string repeats = "5";
};

std::string progress_text(const bench::Case& c, const bench::Progress& progress, std::uint32_t repeats) {
    std::string text = fmt::format("{}/{}  ", c.suite, c.name);
    if (progress.repeat > 0) {
        text += fmt::format("threads {}  repeat {} of {}  ", progress.threads, progress.repeat, repeats);
    }
    return text + std::string(progress.doing);
}

// Nothing when a signal has ended it.
std::optional<std::vector<bench::Row>> measure(const std::vector<bench::Case>& cases,
                                               const bench::MeasurementPlan& plan) {
    cli::ProgressLine line(false);
    std::vector<bench::Row> rows;
    for (const bench::Case& c : cases) {
        line.show(fmt::format("{}/{}  mesh and particles", c.suite, c.name));
        const auto measured = bench::measure_case(c, plan, [&](const bench::Progress& progress) {
            if (line.due()) line.show(progress_text(c, progress, plan.repeats));
            return InterruptGuard::signal() == 0;
        });
        if (!measured) return std::nullopt;
        rows.insert(rows.end(), measured->begin(), measured->end());
    }
    return rows;
}

int run_bench(const BenchArguments& arguments) {
    const std::vector<bench::Case> cases = bench::cases_of(arguments.suite);
    const bench::MeasurementPlan plan{cli::parse_thread_counts(arguments.threads),
                                      cli::parse_repeats(arguments.repeats)};
    const InterruptGuard guard;
    // Opened before hours of work, so that a folder that does not exist is told at once.
    std::optional<AtomicFile> file;
    if (!arguments.json.empty()) file.emplace(arguments.json);
    const auto rows = measure(cases, plan);
    if (!rows) return kSignalled + InterruptGuard::signal();
    if (file) {
        file->write(bench::to_json(*rows));
        file->commit();
    }
    cli::print_table(bench::to_table(*rows));
    return 0;
}

void add_options(CLI::App& command, BenchArguments& a) {
    command.add_option("--suite", a.suite, fmt::format("Which cases: {}", fmt::join(bench::suite_names(), ", ")))
        ->type_name("NAME")
        ->capture_default_str();
    command.add_option("--json", a.json, "File for the numbers")->type_name("FILE");
    command
        .add_option("--threads", a.threads,
                    "Numbers of worker threads with commas, each measured (default: all processors)")
        ->type_name("LIST");
    command.add_option("--repeats", a.repeats, "Timed runs, of which the median counts")
        ->type_name("N")
        ->capture_default_str();
}

}  // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
    const auto arguments = std::make_shared<BenchArguments>();
    CLI::App* const command =
        app.add_subcommand("bench", "What collisions cost, beside bare rays on the same stretches");
    add_options(*command, *arguments);
    command->callback([arguments, &exit_code] { exit_code = run_bench(*arguments); });
}

}  // namespace ricochet
