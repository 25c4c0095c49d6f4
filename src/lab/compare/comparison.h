/// \file
/// A comparison: one scene with several answers to collisions at several time steps, what each costs and gets wrong.
/// docs/compare.md says what every number means.
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
    double time_step = 0.0;  ///< s
    bool listed = true;      ///< false: exact was not asked for and is only the base of ratios
    RunFigures figures;
    ReferenceErrors errors;
    RunCost cost;
    /// s, the step of exact that ratio_at_equal_error divides by; nothing when no step of it is as good.
    std::optional<double> equal_error_step;
};

/// The run that all are measured against: exact at a fine step.
struct ComparisonReference {
    RunFigures figures;
    double energy_scale = 0.0;   ///< J, what energy errors are divided by
    bool has_potential = false;  ///< energies are kinetic plus potential; false: kinetic only
};

/// Everything that a comparison finds.
struct Comparison {
    ComparisonPlan plan;
    SimulationOptions options;  ///< the scene's own
    ComparisonReference reference;
    std::vector<ComparisonRow> rows;  ///< responses in the order of the plan, of each the steps from long to short

    /// The rows that were asked for, in their order.
    [[nodiscard]] std::vector<const ComparisonRow*> listed_rows() const;
};

/// Where a comparison is.
struct ComparisonProgress {
    std::size_t run = 0;   ///< number of the present run, from 1
    std::size_t runs = 0;  ///< in all
    std::string response;
    double time_step = 0.0;    ///< s
    std::uint32_t repeat = 0;  ///< of a timed run, from 1; 0: a measured one
    std::uint64_t step = 0;    ///< steps done of this run
    std::uint64_t steps = 0;   ///< in all
};

/// Called after every step of every run; false ends the comparison.
using ComparisonHook = std::function<bool(const ComparisonProgress&)>;

/// Runs nothing: throws InputError, one line, for a setup that cannot work, or that refuses a response of the plan; the
/// line names that one and the responses that are left.
void require_comparable(SimulationSetup setup, const ComparisonPlan& plan);

/// Runs the plan on a scene: the reference and every row once with all checks on, then the timed runs, one after the
/// other within a repeat so that noise hits all alike. Nothing when the hook has ended it. The numbers apart from the
/// costs are the same every time. Throws InputError as require_comparable() does, before anything runs, and RunError
/// when a timed run ends in another state than the measured one.
[[nodiscard]] std::optional<Comparison> compare_responses(SimulationSetup setup, const ComparisonPlan& plan,
                                                          const ComparisonHook& hook = {});

}  // namespace ricochet
