/// \file
/// One run with all checks on: its figures, and what is needed to hold it against the reference.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "ricochet/compare/figures.h"
#include "ricochet/core/vec3.h"
#include "ricochet/simulation.h"

namespace ricochet::detail {

/// What is kept of a run until it has been compared. Lists by particle have one entry an id; no histories.
struct RunTrace {
    std::vector<double> times;         ///< s, ascending: 0 and the end of every step
    std::vector<double> kinetic;       ///< J, at these times
    std::vector<double> total;         ///< J, kinetic plus potential; as long as has_potential
    bool has_potential = true;         ///< the potential was defined all along
    std::vector<double> first_impact;  ///< s; kNoNumber without one
    std::vector<std::uint8_t> alive;   ///< at the end
    std::vector<Vec3> end_position;    ///< m; of those alive

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

}  // namespace ricochet::detail
