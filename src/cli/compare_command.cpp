#include "cli/commands.h"

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/arguments.h"
#include "cli/terminal.h"
#include "lab/compare/comparison.h"
#include "lab/compare/comparison_files.h"
#include "lab/compare/gnuplot.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "run/run_folder.h"

namespace ricochet {
namespace {

// Raw arguments of the command line.
struct CompareArguments {
    cli::SceneArguments scene;
    ComparisonRequest request;
    std::string output;
    std::string threads;
    bool quiet = false;
};

std::string progress_text(const ComparisonProgress& progress) {
    const std::string kind = progress.repeat == 0 ? "measured" : fmt::format("timed, round {}", progress.repeat);
    return fmt::format("run {} of {}  {} at {:.4g} s ({})  step {} of {}", progress.run, progress.runs,
                       progress.response, progress.time_step, kind, progress.step, progress.steps);
}

// Throws InputError if a row of the comparison cannot run. Called before the output folder changes.
void check_rows(const cli::SceneArguments& arguments, const ComparisonPlan& plan) {
    SceneDescription scene = read_scene(arguments.file, arguments.overrides);
    try {
        require_comparable(std::move(scene.setup), plan);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", scene.file, error.what()));
    }
}

Comparison compare(SceneDescription& scene, const ComparisonPlan& plan, bool quiet) {
    cli::ProgressLine line(quiet);
    try {
        auto comparison = compare_responses(std::move(scene.setup), plan, [&](const ComparisonProgress& progress) {
            if (line.due()) line.show(progress_text(progress));
            return true;
        });
        return std::move(comparison).value();
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", scene.file, error.what()));
    }
}

ComparisonSource source_of(const SceneDescription& scene, const CompareArguments& arguments) {
    ComparisonSource source;
    source.version = RICOCHET_VERSION;
    source.scene = scene.file;
    source.overrides = arguments.scene.overrides;
    source.threads = thread_count();
    source.warnings = scene.warnings;
    return source;
}

void write_numbers(const std::filesystem::path& folder, const Comparison& comparison, const ComparisonSource& source) {
    write_file(folder / kComparisonJsonFile, comparison_json(comparison, source));
    write_file(folder / kComparisonTableFile, comparison_csv(comparison));
    write_file(folder / kComparisonPointsFile, comparison_points(comparison));
    write_file(folder / kComparisonEnergyFile, comparison_energies(comparison));
    write_file(folder / kComparisonScriptFile, comparison_script(comparison));
}

// Draws the pictures. Returns the reason for a failure, or an empty text.
std::string draw(const std::filesystem::path& folder) {
    const std::vector<std::string> pictures(kComparisonPictures.begin(), kComparisonPictures.end());
    return draw_with_gnuplot(folder, kComparisonScriptFile, pictures);
}

void write_report(const std::filesystem::path& folder, const Comparison& comparison, const ComparisonSource& source,
                  const std::string& failure) {
    std::vector<std::string> pictures;
    std::string remark;
    if (failure.empty()) {
        pictures.assign(kComparisonPictures.begin(), kComparisonPictures.end());
    } else {
        remark = fmt::format("The pictures are not drawn: {}. `gnuplot {}` in this folder draws them.", failure,
                             kComparisonScriptFile);
    }
    write_file(folder / kComparisonMarkdownFile, comparison_markdown(comparison, source, pictures, remark));
    write_file(folder / kComparisonHtmlFile, comparison_html(comparison, source, pictures, remark));
}

void print_report(const Comparison& comparison, const CompareArguments& arguments, const std::string& failure) {
    cli::print("{}: {} particles, {:.6g} s; reference exact at {:.4g} s\n", arguments.scene.file,
               comparison.reference.figures.statistics.emitted, comparison.options.duration,
               comparison.plan.reference_step);
    cli::print_table(comparison_table(comparison));
    for (const ComparisonRow* row : comparison.listed_rows()) {
        for (const std::string& warning : row->figures.warnings) {
            cli::print("  note: {} at {:.4g} s: {}\n", name_of(row->response), row->time_step, warning);
        }
    }
    if (!failure.empty())
        cli::print("  note: no pictures: {}; the script {} is there\n", failure, kComparisonScriptFile);
    cli::print("  report in {}\n", (std::filesystem::path(arguments.output) / kComparisonHtmlFile).string());
}

void run_compare(const CompareArguments& arguments) {
    const ThreadLimit limit(cli::parse_thread_count(arguments.threads));
    SceneDescription scene = cli::load_scene(arguments.scene);
    const ComparisonPlan plan = make_plan(arguments.request, scene.setup.options);
    check_rows(arguments.scene, plan);
    const OutputDirectory folder(arguments.output);
    const ComparisonSource source = source_of(scene, arguments);
    const Comparison comparison = compare(scene, plan, arguments.quiet);
    write_numbers(folder.path(), comparison, source);
    const std::string failure = draw(folder.path());
    write_report(folder.path(), comparison, source, failure);
    if (!arguments.quiet) print_report(comparison, arguments, failure);
}

void add_options(cli::Command command, CompareArguments& a) {
    cli::add_scene_arguments(command, a.scene);
    command.add_option("--output", a.output, "Folder for the report: new, empty, or an earlier run's")
        .type_name("DIR")
        .required();
    command
        .add_option("--responses", a.request.responses,
                    "Comma-separated names: exact, rollback, rollback:global, project, penalty (default: all "
                    "but rollback:global)")
        .type_name("LIST");
    command
        .add_option("--time-steps", a.request.time_steps,
                    "Comma-separated seconds (default: the scene's step times 2, 1, 1/2 and 1/4)")
        .type_name("LIST");
    command
        .add_option("--reference-step", a.request.reference_step,
                    "Time step of the exact reference run, in s (default: half of the smallest)")
        .type_name("S");
    command.add_option("--repeats", a.request.repeats, "Timed runs of each row (default: 3)").type_name("N");
    command.add_option("--threads", a.threads, "Worker threads (default: all processors)").type_name("N");
    command.add_flag("--quiet", a.quiet, "No progress, no table");
}

}  // namespace

void add_compare_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<CompareArguments>();
    cli::Command command =
        program.add_command("compare", "Compare the cost and errors of several responses on one scene");
    add_options(command, *arguments);
    command.on_call([arguments, &exit_code] {
        run_compare(*arguments);
        exit_code = 0;
    });
}

}  // namespace ricochet
