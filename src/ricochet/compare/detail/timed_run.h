/// \file
/// One run for its time only, and what the times of a row come to.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "ricochet/compare/comparison.h"
#include "ricochet/compare/detail/measured_run.h"

namespace ricochet::detail {

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

}  // namespace ricochet::detail
