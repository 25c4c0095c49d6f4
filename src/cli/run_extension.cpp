#include "cli/run_extension.h"

#include <fmt/format.h>

#include <optional>

#include "cli/arguments.h"
#include "cli/terminal.h"
#include "ricochet/core/error.h"
#include "run/run_folder.h"

namespace ricochet::cli {

namespace {

// Returns true if the last step has full length. A longer run then makes an identical step.
bool has_whole_last_step(const Simulation& simulation) {
    const SimulationOptions& options = simulation.options();
    return options.duration == static_cast<double>(simulation.step_count()) * options.time_step;
}

}  // namespace

void check_extension(const RunArguments& arguments) {
    if (arguments.extend.empty()) return;
    const std::optional<double> time = parse_number(arguments.extend);
    if (!time || !(*time > 0.0)) {
        throw InputError(fmt::format("--extend {}: expected a number above 0, the time in s at which the run is to end",
                                     arguments.extend));
    }
    if (!arguments.resume) {
        throw InputError(
            fmt::format("--extend {}: goes together with --resume; for a new run use --set "
                        "simulation.duration={}",
                        arguments.extend, arguments.extend));
    }
}

std::uint64_t last_step_to_extend(const Simulation& simulation, std::uint64_t every) {
    const std::uint64_t steps = simulation.step_count();
    return steps == 0 ? 0 : (has_whole_last_step(simulation) ? steps : steps - 1) / every * every;
}

std::filesystem::path resumed_file(const RunArguments& arguments, const Simulation& simulation) {
    const std::filesystem::path folder(arguments.output);
    const bool is_finished = !std::filesystem::exists(std::filesystem::symlink_status(folder / kCheckpointFile)) &&
                             std::filesystem::exists(std::filesystem::symlink_status(folder / kExtensionFile));
    if (!is_finished) return folder / kCheckpointFile;
    if (arguments.extend.empty()) {
        throw InputError(fmt::format("{}: the run is finished; --resume --extend T goes on to a later time T, in s",
                                     arguments.output));
    }
    const RunFolder run = open_run_folder(folder);
    if (run.info.time_step > 0.0 && run.info.time_step != simulation.options().time_step) {
        throw InputError(
            fmt::format("{}: the run has steps of {:.6g} s and the scene has steps of {:.6g} s; --resume needs the "
                        "scene of the run",
                        arguments.output, run.info.time_step, simulation.options().time_step));
    }
    const std::uint64_t made = run.frames.back().step;
    if (simulation.step_count() <= made) {
        throw InputError(
            fmt::format("--extend {}: the run is finished and has made {} steps of {:.6g} s, expected a "
                        "time of {} steps or more",
                        arguments.extend, made, simulation.options().time_step, made + 1));
    }
    return folder / kExtensionFile;
}

void require_end_ahead(const RunArguments& arguments, const Simulation& simulation) {
    const std::uint64_t end = simulation.step_count() + (has_whole_last_step(simulation) ? 1 : 0);
    if (simulation.step_index() < end) return;
    throw InputError(fmt::format(
        "{}: the run has made {} steps of {:.6g} s, which is beyond its end at {:.6g} s; "
        "--resume --extend T goes on to a later time T, in s",
        arguments.output, simulation.step_index(), simulation.options().time_step, simulation.options().duration));
}

void warn_of_ended_log(const RunArguments& arguments, const Simulation& simulation) {
    const std::filesystem::path log = std::filesystem::path(arguments.output) / kContactSeriesFile;
    if (simulation.options().record_contacts || !std::filesystem::exists(std::filesystem::symlink_status(log))) return;
    print(
        stderr,
        "ricochet: warning: {}: the run has a contact log, which ends at {:.6g} s because output.contacts is off now\n",
        arguments.output, simulation.time());
}

}  // namespace ricochet::cli
