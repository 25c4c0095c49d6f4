/// \file
/// What a run says: while it goes on, and at its end.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "cli/terminal.h"
#include "ricochet/io/run_report.h"
#include "ricochet/simulation.h"

namespace ricochet::cli {

/// s since then; not below 0: a clock may be put back under a run that goes on for days.
[[nodiscard]] double seconds_since(std::chrono::steady_clock::time_point start);

/// How far all processes of a run have come together.
struct RunCounts {
    std::uint64_t particles = 0;
    std::uint64_t particle_steps = 0;  ///< since its first step
};

/// The progress line of a run. Steps cost more as particles are born, so the time left is told from the latest steps.
class RunProgress {
public:
    RunProgress(bool quiet, Progress progress) : line_(quiet, progress) {}

    /// output_share: of the run's time so far.
    void show(const Simulation& simulation, const RunCounts& counts, double output_share);

private:
    using Clock = std::chrono::steady_clock;

    ProgressLine line_;
    Clock::time_point last_time_ = Clock::now();
    std::uint64_t last_step_ = 0;
    std::uint64_t last_particle_steps_ = 0;
    double seconds_per_step_ = 0.0;
};

/// What has come out, on standard output. output: the run's folder.
void print_report(const RunSummary& summary, const std::string& output);
/// What makes results wrong or files incomplete, as warnings: also where nothing else is told.
void print_losses(const std::string& scene, const SimulationStatistics& statistics);
/// Lists what a verified run found wrong. Returns whether there was anything.
bool print_violations(const Simulation& simulation);

}  // namespace ricochet::cli
