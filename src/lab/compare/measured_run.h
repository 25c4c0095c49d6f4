/// \file
/// Measured and timed runs of a comparison, and errors of a measured run relative to the reference.
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

/// Identity of a particle that is the same in every run of a scene: its emitter and lineage, or its id if it comes from
/// no emitter.
struct ParticleKey {
    std::uint32_t emitter = kNoEmitter;
    std::uint64_t number = 0;

    friend auto operator<=>(const ParticleKey&, const ParticleKey&) = default;
};

/// Data of a run for its comparison with the reference. Vectors of particle data have one entry per particle id, and
/// not one per step.
struct RunTrace {
    std::vector<double> times;    ///< in s, ascending: 0, and the end of every step
    std::vector<double> kinetic;  ///< in J, at `times`
    /// Kinetic plus potential energy, in J, at `times`; recorded while has_potential is true.
    std::vector<double> total;
    bool has_potential = true;         ///< true: the potential energy was defined at all times
    std::vector<double> first_impact;  ///< time of the first impact, in s; kNoNumber without an impact
    std::vector<std::uint8_t> alive;   ///< 1 if the particle exists at the end of the run
    std::vector<Vec3> end_position;    ///< in m; only valid for particles that are alive
    /// Keys of the particles, or empty if particles do not spawn children. With children, ids depend on the time step,
    /// but keys do not.
    std::vector<ParticleKey> keys;

    /// Returns the total energy if the potential energy is defined, otherwise the kinetic energy.
    [[nodiscard]] const std::vector<double>& energy() const { return has_potential ? total : kinetic; }
};

struct MeasuredRun {
    RunFigures figures;
    RunTrace trace;
};

/// Function that is called after every step. If it returns false, the run ends.
using StepHook = std::function<bool(const Simulation&)>;

/// Runs a simulation to the end with verification and contact records. Returns std::nullopt if the hook ends the run.
[[nodiscard]] std::optional<MeasuredRun> measure_run(SimulationSetup setup, const StepHook& go_on);

// Timed runs without checks, and the costs of a row.

/// Result of a timed run.
struct TimedRun {
    double seconds = 0.0;  ///< time in Simulation::advance(), without the hook, over the whole run
    std::uint64_t state_hash = 0;
};

/// Runs a simulation to the end without verification and contact records. The time of the hook does not count. Returns
/// std::nullopt if the hook ends the run.
[[nodiscard]] std::optional<TimedRun> time_run(SimulationSetup setup, const StepHook& go_on);

/// Returns the median of a[k] / b[k] over the repeats k.
[[nodiscard]] double ratio_of_times(const std::vector<double>& a, const std::vector<double>& b);

/// Returns the row of the response `exact` with the longest time step whose error is not larger than the error of
/// `row`. The error is the root mean square of ReferenceErrors::position. If this is missing in one of the two rows,
/// the median of ReferenceErrors::impact is compared instead. Returns a null pointer if no row of that response is as
/// accurate. `exact` contains the rows of that response in order of descending time step.
[[nodiscard]] const ComparisonRow* equally_good(const ComparisonRow& row,
                                                const std::vector<const ComparisonRow*>& exact);

/// Computes the costs of a row from its times. `at_equal_step` is the row of the response `exact` at the same time
/// step. `exact` is the list that equally_good() takes.
void settle_cost(ComparisonRow& row, const ComparisonRow& at_equal_step,
                 const std::vector<const ComparisonRow*>& exact);

// Errors of a run relative to the reference. Energies are compared at equal times, and first impacts and final
// positions for the same particles.

/// Returns the value of a time series at `time`, by linear interpolation. Beyond both ends, the series is constant.
/// `times` must be ascending and not empty.
[[nodiscard]] double interpolate(std::span<const double> times, std::span<const double> values, double time);

/// Returns the divisor of energy errors, in J. The divisor is the larger of two values: the difference between the
/// reference's largest and smallest energy, and its largest kinetic energy.
[[nodiscard]] double energy_scale(const RunTrace& reference);

/// Returns the errors of a run. Particles of both runs correspond if their keys are equal. Without keys, particles
/// correspond if their ids are equal, because the times of births then do not depend on the time step.
[[nodiscard]] ReferenceErrors errors_against(const RunTrace& run, const RunTrace& reference);

}  // namespace ricochet
