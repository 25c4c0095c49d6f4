/// \file
/// One run with all checks on: its results, and the data for its comparison with the reference.
#pragma once

#include <compare>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "lab/compare/comparison.h"
#include "lab/compare/figures.h"
#include "ricochet/core/vec3.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Name of a particle in every run of a scene: its lineage if it comes from an emitter, otherwise its id.
struct ParticleKey {
    std::uint32_t emitter = kNoEmitter;
    std::uint64_t number = 0;

    friend auto operator<=>(const ParticleKey&, const ParticleKey&) = default;
};

/// Data of a run that are kept until it has been compared. Lists by particle have one entry per id; they contain no
/// histories.
struct RunTrace {
    std::vector<double> times;         ///< in s, ascending: 0 and the end of every step
    std::vector<double> kinetic;       ///< in J, at these times
    std::vector<double> total;         ///< in J, kinetic plus potential; recorded as long as has_potential
    bool has_potential = true;         ///< true: the potential was defined at all times
    std::vector<double> first_impact;  ///< in s; kNoNumber without one
    std::vector<std::uint8_t> alive;   ///< true at the end of the run
    std::vector<Vec3> end_position;    ///< in m; of particles alive
    /// Keys of the particles, if particles spawn others; otherwise empty. Ids depend on the time step then, keys do
    /// not.
    std::vector<ParticleKey> keys;

    /// Returns the energy of this run: total energy if there is a potential, otherwise kinetic energy.
    [[nodiscard]] const std::vector<double>& energy() const { return has_potential ? total : kinetic; }
};

struct MeasuredRun {
    RunFigures figures;
    RunTrace trace;
};

/// Function called after every step. If it returns false, the run ends.
using StepHook = std::function<bool(const Simulation&)>;

/// Runs a simulation to the end with verification and contact records on. Returns nothing if the hook has ended it.
[[nodiscard]] std::optional<MeasuredRun> measure_run(SimulationSetup setup, const StepHook& go_on);

// One run for its time only, and the costs of a row.

/// Result of a timed run.
struct TimedRun {
    double seconds = 0.0;  ///< of Simulation::advance() alone, over the whole run
    std::uint64_t state_hash = 0;
};

/// Runs a simulation to the end without verification and records. The time of the hook is not counted. Returns nothing
/// if the hook has ended it.
[[nodiscard]] std::optional<TimedRun> time_run(SimulationSetup setup, const StepHook& go_on);

/// Returns the median of a / b over the repeats.
[[nodiscard]] double ratio_of_times(const std::vector<double>& a, const std::vector<double>& b);

/// Returns the exact row with the longest step whose error is no larger than the row's. The error is the root mean
/// square of the distances at the end. If either row has no such distances, the median error of the first impacts is
/// compared. Returns nothing if there is no such step. `exact` contains the rows of the exact response by descending
/// step.
[[nodiscard]] const ComparisonRow* equally_good(const ComparisonRow& row,
                                                const std::vector<const ComparisonRow*>& exact);

/// Computes the costs of a row from its times. `at_equal_step` is exact's row at the same step.
void settle_cost(ComparisonRow& row, const ComparisonRow& at_equal_step,
                 const std::vector<const ComparisonRow*>& exact);

// Errors of one run against the reference: energies at equal times, first impacts and last positions of equal
// particles.

/// Returns the value at `time` of a series given at ascending times. It is interpolated linearly and constant beyond
/// both ends. The series must not be empty.
[[nodiscard]] double interpolate(std::span<const double> times, std::span<const double> values, double time);

/// Returns the divisor of energy errors, in J. It is the larger of two values: the largest rise of the reference's
/// energy over its minimum, and its largest kinetic energy.
[[nodiscard]] double energy_scale(const RunTrace& reference);

/// Returns the errors of a run. Particles correspond if their keys are equal. Without keys they correspond if their ids
/// are equal, because the schedule of births does not depend on the time step.
[[nodiscard]] ReferenceErrors errors_against(const RunTrace& run, const RunTrace& reference);

}  // namespace ricochet
