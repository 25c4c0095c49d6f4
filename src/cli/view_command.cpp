#include "cli/commands.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <mutex>
#include <string>

#include "cli/arguments.h"
#include "cli/page_shapes.h"
#include "cli/run_scene.h"
#include "cli/terminal.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "run/run_folder.h"
#include "view/page/run_page.h"

namespace ricochet {
namespace {

// Raw arguments of the command line.
struct ViewArguments {
    cli::SceneArguments scene;  // `file` can also be the folder of a run
    std::string output;
    std::string run_output;
    std::string color_by;
    std::string color_map = "plasma";
    std::string threads;
    double budget = 30.0;
    bool quiet = false;
};

bool is_folder(const std::filesystem::path& path) {
    std::error_code ignored;
    return std::filesystem::is_directory(path, ignored);
}

// Removes a trailing slash, so that out/debris/ and out/debris are the same folder.
std::filesystem::path plain(std::filesystem::path path) {
    path = path.lexically_normal();
    return path.has_filename() ? path : path.parent_path();
}

// Returns the path of the page. For a run it is beside the folder, with the same name. For a scene it is in the
// working directory.
std::filesystem::path page_path(const ViewArguments& arguments, bool is_run) {
    if (!arguments.output.empty()) {
        if (std::filesystem::path(arguments.output).extension() == ".html") return arguments.output;
        throw InputError(fmt::format("--output {}: expected a name that ends in .html", arguments.output));
    }
    if (!is_run) return std::filesystem::path(arguments.scene.file).stem() += ".html";
    std::filesystem::path folder = plain(arguments.scene.file);
    if (folder == "." || folder.filename() == "..") {
        folder = std::filesystem::weakly_canonical(folder).filename();
    }
    return folder += ".html";
}

// Returns the folder of the run to show. This is the given folder, or the folder of a new run. Returns an empty path if
// a signal ended the run.
std::filesystem::path run_folder_of(const ViewArguments& arguments, bool is_run, int& exit_code) {
    if (is_run) {
        if (!arguments.scene.overrides.empty())
            throw InputError("--set: changes a scene, but a run's folder was given");
        if (!arguments.run_output.empty()) {
            throw InputError("--run-output: names the folder of a run to be made, but a run's folder was given");
        }
        return arguments.scene.file;
    }
    cli::RunArguments run;
    run.scene = arguments.scene;
    run.threads = arguments.threads;
    run.quiet = arguments.quiet;
    run.output = arguments.run_output.empty() ? std::filesystem::path(arguments.scene.file).stem().string() + "_run"
                                              : arguments.run_output;
    exit_code = cli::run_scene(run);
    return exit_code == 0 ? std::filesystem::path(run.output) : std::filesystem::path();
}

// Returns a callback that shows the progress of the page.
std::function<void(double)> progress_on(cli::ProgressLine& line, std::mutex& mutex) {
    return [&line, &mutex](double part) {
        const std::lock_guard lock(mutex);
        if (line.due()) line.show(fmt::format("{:3.0f} %  of the page", 100.0 * part));
    };
}

int view(const ViewArguments& arguments) {
    if (!(arguments.budget >= 1.0 && arguments.budget <= 2000.0)) {
        throw InputError(fmt::format("--budget {}: expected 1 to 2000 (MB)", arguments.budget));
    }
    const auto map = color_map_from_name(arguments.color_map);
    if (!map) {
        throw InputError(
            fmt::format("--color-map {}: expected one of {}", arguments.color_map, fmt::join(color_map_names(), ", ")));
    }
    const bool is_run = is_folder(arguments.scene.file);
    if (!is_run && !std::filesystem::exists(arguments.scene.file)) {
        throw InputError(fmt::format("there is neither a run's folder nor a scene {}", arguments.scene.file));
    }
    const std::filesystem::path target = page_path(arguments, is_run);
    if (is_folder(target)) throw InputError(fmt::format("--output {}: is a folder", target.string()));
    int exit_code = 0;
    const std::filesystem::path path = run_folder_of(arguments, is_run, exit_code);
    if (path.empty()) return exit_code;
    const RunFolder folder = open_run_folder(path);
    const ThreadLimit limit(cli::parse_thread_count(arguments.threads));
    PageReport report;
    {
        cli::ProgressLine line(arguments.quiet);
        std::mutex mutex;
        const PageOptions options{.budget = 1e6 * arguments.budget,
                                  .color_by = arguments.color_by,
                                  .map = *map,
                                  .version = RICOCHET_VERSION,
                                  .shapes = cli::page_shapes(folder),
                                  .progress = progress_on(line, mutex)};
        report = write_run_page(folder, target, options);
    }
    if (arguments.quiet) return 0;
    cli::print("{}: {} {}, {:.2f} MB; open it in a browser\n", target.string(), report.frames,
               report.frames == 1 ? "frame" : "frames", static_cast<double>(report.bytes) / 1e6);
    for (const std::string& note : report.notes) cli::print("  note: {}\n", note);
    return 0;
}

void add_options(cli::Command command, ViewArguments& a) {
    command.add_option("DIR|SCENE", a.scene.file, "Output folder of a run, or a scene to be run first").required();
    command
        .add_option("--output", a.output,
                    "The page (default: the folder's or the scene's name with .html, beside the folder or here)")
        .type_name("FILE.html");
    command
        .add_option("--budget", a.budget,
                    "Size limit of the page; bits, frames and particles are reduced until it fits")
        .type_name("MB")
        .show_default();
    command.add_option("--color-by", a.color_by,
                       "Attribute that initially colours the particles (default: their own color, or speed)");
    command.add_option("--color-map", a.color_map, "Initial colour map: viridis, plasma, inferno, magma or turbo")
        .show_default();
    command.add_option("--set", a.scene.overrides, "Replace a value of the scene (repeatable)")
        .type_name("PATH=VALUE")
        .one_value_each();
    command.add_option("--run-output", a.run_output, "Folder of the scene's run (default: its name with _run)")
        .type_name("DIR");
    command.add_option("--threads", a.threads, "Worker threads (default: all)").type_name("N");
    command.add_flag("--quiet", a.quiet, "No progress, no report");
}

}  // namespace

void add_view_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<ViewArguments>();
    cli::Command command = program.add_command("view", "Write a run as one page for a browser");
    add_options(command, *arguments);
    command.on_call([arguments, &exit_code] { exit_code = view(*arguments); });
}

}  // namespace ricochet
