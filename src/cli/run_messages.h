/// \file
/// Messages of a run: progress and final report.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "cli/terminal.h"
#include "ricochet/simulation.h"
#include "run/run_report.h"

namespace ricochet::cli {

/// Returns the seconds since a time. The result is never negative.
[[nodiscard]] double seconds_since(std::chrono::steady_clock::time_point start);

/// Progress of all processes of a run together.
struct RunCounts {
    std::uint64_t particles = 0;
    std::uint64_t particle_steps = 0;  ///< number of steps of all particles since the start of the run
};

/// The progress line of a run. Steps get slower as particles are emitted, so the remaining time is estimated from the
/// latest steps.
class RunProgress {
public:
    RunProgress(bool quiet, Progress progress) : line_(quiet, progress) {}

    /// Updates the line. `output_share` is the share of output in the elapsed time.
    void show(const Simulation& simulation, const RunCounts& counts, double output_share);

private:
    using Clock = std::chrono::steady_clock;

    ProgressLine line_;
    Clock::time_point last_time_ = Clock::now();
    std::uint64_t last_step_ = 0;
    std::uint64_t last_particle_steps_ = 0;
    double seconds_per_step_ = 0.0;
};

/// Prints the final report on standard output. `output` is the run's folder.
void print_report(const RunSummary& summary, const std::string& output);
/// Prints warnings about wrong results and incomplete files. These warnings are printed even with --quiet.
void print_losses(const std::string& scene, const SimulationStatistics& statistics);
/// Prints the violations that a run with --verify has found. Returns true if it has found any.
bool print_violations(const Simulation& simulation);

}  // namespace ricochet::cli
