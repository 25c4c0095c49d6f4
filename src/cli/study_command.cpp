#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <vector>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/interrupts.h"
#include "cli/terminal.h"
#include "lab/compare/gnuplot.h"
#include "lab/study/study_processes.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/io/scene.h"

namespace ricochet {
namespace {

constexpr const char* kMarker = ".ricochet-study";  // marks the folder of a study
constexpr const char* kScript = "study.gp";

// Raw arguments of the command line.
struct StudyArguments {
    std::string file;
    std::string output;
    int processes = 1;
    std::string threads;
    std::string progress = "auto";
    bool quiet = false;
};

// Folder of one study, locked against other studies.
class StudyFolder {
public:
    explicit StudyFolder(const std::filesystem::path& folder) {
        std::error_code error;
        std::filesystem::create_directories(folder, error);
        std::error_code ignored;
        if (!std::filesystem::is_directory(folder, ignored)) {
            throw InputError(
                fmt::format("{}: cannot be used as a folder ({}), expected a new or empty folder, or that "
                            "of a study",
                            folder.string(), error ? error.message() : "it is a file"));
        }
        const std::filesystem::path marker = folder / kMarker;
        if (!std::filesystem::exists(marker) && !std::filesystem::is_empty(folder, error)) {
            throw InputError(fmt::format("{}: contains other files, expected a new or empty folder, or that of a study",
                                         folder.string()));
        }
        descriptor_ = ::open(marker.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
        if (descriptor_ < 0) throw RunError(fmt::format("{}: {}", marker.string(), std::strerror(errno)));
        if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
            ::close(descriptor_);
            throw RunError(fmt::format("{}: another study is writing into this folder", folder.string()));
        }
    }
    ~StudyFolder() { ::close(descriptor_); }
    StudyFolder(const StudyFolder&) = delete;
    StudyFolder& operator=(const StudyFolder&) = delete;

private:
    int descriptor_ = -1;
};

// Throws InputError if the scene is invalid with the values of the first case.
void check_scene_of(const StudyPlan& plan, const std::vector<StudyRun>& runs) {
    const SceneDescription scene = read_scene(plan.scene, runs.front().overrides);
    for (const std::string& warning : scene.warnings) cli::print(stderr, "warning: {}\n", warning);
}

std::string this_program() {
    std::error_code error;
    std::string path = std::filesystem::read_symlink("/proc/self/exe", error).string();
    if (error) throw RunError(fmt::format("study: the path of this program is unknown ({})", error.message()));
    return path;
}

// Returns the worker threads of each process. By default the processors are shared equally.
int threads_of(const StudyArguments& arguments) {
    const int threads = cli::parse_thread_count(arguments.threads);
    return threads > 0 ? threads : std::max(1, thread_count() / arguments.processes);
}

std::vector<std::vector<std::string>> table_of(const StudyPlan& plan, const std::vector<StudyRow>& rows) {
    std::vector<std::vector<std::string>> table(1);
    for (const StudyAxis& axis : plan.axes) table[0].push_back(axis.key);
    for (const std::string& result : plan.results) table[0].push_back(result);
    for (const StudyRow& row : rows) {
        table.push_back(row.values);
        for (const StudyMean& result : row.results) {
            const std::string error = result.error ? fmt::format(" +- {:.2g}", *result.error) : "";
            table.back().push_back(std::isnan(result.mean) ? "failed" : fmt::format("{:.6g}{}", result.mean, error));
        }
    }
    return table;
}

// Writes the tables and draws the pictures. Returns the reason why there are no pictures, or an empty text.
std::string write_results(const std::filesystem::path& folder, const StudyPlan& plan, const std::vector<StudyRun>& runs,
                          const std::vector<StudyOutcome>& outcomes, const std::vector<StudyRow>& rows) {
    write_file(folder / "study.csv", study_csv(plan, rows));
    write_file(folder / "runs.csv", study_runs_csv(plan, runs, outcomes));
    if (std::ranges::none_of(rows, [](const StudyRow& row) { return row.runs > 0; })) return "no run has succeeded";
    write_file(folder / kScript, study_script(plan, rows));
    return draw_with_gnuplot(folder, kScript, study_pictures(plan), [] { return cli::InterruptGuard::signal() != 0; });
}

void report_failures(const StudyPlan& plan, const std::vector<StudyRun>& runs,
                     const std::vector<StudyOutcome>& outcomes) {
    for (std::size_t k = 0; k < runs.size(); ++k) {
        if (outcomes[k].failure.empty()) continue;
        std::string values;
        for (std::size_t a = 0; a < plan.axes.size(); ++a) {
            values += fmt::format("{}{} = {}", a > 0 ? ", " : "", plan.axes[a].key, runs[k].values[a]);
        }
        cli::print(stderr, "ricochet: run {} ({}) failed: {}\n", runs[k].number, values, outcomes[k].failure);
    }
}

int run_study_command(const StudyArguments& arguments) {
    const StudyPlan plan = read_study(arguments.file);
    const std::vector<StudyRun> runs = runs_of(plan);
    const int threads = threads_of(arguments);
    check_scene_of(plan, runs);
    const StudyFolder folder(arguments.output);
    const StudyProcesses processes{this_program(), arguments.output, static_cast<std::size_t>(arguments.processes),
                                   threads};
    const cli::InterruptGuard guard;
    std::vector<StudyOutcome> outcomes;
    {
        cli::ProgressLine line(arguments.quiet, cli::parse_progress(arguments.progress));
        outcomes = run_study(plan, runs, processes, [&](const StudyProgress& progress) {
            if (line.due()) {
                line.show(fmt::format("{} of {} runs, {} failed", progress.finished, progress.runs, progress.failed));
            }
            return cli::InterruptGuard::signal() != 0;
        });
    }
    if (const int signal = cli::InterruptGuard::signal(); signal != 0) {
        cli::print(stderr, "ricochet: interrupted; the same command continues the study\n");
        return cli::kSignalled + signal;
    }
    const std::vector<StudyRow> rows = study_rows(plan, runs, outcomes);
    const std::string failure = write_results(arguments.output, plan, runs, outcomes, rows);
    if (!arguments.quiet) {
        cli::print_table(table_of(plan, rows));
        if (!failure.empty()) cli::print("  note: no pictures: {}\n", failure);
        cli::print("  tables in {}\n", (std::filesystem::path(arguments.output) / "study.csv").string());
    }
    report_failures(plan, runs, outcomes);
    const bool is_whole = std::ranges::all_of(outcomes, [](const StudyOutcome& o) { return o.failure.empty(); });
    return is_whole ? 0 : 1;
}

}  // namespace

void add_study_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<StudyArguments>();
    cli::Command command = program.add_command("study", "Run one scene with many values of some keys");
    StudyArguments& a = *arguments;
    command.add_option("study", a.file, "Study file (JSON), see docs/studies.md").type_name("FILE").required();
    command.add_option("--output", a.output, "Folder of the study: new, empty, or an earlier one, which continues")
        .type_name("DIR")
        .required();
    command.add_option("--processes", a.processes, "Runs at the same time (default: 1)").type_name("N").range(1, 1024);
    command.add_option("--threads", a.threads, "Worker threads of each run (default: processors / runs at a time)")
        .type_name("N");
    cli::add_progress_options(command, a.progress, a.quiet);
    command.on_call([arguments, &exit_code] { exit_code = run_study_command(*arguments); });
}

}  // namespace ricochet
