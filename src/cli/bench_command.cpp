#include "cli/commands.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/bench_files.h"
#include "cli/interrupts.h"
#include "cli/terminal.h"
#include "lab/bench/case_run.h"
#include "lab/bench/cases.h"
#include "lab/bench/load.h"
#include "lab/bench/measurement.h"
#include "lab/bench/ratios.h"
#include "lab/bench/records.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"

namespace ricochet {
namespace {

using cli::InterruptGuard;

constexpr int kSlower = 1;  // exit code if a ratio has decreased by more than the tolerance

// Raw arguments of the command line.
struct BenchArguments {
    std::string suite = "quick";
    std::string json;
    std::string results;
    std::string compare;
    std::string tolerance = "0.35";
    std::string write_ratios;
    std::string threads;
    std::string repeats = "5";
};

// Measured results. Only one of the two lists is used.
struct Measured {
    std::vector<bench::Row> rows;
    std::vector<bench::LoadRow> files;
    // Created with the first rows, because a signal must not lose measured rows.
    std::optional<InterruptGuard> guard;

    void add(std::span<const bench::Row> more) {
        if (!guard) guard.emplace();
        rows.insert(rows.end(), more.begin(), more.end());
    }
    void add(std::span<const bench::LoadRow> more) {
        if (!guard) guard.emplace();
        files.insert(files.end(), more.begin(), more.end());
    }

    [[nodiscard]] bool empty() const { return rows.empty() && files.empty(); }
    [[nodiscard]] std::vector<bench::Record> records() const {
        std::vector<bench::Record> records;
        for (const bench::Row& row : rows) records.push_back(bench::record_of(row));
        for (const bench::LoadRow& row : files) records.push_back(bench::record_of(row));
        return records;
    }
    [[nodiscard]] std::vector<std::vector<std::string>> table() const {
        return files.empty() ? bench::to_table(rows) : bench::to_table(files);
    }
};

// Progress of the benchmark, on one line of the terminal.
class BenchProgress {
public:
    BenchProgress(std::string suite, std::size_t cases, std::uint32_t repeats)
        : suite_(std::move(suite)), cases_(cases), repeats_(repeats) {}

    // Starts a case, or a group of cases that are measured alternately.
    void begin(std::size_t first, std::size_t count) {
        which_ = count == 1 ? fmt::format("case {} of {}", first + 1, cases_)
                            : fmt::format("cases {} to {} of {}", first + 1, first + count, cases_);
    }

    // Shows progress. A new kind of work is shown at once. Progress within the same work is shown at a readable rate.
    // Returns false after a signal.
    bool operator()(const bench::Progress& progress) {
        const bool needs_query = line_.due();
        if (needs_query || progress.doing != doing_) line_.show(text_of(progress));
        doing_ = progress.doing;
        return InterruptGuard::signal() == 0;
    }

private:
    [[nodiscard]] std::string text_of(const bench::Progress& progress) const {
        std::string text = fmt::format("{}  {}/{}  ", which_, suite_, progress.name);
        if (progress.repeat > 0) {
            text += fmt::format("repeat {} of {}  threads {}  ", progress.repeat, repeats_, progress.threads);
        }
        text += progress.doing;
        return progress.step == 0 ? text : text + fmt::format("  step {}", progress.step);
    }

    cli::ProgressLine line_{false};
    std::string suite_;
    std::size_t cases_;
    std::uint32_t repeats_;
    std::string which_;
    std::string doing_;
};

// Measures until all rows are complete or a signal arrives.
void measure_files(const bench::MeasurementPlan& plan, Measured& measured) {
    const std::vector<bench::LoadCase>& cases = bench::load_cases();
    BenchProgress progress(std::string(bench::kLoadSuite), cases.size(), plan.repeats);
    for (std::size_t i = 0; i < cases.size(); ++i) {
        progress.begin(i, 1);
        const auto rows = bench::measure_load(cases[i], plan, std::ref(progress));
        if (!rows) return;
        measured.add(*rows);
        bench::return_freed_memory();
    }
}

void measure_cases(const std::string& suite, const bench::MeasurementPlan& plan, Measured& measured) {
    BenchProgress progress(suite, bench::cases_of(suite).size(), plan.repeats);
    std::size_t first = 0;
    for (const std::vector<bench::Case>& group : bench::groups_of(suite)) {
        progress.begin(first, group.size());
        const auto rows = bench::measure_group(group, plan, std::ref(progress));
        if (!rows) return;
        measured.add(*rows);
        bench::return_freed_memory();
        first += group.size();
    }
}

void measure(const std::string& suite, const bench::MeasurementPlan& plan, Measured& measured) {
    if (suite == bench::kLoadSuite) {
        measure_files(plan, measured);
    } else {
        measure_cases(suite, plan, measured);
    }
}

bench::MeasurementPlan plan_of(const BenchArguments& arguments) {
    bench::MeasurementPlan plan;
    plan.threads = arguments.threads.empty() ? bench::default_threads(arguments.suite, thread_count())
                                             : cli::parse_thread_counts(arguments.threads);
    plan.repeats = cli::parse_repeats(arguments.repeats);
    return plan;
}

// File to compare with, and output files for the results. They are opened before the measurement, which can take hours,
// so that a missing file is reported at once.
class Outlets {
public:
    explicit Outlets(const BenchArguments& arguments)
        : arguments_(arguments), environment_(bench::this_environment(RICOCHET_VERSION)) {
        if ((!arguments.compare.empty() || !arguments.write_ratios.empty()) && arguments.suite == bench::kLoadSuite) {
            throw InputError("--suite load: it has no ratios to be compared or written; choose another suite");
        }
        tolerance_ = cli::parse_tolerance(arguments.tolerance);
        if (!arguments.compare.empty()) before_ = bench::read_ratios(arguments.compare, arguments.suite);
        if (!arguments.json.empty()) json_.emplace(arguments.json);
        if (!arguments.write_ratios.empty()) ratios_.emplace(arguments.write_ratios);
        if (!arguments.results.empty()) results_.emplace(arguments.results, environment_);
    }

    void write(const Measured& measured) {
        if (json_) {
            json_->write(bench::to_json(measured.records()));
            json_->commit();
        }
        if (ratios_) {
            ratios_->write(bench::to_json(ratios_of(measured)));
            ratios_->commit();
        }
        if (results_) write_results(measured);
    }

    // Prints the comparison and returns the exit code.
    [[nodiscard]] int compare(const Measured& measured) const {
        if (!before_) return 0;
        const auto changes = bench::compare_ratios(*before_, ratios_of(measured), tolerance_);
        cli::print("  against {} ({}, ricochet {}); a ratio may fall by {:.3g} %\n", arguments_.compare,
                   before_->machine, before_->version, 100.0 * tolerance_);
        cli::print_table(bench::to_table(changes));
        const bool is_slower = std::any_of(changes.begin(), changes.end(), [](const auto& c) { return c.fell; });
        return is_slower ? kSlower : 0;
    }

private:
    [[nodiscard]] bench::SuiteRatios ratios_of(const Measured& measured) const {
        return bench::ratios_of(measured.rows, arguments_.suite, environment_.machine, RICOCHET_VERSION);
    }

    void write_results(const Measured& measured) {
        const std::string script = measured.files.empty() ? cli::plot_script(arguments_.suite, measured.rows)
                                                          : cli::plot_script(measured.files);
        const std::string failure = results_->write(arguments_.suite, measured.records(), script);
        if (!failure.empty()) {
            cli::print("  note: no picture: {}; the script {}.gp is there\n", failure, arguments_.suite);
        }
        cli::print("  results in {}\n", results_->folder().string());
    }

    const BenchArguments& arguments_;
    bench::Environment environment_;
    double tolerance_ = 0.0;
    std::optional<bench::SuiteRatios> before_;
    std::optional<AtomicFile> json_;
    std::optional<AtomicFile> ratios_;
    std::optional<cli::BenchResults> results_;
};

int run_bench(const BenchArguments& arguments) {
    bench::require_suite(arguments.suite);
    const bench::MeasurementPlan plan = plan_of(arguments);
    Outlets outlets(arguments);
    Measured measured;
    measure(arguments.suite, plan, measured);
    if (!measured.empty()) cli::print_table(measured.table());
    if (InterruptGuard::signal() != 0) return cli::kSignalled + InterruptGuard::signal();
    outlets.write(measured);
    return outlets.compare(measured);
}

void add_options(cli::Command command, BenchArguments& a) {
    command.add_option("--suite", a.suite, fmt::format("Suite of cases: {}", fmt::join(bench::suite_names(), ", ")))
        .type_name("NAME")
        .show_default();
    command.add_option("--json", a.json, "JSON file for the results").type_name("FILE");
    command.add_option("--results", a.results, "Folder of results: DIR/MACHINE/SUITE gets a table and a picture")
        .type_name("DIR");
    const cli::Option compare =
        command.add_option("--compare", a.compare, "File of ratios to compare with; exit code 1 if a ratio has fallen")
            .type_name("FILE");
    command.add_option("--tolerance", a.tolerance, "Allowed relative fall of a ratio")
        .type_name("X")
        .show_default()
        .needs(compare);
    command.add_option("--write-ratios", a.write_ratios, "Write the ratios to this file, for --compare")
        .type_name("FILE");
    command
        .add_option("--threads", a.threads,
                    "Comma-separated numbers of worker threads, each measured (default: all processors; for the suite "
                    "threads 1, 2, 4 and so on)")
        .type_name("LIST");
    command.add_option("--repeats", a.repeats, "Number of timed runs; the median counts").type_name("N").show_default();
}

}  // namespace

void add_bench_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<BenchArguments>();
    cli::Command command =
        program.add_command("bench", "Measure the cost of collisions against bare rays on the same segments");
    add_options(command, *arguments);
    command.on_call([arguments, &exit_code] { exit_code = run_bench(*arguments); });
}

}  // namespace ricochet
