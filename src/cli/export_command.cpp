#include "cli/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "cli/chosen_frames.h"
#include "cli/terminal.h"
#include "ricochet/core/error.h"
#include "ricochet/io/scene/diagnostics.h"
#include "view/export/run_export.h"

namespace ricochet {
namespace {

constexpr std::array<std::string_view, 4> kFormats = {"ply", "pc2", "gltf", "csv"};

// Raw arguments of the command line.
struct ExportArguments {
    std::string folder;
    std::string format;
    std::string output;
    std::optional<std::string> frame;
    bool consecutive = false;
    bool quiet = false;
};

void check_format(const std::string& format) {
    if (std::find(kFormats.begin(), kFormats.end(), format) != kFormats.end()) return;
    if (format == "glb") throw InputError("--format glb: expected gltf, which writes a .glb file");
    const auto nearest = detail::nearest_names(format, {kFormats.begin(), kFormats.end()});
    throw InputError(fmt::format("--format {}: {}", format,
                                 nearest.empty() ? "expected ply, pc2, gltf or csv" : detail::did_you_mean(nearest)));
}

void check_arguments(const ExportArguments& arguments) {
    check_format(arguments.format);
    if (arguments.frame && arguments.format != "gltf") {
        throw InputError(fmt::format("--frame: is for --format gltf; {} takes all frames", arguments.format));
    }
    if (arguments.consecutive && arguments.format != "ply") {
        throw InputError(fmt::format("--consecutive: is for --format ply; {} has {}", arguments.format,
                                     arguments.format == "csv" ? "files by step" : "no numbered files"));
    }
    if (arguments.output.empty()) throw InputError("--output: expected a name, found an empty one");
    if (arguments.format != "gltf") return;
    if (std::filesystem::path(arguments.output).extension() != ".glb") {
        throw InputError(fmt::format("--output {}: expected a name that ends in .glb", arguments.output));
    }
}

ExportReport write_files(const RunFolder& folder, const ExportArguments& arguments) {
    cli::ProgressLine line(arguments.quiet);
    const auto progress = [&line](double part) {
        if (line.due()) line.show(fmt::format("{:3.0f} %  of the frames", 100.0 * part));
    };
    if (arguments.format == "ply") {
        const auto numbers = arguments.consecutive ? ExportNumbers::consecutive : ExportNumbers::steps;
        return export_ply(folder, arguments.output, numbers, progress);
    }
    if (arguments.format == "csv") return export_csv(folder, arguments.output, progress);
    if (arguments.format == "pc2") return export_pc2(folder, arguments.output, progress);
    const FrameFile frame = cli::chosen_frames(folder, arguments.frame.value_or("last"), false).front();
    return export_gltf(folder, frame, arguments.output);
}

void export_run(const ExportArguments& arguments) {
    check_arguments(arguments);
    const RunFolder folder = open_run_folder(arguments.folder);
    const ExportReport report = write_files(folder, arguments);
    if (arguments.quiet) return;
    cli::print("{}: {} {} of {} {}\n", arguments.output, report.files, report.files == 1 ? "file" : "files",
               report.frames, report.frames == 1 ? "frame" : "frames");
    for (const std::string& note : report.notes) cli::print("  note: {}\n", note);
}

void add_options(cli::Command command, ExportArguments& a) {
    command.add_option("DIR", a.folder, "Output folder of a run").required();
    command
        .add_option(
            "--format", a.format,
            "ply: particles and moving colliders frame by frame; pc2: meshes with point caches; gltf: one frame; "
            "csv: tables of particles, contacts and triangles")
        .type_name("ply|pc2|gltf|csv")
        .required();
    command
        .add_option("--output", a.output,
                    "Folder for ply, pc2 and csv (new, empty, or an earlier export's), .glb file for gltf")
        .type_name("PATH")
        .required();
    command.add_option("--frame", a.frame, "Step of the frame of a gltf file, or last (default)").type_name("N");
    command.add_flag("--consecutive", a.consecutive, "Number ply files 0, 1, 2, ... instead of by the run's steps");
    command.add_flag("--quiet", a.quiet, "No progress, no report");
}

}  // namespace

void add_export_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<ExportArguments>();
    cli::Command command = program.add_command("export", "Write a run as files for other programs");
    add_options(command, *arguments);
    command.on_call([arguments, &exit_code] {
        export_run(*arguments);
        exit_code = 0;
    });
}

}  // namespace ricochet
