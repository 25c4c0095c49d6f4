/// \file
/// A comparison runs one scene with several collision responses at several time steps. It measures the costs and the
/// errors of each. docs/compare.md explains every number.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "lab/compare/figures.h"
#include "lab/compare/plan.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// A response at a time step.
struct ComparisonRow {
    ResponseChoice response;
    double time_step = 0.0;  ///< in s
    bool listed = true;      ///< false: exact was not requested and is only the base of ratios
    RunFigures figures;
    ReferenceErrors errors;
    RunCost cost;
    /// Time step, in s, of the exact run that ratio_at_equal_error divides by; nothing if no exact run is as accurate.
    std::optional<double> equal_error_step;
};

/// The reference run for all errors: exact at a fine step.
struct ComparisonReference {
    RunFigures figures;
    double energy_scale = 0.0;   ///< in J, divisor of energy errors
    bool has_potential = false;  ///< true: energies are kinetic plus potential; false: kinetic only
};

/// Results of a comparison.
struct Comparison {
    ComparisonPlan plan;
    SimulationOptions options;  ///< options of the scene
    ComparisonReference reference;
    std::vector<ComparisonRow> rows;  ///< in the order of the plan's responses, each from long to short steps

    /// Returns the requested rows, in their order.
    [[nodiscard]] std::vector<const ComparisonRow*> listed_rows() const;
    /// Returns the requested rows of one response, in their order.
    [[nodiscard]] std::vector<const ComparisonRow*> rows_of(const ResponseChoice& response) const;
};

/// Progress of a comparison.
struct ComparisonProgress {
    std::size_t run = 0;   ///< number of the present run, from 1
    std::size_t runs = 0;  ///< number of all runs
    std::string response;
    double time_step = 0.0;    ///< in s
    std::uint32_t repeat = 0;  ///< number of a timed run, from 1; 0: a measured run
    std::uint64_t step = 0;    ///< completed steps of this run
    std::uint64_t steps = 0;   ///< all steps of this run
};

/// Function called after every step of every run. If it returns false, the comparison ends.
using ComparisonHook = std::function<bool(const ComparisonProgress&)>;

/// Checks a comparison without running it. Throws InputError, with a message of one line, for an invalid setup or one
/// that refuses a response of the plan. The message names that response and the remaining ones.
void require_comparable(SimulationSetup setup, const ComparisonPlan& plan);

/// Runs the plan on a scene: the reference and every row once with all checks on, then the timed runs. Each repeat runs
/// all rows one after the other, so that noise affects all rows alike. Returns nothing if the hook has ended it. All
/// numbers except the costs are reproducible. Throws InputError as require_comparable() does, before the first run.
/// Throws RunError if a timed run ends in another state than the measured one.
[[nodiscard]] std::optional<Comparison> compare_responses(SimulationSetup setup, const ComparisonPlan& plan,
                                                          const ComparisonHook& hook = {});

}  // namespace ricochet
