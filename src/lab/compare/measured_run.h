/// \file
/// One run with all checks on: its figures, and what is needed to hold it against the reference.
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

/// Names a particle in every run of a scene: by the lineage of those that emitters make, by the id of the others.
struct ParticleKey {
    std::uint32_t emitter = kNoEmitter;
    std::uint64_t number = 0;

    friend auto operator<=>(const ParticleKey&, const ParticleKey&) = default;
};

/// What is kept of a run until it has been compared. Lists by particle have one entry an id; no histories.
struct RunTrace {
    std::vector<double> times;         ///< s, ascending: 0 and the end of every step
    std::vector<double> kinetic;       ///< J, at these times
    std::vector<double> total;         ///< J, kinetic plus potential; as long as has_potential
    bool has_potential = true;         ///< the potential was defined all along
    std::vector<double> first_impact;  ///< s; kNoNumber without one
    std::vector<std::uint8_t> alive;   ///< at the end
    std::vector<Vec3> end_position;    ///< m; of those alive
    /// Where particles spawn others: who each is, whatever its id, which depends on the time step then. Else empty.
    std::vector<ParticleKey> keys;

    /// What the energy of this run is: total where there is a potential, else kinetic.
    [[nodiscard]] const std::vector<double>& energy() const { return has_potential ? total : kinetic; }
};

struct MeasuredRun {
    RunFigures figures;
    RunTrace trace;
};

/// Called after every step; false ends the run.
using StepHook = std::function<bool(const Simulation&)>;

/// Runs to the end with verification and contact records on. Nothing when the hook has ended it.
[[nodiscard]] std::optional<MeasuredRun> measure_run(SimulationSetup setup, const StepHook& go_on);

// One run for its time only, and what the times of a row come to.

/// What a timed run gives.
struct TimedRun {
    double seconds = 0.0;  ///< of Simulation::advance() alone, over the whole run
    std::uint64_t state_hash = 0;
};

/// Runs to the end without verification and records. Nothing when the hook, whose time does not count, has ended it.
[[nodiscard]] std::optional<TimedRun> time_run(SimulationSetup setup, const StepHook& go_on);

/// The median of a / b over the repeats.
[[nodiscard]] double ratio_of_times(const std::vector<double>& a, const std::vector<double>& b);

/// The longest step of exact whose error is no larger than the row's: the root mean square of the distances at the end;
/// where the row or exact has none, the median error of the first impacts. Nothing when there is no such step. exact:
/// rows of the exact response by descending step.
[[nodiscard]] const ComparisonRow* equally_good(const ComparisonRow& row,
                                                const std::vector<const ComparisonRow*>& exact);

/// Fills the costs of a row from its times. at_equal_step: exact's row at the same step.
void settle_cost(ComparisonRow& row, const ComparisonRow& at_equal_step,
                 const std::vector<const ComparisonRow*>& exact);

// One run against the reference: energies at equal times, first impacts and last positions of equal particles.

/// Value at `time` of a series given at ascending times, linear between them and constant beyond both ends. Not empty.
[[nodiscard]] double interpolate(std::span<const double> times, std::span<const double> values, double time);

/// What energy errors are divided by, J: the largest rise of the reference's energy over its minimum, or its largest
/// kinetic energy where that is larger.
[[nodiscard]] double energy_scale(const RunTrace& reference);

/// A particle is the same one where the keys are; without keys where the ids are, since the schedule of births does not
/// depend on the time step.
[[nodiscard]] ReferenceErrors errors_against(const RunTrace& run, const RunTrace& reference);

}  // namespace ricochet
