#include "cli/commands.h"

#include <fmt/format.h>
#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iterator>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/arguments.h"
#include "cli/interrupts.h"
#include "cli/run_scene.h"
#include "cli/terminal.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"
#include "ricochet/io/checkpoint.h"
#include "ricochet/io/run_folder.h"
#include "ricochet/io/run_report.h"
#include "ricochet/io/run_writer.h"
#include "ricochet/io/scene_warnings.h"

namespace ricochet {
namespace {

using cli::InterruptGuard;
using cli::RunArguments;
using Clock = std::chrono::steady_clock;

// Not below 0: a clock may be put back under a run that goes on for days.
double seconds_since(Clock::time_point start) {
    return std::max(0.0, std::chrono::duration<double>(Clock::now() - start).count());
}

// Nothing where no time has passed.
std::string rate_text(std::uint64_t count, double seconds) {
    return seconds > 0.0 ? cli::short_number(static_cast<double>(count) / seconds) : "-";
}

Simulation make_simulation(SimulationSetup setup, const std::string& file) {
    try {
        return Simulation(std::move(setup));
    } catch (const InputError& error) {
        throw InputError(fmt::format("{}: {}", file, error.what()));
    }
}

// Finds out before the work, not after it, whether the file can be written.
void check_writable(const std::string& file) {
    if (!file.empty()) const AtomicFile probe(file);
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code ignored;
    return std::filesystem::weakly_canonical(a, ignored) == std::filesystem::weakly_canonical(b, ignored) ||
           std::filesystem::equivalent(a, b, ignored);
}

// The final state must not replace what the run reads, nor what it writes.
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

// The progress line of a run. Steps cost more as particles are born, so the time left is told from the latest steps.
class RunProgress {
public:
    RunProgress(bool quiet, cli::Progress progress) : line_(quiet, progress) {}

    // output_share: of the run's time so far.
    void show(const Simulation& simulation, double output_share) {
        if (!line_.due()) return;
        const double seconds = seconds_since(last_time_);
        const auto steps = static_cast<double>(simulation.step_index() - last_step_);
        const std::uint64_t moved = simulation.statistics().particle_steps - last_particle_steps_;
        seconds_per_step_ =
            seconds_per_step_ == 0.0 ? seconds / steps : 0.8 * seconds_per_step_ + 0.2 * seconds / steps;
        last_time_ = Clock::now();
        last_step_ = simulation.step_index();
        last_particle_steps_ = simulation.statistics().particle_steps;
        const auto left = static_cast<double>(simulation.step_count() - simulation.step_index());
        line_.show(fmt::format(
            "{:3.0f} %  step {} of {}  {} particles  {} particle-steps/s  {:.0f} % on output  {} left",
            100.0 * static_cast<double>(simulation.step_index()) / static_cast<double>(simulation.step_count()),
            simulation.step_index(), simulation.step_count(),
            cli::short_number(static_cast<double>(simulation.particles().size())), rate_text(moved, seconds),
            100.0 * std::min(output_share, 1.0), cli::duration_text(left * seconds_per_step_)));
    }

private:
    cli::ProgressLine line_;
    Clock::time_point last_time_ = Clock::now();
    std::uint64_t last_step_ = 0;
    std::uint64_t last_particle_steps_ = 0;
    double seconds_per_step_ = 0.0;
};

// What a run needs to know while it goes on.
struct RunPlan {
    OutputOptions output;
    std::uint64_t fingerprint = 0;
    double earlier_seconds = 0.0;  // wall time before it was resumed
    Clock::time_point start = Clock::now();
    bool quiet = false;
    cli::Progress progress = cli::Progress::automatic;

    [[nodiscard]] double seconds() const { return earlier_seconds + seconds_since(start); }
    // Of the time so far; the clock need not have moved.
    [[nodiscard]] double share(double part) const { return seconds() > 0.0 ? part / seconds() : 0.0; }
};

// The state after the last step, where a step may take longer than a signal waits: of implicit_euler on springs, which
// asks between its iterations. What a verified run has found is in no state: its steps are waited for.
class LastState {
public:
    // make: the same simulation from its beginning.
    LastState(const SceneDescription& scene, std::function<Simulation()> make)
        : make_(std::move(make)),
          is_kept_(!scene.setup.springs.empty() && !scene.setup.options.verify &&
                   scene.setup.options.integrator.kind == IntegratorKind::implicit_euler) {}

    void keep(const Simulation& simulation) {
        if (!is_kept_) return;
        bytes_.clear();
        simulation.save(
            [this](std::span<const std::byte> part) { bytes_.insert(bytes_.end(), part.begin(), part.end()); });
    }
    [[nodiscard]] bool has_any() const { return !bytes_.empty(); }

    [[nodiscard]] Simulation restored() const {
        Simulation simulation = make_();
        std::size_t at = 0;
        simulation.restore([&](std::span<std::byte> part) {
            std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(at), part.size(), part.begin());
            at += part.size();
        });
        return simulation;
    }

private:
    std::function<Simulation()> make_;
    std::vector<std::byte> bytes_;
    bool is_kept_;
};

// Steps to the end, to the end of the step in which a signal came (to its begin where it can be stopped), or to the one
// that diverges: then it says why. Only when a step has been made there is something that a signal must not take away:
// the guard lives from then on.
std::optional<std::string> step_and_write(Simulation& simulation, RunWriter& writer, const RunPlan& plan,
                                          std::optional<InterruptGuard>& guard, LastState& last) {
    RunProgress progress(plan.quiet, plan.progress);
    writer.write_frame(simulation);
    std::uint64_t last_checkpoint = simulation.step_index();
    const auto after_step = [&] {
        if (!guard) guard.emplace();
        writer.add_step(simulation);
        last.keep(simulation);
        progress.show(simulation, plan.share(writer.output_seconds()));
        return InterruptGuard::signal() == 0;
    };
    while (!simulation.finished() && InterruptGuard::signal() == 0) {
        try {
            simulation.advance(plan.output.every - simulation.step_index() % plan.output.every, after_step,
                               [&] { return InterruptGuard::signal() == 0 || !last.has_any(); });
        } catch (const StoppedError&) {
            simulation = last.restored();
            return std::nullopt;
        } catch (const DivergedError& error) {
            return error.what();
        }
        const std::uint64_t step = simulation.step_index();
        if (step % plan.output.every != 0) continue;
        writer.write_frame(simulation);
        if (plan.output.checkpoint_every == 0 || step - last_checkpoint < plan.output.checkpoint_every) continue;
        writer.write_checkpoint(simulation, plan.fingerprint, plan.seconds());
        last_checkpoint = step;
    }
    return std::nullopt;
}

// What it takes to go on where a signal has ended the run.
void leave_checkpoint(const Simulation& simulation, RunWriter& writer, const RunPlan& plan) {
    writer.write_frame(simulation);
    writer.write_checkpoint(simulation, plan.fingerprint, plan.seconds());
}

/// Of the smaller radius: spheres overlap by more than what dense contact leaves where it is solved.
constexpr double kLargeOverlap = 0.05;

// What makes results wrong or files incomplete: also where nothing else is told.
void print_losses(const std::string& scene, const SimulationStatistics& statistics) {
    const auto warn = [&scene](std::uint64_t count, const char* what) {
        if (count > 0) cli::print(stderr, "ricochet: {}: warning: {}: {}\n", scene, what, count);
    };
    warn(statistics.frozen, "particles stopped because their state was not finite or absurdly large (frozen)");
    warn(statistics.lost_impulses,
         "impulses that are not in the totals of the collider files, since they have 6.7e7 N s and more along an axis, "
         "beyond what a total can hold; the motion itself is right (lost_impulses)");
    if (statistics.overlap_largest > kLargeOverlap && statistics.born_in_overlap == 0) {
        cli::print(
            stderr,
            "ricochet: {}: warning: spheres overlap by up to {:.2g} of the smaller radius (overlap_largest): make "
            "simulation.time_step smaller, or radii and masses more alike\n",
            scene, statistics.overlap_largest);
    }
}

void print_notes(const SimulationStatistics& statistics) {
    const auto warn = [](std::uint64_t count, const char* what) {
        if (count > 0) cli::print("  note: {}: {}\n", what, count);
    };
    warn(statistics.springs_broken, "springs that broke (springs_broken)");
    warn(statistics.springs_lost, "springs that lost a particle at an end (springs_lost)");
    warn(statistics.unsolved_steps, "steps not solved to the tolerance by the implicit method (unsolved_steps)");
    warn(statistics.budget_exhausted, "times that a particle spent its bounces of a step (budget_exhausted)");
    warn(statistics.squeezed,
         "times that surfaces that close left a particle no room, so that it waits for some (squeezed)");
    warn(statistics.started_inside - statistics.started_in_overlap,
         "points born exactly on a surface (started_inside)");
    warn(statistics.started_in_overlap, "spheres born in overlap with a surface (started_in_overlap)");
    warn(statistics.stayed, "impacts that left the particle where it was (stayed)");
    warn(statistics.births_refused_by_depth, "births refused beyond max_depth (births_refused_by_depth)");
    warn(statistics.births_refused_by_population,
         "births refused beyond most_particles (births_refused_by_population)");
    warn(statistics.births_refused_by_overlap,
         "births refused, since no free position for the sphere was found (births_refused_by_overlap)");
}

void print_report(const RunSummary& summary, const std::string& output) {
    const SimulationStatistics& statistics = summary.statistics;
    cli::print("{}: {} steps, {:.6g} s simulated in {:.3g} s on {} {}{}\n", summary.scene, statistics.steps,
               summary.simulated_time, summary.wall_seconds, summary.threads,
               summary.threads == 1 ? "thread" : "threads",
               summary.interrupted ? " (interrupted)"
               : summary.diverged  ? " (diverged)"
                                   : "");
    cli::print("  {} particles emitted, {} alive; {} particle-steps ({}/s), {} contacts, at most {} bounces a step\n",
               statistics.emitted, summary.particles_alive, statistics.particle_steps,
               rate_text(statistics.particle_steps, summary.wall_seconds), statistics.contacts,
               statistics.bounces_per_step_max);
    print_notes(statistics);
    if (summary.leaks) {
        const bool all_judged = statistics.started_in_overlap == 0;
        cli::print("  verified by independent exact checks: {} violations, {} of energy{}\n", *summary.leaks,
                   summary.energy_violations.value_or(0),
                   all_judged ? "" : "; overlaps from birth count once the sphere has been free");
    }
    if (summary.leaks && summary.spheres_meet) {
        cli::print("  spheres on each other: {} violations, largest overlap {:.2g} of a radius\n",
                   statistics.pair_violations, statistics.overlap_verified);
    }
    cli::print("  state {} {:016x}; {} frames in {}\n", StateHash::kName, summary.state_hash, summary.frames, output);
}

// Lists what a verified run found wrong. Returns whether there was anything.
bool print_violations(const Simulation& simulation) {
    const SimulationStatistics& statistics = simulation.statistics();
    const auto lines = cli::violation_lines(
        simulation.violations(), statistics.violations + statistics.energy_violations + statistics.pair_violations,
        simulation.colliders());
    for (const std::string& line : lines) cli::print(stderr, "{}\n", line);
    return !lines.empty();
}

// Puts the simulation where the interrupted run in the folder has stopped.
std::optional<Checkpoint> resume(const RunArguments& arguments, const OutputDirectory& folder, Simulation& simulation,
                                 RunPlan& plan) {
    if (!arguments.resume) return std::nullopt;
    Checkpoint checkpoint = read_checkpoint(folder.path() / kCheckpointFile, plan.fingerprint, simulation);
    folder.remove_after(simulation.step_index());
    plan.earlier_seconds = checkpoint.wall_seconds;
    if (!arguments.quiet) {
        cli::print("resumed at step {} of {}, t = {:.6g} s\n", simulation.step_index(), simulation.step_count(),
                   simulation.time());
    }
    return checkpoint;
}

SceneDescription scene_of(const RunArguments& arguments) {
    cli::SceneArguments wanted = arguments.scene;
    if (!arguments.response.empty()) wanted.overrides.push_back("simulation.response=" + arguments.response);
    SceneDescription scene = cli::load_scene(wanted);
    scene.setup.options.verify = arguments.verify;
    return scene;
}

// Largest resident set of this process so far.
std::uint64_t peak_memory_bytes() {
    rusage usage{};
    if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024U;  // Linux counts in kilobytes
}

void complete(RunSummary& summary, const RunInfo& info, const RunPlan& plan) {
    summary.version = info.version;
    summary.scene = info.scene;
    summary.threads = thread_count();
    summary.peak_memory_bytes = peak_memory_bytes();
    summary.wall_seconds = plan.seconds();
}

void add_options(cli::Command command, RunArguments& a) {
    cli::add_scene_arguments(command, a.scene);
    command.add_option("--output", a.output, "Folder for frames and summary: new, empty, or an earlier run's")
        .type_name("DIR")
        .required();
    command
        .add_option("--output-state", a.output_state, "Also write the final state as text, with 17 significant digits")
        .type_name("FILE.csv");
    command.add_option("--threads", a.threads, "Worker threads (default: all processors)").type_name("N");
    command.add_option("--response", a.response, "How impacts are answered, instead of what the scene says")
        .type_name("exact|rollback|project|penalty");
    cli::add_progress_options(command, a.progress, a.quiet);
    command.add_flag(
        "--verify", a.verify,
        "Also check every segment, side, distance and energy by independent code; what is wrong is listed and ends "
        "with 1");
    command.add_flag("--resume", a.resume,
                     "Go on with an interrupted run of the same scene in DIR, from its last checkpoint");
}

}  // namespace

int cli::run_scene(const RunArguments& arguments) {
    const ThreadLimit limit(cli::parse_thread_count(arguments.threads));
    const Progress progress = parse_progress(arguments.progress);
    SceneDescription scene = scene_of(arguments);
    check_target(arguments.output_state, scene, arguments.output);
    RunInfo info = run_info_of(scene);
    info.version = RICOCHET_VERSION;
    const Box3 region = particle_region(scene.setup);
    const Vec3 fall = uniform_acceleration(scene.setup);
    LastState last(scene, [&arguments] { return Simulation(scene_of(arguments).setup); });
    Simulation simulation = make_simulation(std::move(scene.setup), scene.file);
    std::vector<std::string> warnings = simulation.warnings();
    std::ranges::move(pair_method_warnings(simulation, fall), std::back_inserter(warnings));
    for (const std::string& warning : warnings) {
        cli::print(stderr, "ricochet: {}: warning: {}\n", scene.file, warning);
    }
    using Earlier = OutputDirectory::Earlier;
    const OutputDirectory folder(arguments.output, arguments.resume ? Earlier::keep : Earlier::remove);
    check_writable(arguments.output_state);
    RunPlan plan{
        .output = scene.output, .fingerprint = scene.fingerprint, .quiet = arguments.quiet, .progress = progress};
    const std::optional<Checkpoint> resumed = resume(arguments, folder, simulation, plan);
    RunWriter writer(folder.path(), info, simulation, region, resumed);
    std::optional<InterruptGuard> guard;
    const auto diverged = step_and_write(simulation, writer, plan, guard, last);
    const bool is_interrupted = !simulation.finished() && !diverged;
    if (is_interrupted) leave_checkpoint(simulation, writer, plan);
    RunSummary summary = diverged ? writer.finish_diverged(simulation, *diverged) : writer.finish(simulation);
    if (!arguments.output_state.empty() && !diverged) {
        const Clock::time_point start = Clock::now();
        write_state_csv(arguments.output_state, simulation.particles(), simulation.shown_attributes(),
                        simulation.time());
        summary.output_seconds += seconds_since(start);
    }
    complete(summary, info, plan);
    summary.interrupted = is_interrupted;
    writer.write_summary(summary);
    // Only now: until all is on disk the run can go on from there.
    if (!diverged && !is_interrupted) writer.remove_checkpoint();
    if (!arguments.quiet) print_report(summary, arguments.output);
    print_losses(summary.scene, summary.statistics);
    if (diverged) throw RunError(fmt::format("{}: {}", info.scene, *diverged));
    if (print_violations(simulation)) return 1;
    return summary.interrupted ? cli::kSignalled + InterruptGuard::signal() : 0;
}

void add_run_command(cli::Command program, int& exit_code) {
    const auto arguments = std::make_shared<RunArguments>();
    cli::Command command = program.add_command("run", "Simulate a scene; write frames and a summary");
    add_options(command, *arguments);
    command.on_call([arguments, &exit_code] { exit_code = cli::run_scene(*arguments); });
}

}  // namespace ricochet
