/// \file
/// Comparison of collision responses on one scene. The scene runs with each response at each of several time steps. The
/// comparison measures the cost and the errors of each run. docs/compare.md explains every number.
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

/// Results of one response at one time step.
struct ComparisonRow {
    ResponseChoice response;
    double time_step = 0.0;  ///< in s
    bool listed = true;      ///< false: row of `exact` that was not requested; its time is only a divisor of ratios
    RunFigures figures;
    ReferenceErrors errors;
    RunCost cost;
    /// Time step, in s, of the run with `exact` whose time is the divisor of RunCost::ratio_at_equal_error.
    /// std::nullopt if no run with `exact` is as accurate.
    std::optional<double> equal_error_step;
};

/// Reference run for all errors. It uses the response `exact` and a small time step.
struct ComparisonReference {
    RunFigures figures;
    double energy_scale = 0.0;   ///< in J, divisor of energy errors
    bool has_potential = false;  ///< true: energies are kinetic plus potential energy; false: only kinetic energy
};

/// Results of a comparison.
struct Comparison {
    ComparisonPlan plan;
    SimulationOptions options;  ///< options of the scene
    ComparisonReference reference;
    /// In the order of the plan's responses, and from long to short time steps for each response.
    std::vector<ComparisonRow> rows;

    /// Returns the requested rows, in their order.
    [[nodiscard]] std::vector<const ComparisonRow*> listed_rows() const;
    /// Returns the requested rows of one response, in their order.
    [[nodiscard]] std::vector<const ComparisonRow*> rows_of(const ResponseChoice& response) const;
};

/// Progress of a comparison.
struct ComparisonProgress {
    std::size_t run = 0;   ///< number of the current run, from 1
    std::size_t runs = 0;  ///< number of all runs
    std::string response;
    double time_step = 0.0;    ///< in s
    std::uint32_t repeat = 0;  ///< number of the repeat of a timed run, from 1; 0: a measured run
    std::uint64_t step = 0;    ///< completed steps of the current run
    std::uint64_t steps = 0;   ///< all steps of the current run
};

/// Function called after every step of every run. If it returns false, the comparison ends.
using ComparisonHook = std::function<bool(const ComparisonProgress&)>;

/// Checks a comparison without running it. Throws InputError, with a message of one line, if the setup is invalid or
/// cannot run with a response of the plan. In the second case, the message names this response and lists the accepted
/// responses.
void require_comparable(SimulationSetup setup, const ComparisonPlan& plan);

/// Runs the plan on a scene. The reference and every row first run once with all checks on. The timed runs follow. Each
/// repeat runs all rows one after the other, so that noise affects all rows alike. Returns std::nullopt if the hook
/// ends the comparison. All numbers except the costs are reproducible. Before the first run, throws InputError like
/// require_comparable(). Throws RunError if the final states of a row's timed run and measured run differ.
[[nodiscard]] std::optional<Comparison> compare_responses(SimulationSetup setup, const ComparisonPlan& plan,
                                                          const ComparisonHook& hook = {});

}  // namespace ricochet
