#include "cli/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/arguments.h"
#include "cli/interrupts.h"
#include "cli/run_extension.h"
#include "cli/run_messages.h"
#include "cli/run_output.h"
#include "cli/run_scene.h"
#include "cli/shared_run.h"
#include "cli/terminal.h"
#include "inspect/scene_warnings.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"
#include "run/checkpoint.h"
#include "run/run_folder.h"
#include "run/run_report.h"
#include "run/run_writer.h"

namespace ricochet {
namespace {

using cli::InterruptGuard;
using cli::RunArguments;
using cli::seconds_since;
using Clock = std::chrono::steady_clock;

Simulation make_simulation(SimulationSetup setup, const std::string& file) {
    try {
        return Simulation(std::move(setup));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", file, error.what()));
    }
}

// Returns warnings about the setup, before the simulation takes ownership of it.
std::vector<std::string> setup_warnings(const SceneDescription& scene) {
    try {
        return bounds_warnings(scene.setup);
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", scene.file, error.what()));
    }
}

// Throws if the file cannot be written. Called before the run starts.
void check_writable(const std::string& file) {
    if (!file.empty()) const AtomicFile probe(file);
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code ignored;
    return std::filesystem::weakly_canonical(a, ignored) == std::filesystem::weakly_canonical(b, ignored) ||
           std::filesystem::equivalent(a, b, ignored);
}

// Checks that the final state replaces neither an input nor an output file of the run.
void check_target(const std::string& target, const SceneDescription& scene, const std::string& folder) {
    if (target.empty()) return;
    const auto refuse = [&](const char* what) {
        throw InputError(fmt::format("--output-state {}: {}, expected another name", target, what));
    };
    const std::filesystem::path path(target);
    if (is_same_file(path, scene.file)) refuse("is the scene itself");
    for (const std::filesystem::path& file : scene.files) {
        if (is_same_file(path, file)) refuse("is a file that the scene reads");
    }
    const std::filesystem::path parent = path.parent_path().empty() ? "." : path.parent_path();
    const std::string name = path.filename().string();
    const bool is_own = is_run_file(name) || name == kRunMarkerFile;
    if (is_own && is_same_file(parent, folder)) refuse("is a file of the run");
}

// Parameters of a run in progress.
struct RunPlan {
    OutputOptions output;
    std::uint64_t fingerprint = 0;
    double earlier_seconds = 0.0;  // wall time before the run was resumed
    Clock::time_point start = Clock::now();
    const cli::SharedRun* run = nullptr;

    [[nodiscard]] double seconds() const { return earlier_seconds + seconds_since(start); }
    // Returns `part`, in s, divided by the elapsed time, or 0 if no time has elapsed.
    [[nodiscard]] double share(double part) const { return seconds() > 0.0 ? part / seconds() : 0.0; }
};

// Grace period for the step in progress when a signal arrives. After this period, the step is abandoned.
class StepGracePeriod {
public:
    // Returns true while the step may continue. Any thread may call this function.
    [[nodiscard]] bool goes_on() {
        if (InterruptGuard::signal() == 0) return true;
        const Clock::rep now = Clock::now().time_since_epoch().count();
        Clock::rep first = 0;
        if (first_asked_.compare_exchange_strong(first, now)) return true;
        return Clock::duration(now - first) < kPatience;
    }

private:
    static constexpr std::chrono::milliseconds kPatience{250};
    std::atomic<Clock::rep> first_asked_ = 0;  // time of the first call after the signal; 0 before
};

// Makes steps until the run ends, a signal arrives or the run diverges. After a signal, the simulation is at the end of
// the current step, or at its start if the step was abandoned. Returns the reason of a divergence, or nothing. Creates
// the guard after the first step, because no work is lost if a signal arrives before.
std::optional<std::string> step_and_write(Simulation& simulation, cli::RunOutput& output, const RunPlan& plan,
                                          cli::RunProgress& progress, std::optional<InterruptGuard>& guard) {
    output.write_frame(simulation);
    std::uint64_t last_checkpoint = simulation.step_index();
    const std::uint64_t last_to_extend = cli::last_step_to_extend(simulation, plan.output.every);
    const auto after_step = [&] {
        if (!guard) guard.emplace();
        output.add_step(simulation);
        const cli::RunCounts counts =
            plan.run->after_step({simulation.particles().size(), simulation.statistics().particle_steps});
        progress.show(simulation, counts, plan.share(output.seconds()));
        return plan.run->signal() == 0;
    };
    StepGracePeriod grace_period;
    while (!simulation.finished() && plan.run->signal() == 0) {
        try {
            simulation.advance(plan.output.every - simulation.step_index() % plan.output.every, after_step,
                               [&] { return grace_period.goes_on(); });
        } catch (const StoppedError&) {
            return std::nullopt;
        } catch (const DivergedError& error) {
            return error.what();
        }
        const std::uint64_t step = simulation.step_index();
        if (step % plan.output.every != 0) continue;
        output.write_frame(simulation);
        const bool is_due = plan.output.checkpoint_every > 0 && step - last_checkpoint >= plan.output.checkpoint_every;
        if (!is_due && step != last_to_extend) continue;
        output.write_checkpoint(simulation, plan.seconds());
        last_checkpoint = step;
    }
    return std::nullopt;
}

SceneDescription scene_of(const RunArguments& arguments) {
    cli::SceneArguments wanted = arguments.scene;
    if (!arguments.response.empty()) wanted.overrides.push_back("simulation.response=" + arguments.response);
    if (!arguments.extend.empty()) wanted.overrides.push_back("simulation.duration=" + arguments.extend);
    SceneDescription scene = cli::load_scene(wanted);
    scene.setup.options.verify = arguments.verify;
    return scene;
}

void add_options(cli::Command command, RunArguments& a) {
    cli::add_scene_arguments(command, a.scene);
    command.add_option("--output", a.output, "Folder for frames and summary: new, empty, or an earlier run's")
        .type_name("DIR")
        .required();
    command
        .add_option("--output-state", a.output_state, "Also write the final state as text, with 17 significant digits")
        .type_name("FILE.csv");
    command.add_option("--threads", a.threads, "Worker threads of a process (default: all processors)").type_name("N");
    command.add_option("--response", a.response, "Collision response, instead of the scene's")
        .type_name("exact|rollback|project|penalty");
    cli::add_progress_options(command, a.progress, a.quiet);
    command.add_flag("--verify", a.verify,
                     "Also check every segment, side, distance and energy by independent code; violations are listed "
                     "and the exit code is 1");
    command.add_flag("--resume", a.resume,
                     "Continue an interrupted run of the same scene in DIR from its last checkpoint");
    command
        .add_option("--extend", a.extend, "With --resume: continue an interrupted or a finished run to this time, in s")
        .type_name("T");
}

// All objects of a run. If several ranks share the run, only the first rank has a writer. Only the first rank has the
// folder, unless all ranks write pieces.
struct PreparedRun {
    SceneDescription scene{};  // prepare() moves its setup into the simulation
    RunInfo info{};
    RunPlan plan{};
    Box3 region{};  // region of the particles
    cli::Progress progress = cli::Progress::automatic;
    std::optional<ThreadLimit> limit{};
    std::optional<Simulation> simulation{};
    std::optional<OutputDirectory> folder{};
    std::optional<RunWriter> writer{};
    cli::RunOutput out{};
};

// Does all checks that need no file of the output folder.
void prepare(const RunArguments& arguments, const cli::SharedRun& run, PreparedRun& prepared) {
    cli::check_extension(arguments);
    prepared.progress = cli::parse_progress(arguments.progress);
    prepared.limit.emplace(run.threads_for(cli::parse_thread_count(arguments.threads)));
    SceneDescription& scene = prepared.scene = scene_of(arguments);
    check_target(arguments.output_state, scene, arguments.output);
    prepared.info = run_info_of(scene);
    prepared.info.version = RICOCHET_VERSION;
    prepared.region = particle_region(scene.setup);
    prepared.plan = RunPlan{.output = scene.output, .fingerprint = scene.fingerprint, .run = &run};
    const Vec3 fall = uniform_acceleration(scene.setup);
    const std::vector<std::string> outside = setup_warnings(scene);
    scene.setup.ranks = run.ranks();
    run.require_shareable(scene);
    prepared.simulation.emplace(make_simulation(std::move(scene.setup), scene.file));
    // The region is computed before a checkpoint is read, so that planes have the same size in interrupted and
    // uninterrupted runs.
    if (arguments.resume) prepared.region.include(collider_region(*prepared.simulation));
    std::vector<std::string> warnings = prepared.simulation->warnings();
    std::ranges::copy(outside, std::back_inserter(warnings));
    std::ranges::move(pair_method_warnings(*prepared.simulation, fall), std::back_inserter(warnings));
    for (const std::string& warning : warnings) {
        cli::print(stderr, "ricochet: warning: {}: {}\n", scene.file, warning);
    }
}

void open_folder(const RunArguments& arguments, PreparedRun& prepared) {
    if (!prepared.plan.run->talks()) return;
    using Earlier = OutputDirectory::Earlier;
    prepared.folder.emplace(arguments.output, arguments.resume ? Earlier::keep : Earlier::remove);
    check_writable(arguments.output_state);
}

// Restores the state at which the run in the folder has stopped. Returns nothing for a new run.
std::optional<Checkpoint> resume(const RunArguments& arguments, PreparedRun& prepared) {
    if (!arguments.resume) return std::nullopt;
    Simulation& simulation = *prepared.simulation;
    Checkpoint checkpoint =
        read_checkpoint(cli::resumed_file(arguments, simulation), prepared.plan.fingerprint, simulation);
    cli::require_end_ahead(arguments, simulation);
    if (prepared.folder) {
        list_kept_files(arguments.output, checkpoint);
        prepared.folder->remove_after(simulation.step_index());
        prepared.folder->remove_checkpoint_parts(names_of(checkpoint.parts));
        cli::warn_of_ended_log(arguments, simulation);
    }
    prepared.plan.earlier_seconds = checkpoint.wall_seconds;
    return checkpoint;
}

// Returns values that must be equal on all ranks. They are compared before any rank opens a file.
std::vector<std::uint64_t> values_to_compare(const RunArguments& arguments, const PreparedRun& prepared) {
    StateHash names;
    for (const std::string& name : {arguments.output, arguments.output_state}) {
        names.add(name.size());
        names.add(std::as_bytes(std::span(name)));
    }
    const RunPlan& plan = prepared.plan;
    return {plan.fingerprint,
            plan.output.every,
            plan.output.checkpoint_every,
            std::uint64_t{plan.output.pieces},
            std::uint64_t{prepared.simulation->options().record_contacts},
            prepared.simulation->step_count(),
            std::uint64_t{arguments.resume},
            names.value()};
}

// Opens the outputs. The folder must already be locked, so that no other run changes its checkpoint. Returns values
// that must be equal on all ranks.
std::vector<std::uint64_t> begin(const RunArguments& arguments, PreparedRun& prepared) {
    const std::optional<Checkpoint> resumed = resume(arguments, prepared);
    const Simulation& simulation = *prepared.simulation;
    cli::RunOutput::Parts parts;
    if (prepared.folder) {
        RunWriter& writer =
            prepared.writer.emplace(prepared.folder->path(), prepared.info, simulation, prepared.region, resumed);
        if (prepared.plan.output.pieces) writer.leave_particles_out();
        parts.writer = &writer;
        parts.folder = &*prepared.folder;
    }
    parts.ranks = prepared.plan.run->ranks();
    if (prepared.plan.output.pieces) {
        parts.pieces = std::make_unique<PieceWriter>(arguments.output, prepared.info, parts.ranks, resumed);
    }
    if (resumed) parts.resumed_step = simulation.step_index();
    parts.fingerprint = prepared.plan.fingerprint;
    prepared.out = cli::RunOutput(std::move(parts));
    return {simulation.step_index(), std::bit_cast<std::uint64_t>(resumed ? resumed->wall_seconds : 0.0),
            std::bit_cast<std::uint64_t>(resumed ? resumed->output_seconds : 0.0)};
}

// Opens the folder on the other ranks, if all ranks write pieces. The first rank must have finished its work on the
// files of an earlier run.
std::optional<int> share_folder(const RunArguments& arguments, const cli::SharedRun& run, PreparedRun& prepared) {
    if (!run.ranks() || !prepared.plan.output.pieces) return std::nullopt;
    if (const auto failed = run.together([&] {
            if (prepared.folder) prepared.folder->share();
        })) {
        return failed;
    }
    return run.together([&] {
        if (!prepared.folder) prepared.folder.emplace(arguments.output, OutputDirectory::Earlier::join);
    });
}

// Runs all preparations. Returns the exit code if another process failed.
std::optional<int> prepare_together(const RunArguments& arguments, const cli::SharedRun& run, PreparedRun& prepared) {
    if (const auto failed = run.together([&] { prepare(arguments, run, prepared); })) return failed;
    if (const auto failed = run.require_alike(values_to_compare(arguments, prepared))) return failed;
    if (const auto failed = run.together([&] { prepared.simulation->have_meshes_in_common(); })) return failed;
    if (const auto failed = run.together([&] { open_folder(arguments, prepared); })) return failed;
    std::vector<std::uint64_t> alike;
    if (const auto failed = run.together([&] { alike = begin(arguments, prepared); })) return failed;
    if (const auto failed = share_folder(arguments, run, prepared)) return failed;
    if (const auto failed = run.require_alike(alike)) return failed;
    const Simulation& simulation = *prepared.simulation;
    if (arguments.resume && !arguments.quiet) {
        cli::print("resumed at step {} of {}, t = {:.6g} s\n", simulation.step_index(), simulation.step_count(),
                   simulation.time());
    }
    return std::nullopt;
}

// Writes the last frame, the totals of the colliders, the final state and the summary.
RunSummary write_final_output(const RunArguments& arguments, PreparedRun& prepared, const cli::RunResources& of_others,
                              const std::optional<std::string>& diverged) {
    Simulation& simulation = *prepared.simulation;
    RunWriter& writer = *prepared.writer;
    const bool is_interrupted = !simulation.finished() && !diverged;
    RunSummary summary = diverged ? writer.finish_diverged(simulation, *diverged) : writer.finish(simulation);
    if (!arguments.output_state.empty() && !diverged) {
        const Clock::time_point start = Clock::now();
        write_state_csv(arguments.output_state, simulation.particles(), simulation.shown_attributes(),
                        simulation.time());
        summary.output_seconds += seconds_since(start);
    }
    summary.version = prepared.info.version;
    summary.scene = prepared.info.scene;
    const cli::RunResources here = cli::RunResources::of_this_process();
    summary.balance = simulation.rank_balance();
    summary.common_memory_bytes = simulation.common_memory_bytes();
    summary.processes = of_others.processes + here.processes;
    summary.threads = static_cast<int>(of_others.threads + here.threads);
    summary.peak_memory_bytes = of_others.peak_memory_bytes + here.peak_memory_bytes;
    summary.wall_seconds = prepared.plan.seconds();
    summary.interrupted = is_interrupted;
    writer.write_summary(summary);
    // The checkpoint is renamed only now, because the run can resume from it until all files are on disk.
    if (!diverged && !is_interrupted) writer.keep_checkpoint_for_extension();
    return summary;
}

// Reports the end of the run, if this process prints, and returns the exit code. Throws RunError if the run diverged.
int report(const RunArguments& arguments, const Simulation& simulation, const std::optional<RunSummary>& summary,
           const std::optional<std::string>& diverged, int signal) {
    if (summary && !arguments.quiet) cli::print_report(*summary, arguments.output);
    if (summary) cli::print_losses(summary->scene, summary->statistics);
    if (summary && diverged) throw RunError(fmt::format("{}: {}", summary->scene, *diverged));
    if (diverged || cli::print_violations(simulation)) return 1;
    return simulation.finished() ? 0 : cli::kSignalled + signal;
}

}  // namespace

int cli::run_scene(const RunArguments& arguments) {
    const SharedRun run(arguments.shared ? SharedRun::With::launched : SharedRun::With::nobody);
    // On the heap: of a local object of this size, GCC 12 reports members as uninitialised.
    const auto owned = std::make_unique<PreparedRun>();
    PreparedRun& prepared = *owned;
    if (const auto failed = prepare_together(arguments, run, prepared)) return *failed;
    Simulation& simulation = *prepared.simulation;
    std::optional<InterruptGuard> guard;
    std::optional<std::string> diverged;
    {
        RunProgress progress(arguments.quiet, run.talks() ? prepared.progress : Progress::never);
        diverged = step_and_write(simulation, prepared.out, prepared.plan, progress, guard);
    }
    if (!diverged) prepared.out.write_frame(simulation);
    prepared.out.complete_frame();
    // An interrupted run needs a checkpoint, so that it can be resumed.
    if (!diverged && !simulation.finished()) prepared.out.write_checkpoint(simulation, prepared.plan.seconds());
    const RunResources of_others = run.resources_of_others();
    std::optional<RunSummary> summary;
    simulation.show_whole(Shown::all, [&] { summary = write_final_output(arguments, prepared, of_others, diverged); });
    run.end();
    return report(arguments, simulation, summary, diverged, run.signal());
}

void add_run_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<RunArguments>();
    cli::Command command = program.add_command("run", "Simulate a scene; write frames and a summary");
    add_options(command, *arguments);
    arguments->shared = true;
    command.on_call([arguments, &exit_code] { exit_code = cli::run_scene(*arguments); });
}

}  // namespace ricochet
