#include "ricochet/compare/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/compare/detail/measured_run.h"
#include "ricochet/compare/detail/reference.h"
#include "ricochet/compare/detail/setup_copies.h"
#include "ricochet/compare/detail/timed_run.h"
#include "ricochet/core/error.h"

namespace ricochet {
namespace {

using detail::SetupCopies;
using detail::StepHook;

constexpr ResponseChoice kExact{ResponseKind::exact, false};

/// Works through a plan.
class Comparer {
public:
    Comparer(SimulationSetup setup, const ComparisonPlan& plan, const ComparisonHook& hook)
        : copies_(std::move(setup)), hook_(hook) {
        result_.plan = plan;
        result_.options = copies_.options();
        for (const ResponseChoice& response : plan.responses) add_rows(response, true);
        const bool has_exact = std::find(plan.responses.begin(), plan.responses.end(), kExact) != plan.responses.end();
        if (!has_exact) add_rows(kExact, false);
        progress_.runs = 1 + result_.rows.size() * (1 + plan.repeats);
    }

    std::optional<Comparison> run() {
        if (!measure() || !take_times()) return std::nullopt;
        settle_costs();
        return std::move(result_);
    }

private:
    void add_rows(const ResponseChoice& response, bool listed) {
        for (const double step : result_.plan.time_steps) {
            ComparisonRow row;
            row.response = response;
            row.time_step = step;
            row.listed = listed;
            result_.rows.push_back(std::move(row));
        }
    }

    [[nodiscard]] SimulationSetup setup_for(const ResponseChoice& response, double time_step) const {
        return copies_.make(options_for(copies_.options(), response, time_step));
    }

    /// What every run is called with; tells the hook which run it is.
    StepHook next_run(const ResponseChoice& response, double time_step, std::uint32_t repeat) {
        ++progress_.run;
        progress_.response = name_of(response);
        progress_.time_step = time_step;
        progress_.repeat = repeat;
        return [this](const Simulation& simulation) {
            progress_.step = simulation.step_index();
            progress_.steps = simulation.step_count();
            return !hook_ || hook_(progress_);
        };
    }

    bool measure() {
        const double step = result_.plan.reference_step;
        const auto reference = detail::measure_run(setup_for(kExact, step), next_run(kExact, step, 0));
        if (!reference) return false;
        result_.reference = {reference->figures, detail::energy_scale(reference->trace),
                             reference->trace.has_potential};
        return std::all_of(result_.rows.begin(), result_.rows.end(), [&](ComparisonRow& row) {
            const auto run =
                detail::measure_run(setup_for(row.response, row.time_step), next_run(row.response, row.time_step, 0));
            if (!run) return false;
            row.figures = run->figures;
            row.errors = detail::errors_against(run->trace, reference->trace);
            return true;
        });
    }

    bool take_times() {
        for (std::uint32_t repeat = 1; repeat <= result_.plan.repeats; ++repeat) {
            for (const double step : result_.plan.time_steps) {
                for (ComparisonRow& row : result_.rows) {
                    if (row.time_step == step && !take_time(row, repeat)) return false;
                }
            }
        }
        return true;
    }

    bool take_time(ComparisonRow& row, std::uint32_t repeat) {
        const auto run =
            detail::time_run(setup_for(row.response, row.time_step), next_run(row.response, row.time_step, repeat));
        if (!run) return false;
        if (run->state_hash != row.figures.state_hash) {
            throw RunError(
                fmt::format("{} at {} s ends in the state {:016x} when it is timed and in {:016x} when it is "
                            "measured; the comparison would compare different things",
                            name_of(row.response), row.time_step, run->state_hash, row.figures.state_hash));
        }
        row.cost.seconds_each.push_back(run->seconds);
        return true;
    }

    void settle_costs() {
        std::vector<const ComparisonRow*> exact;
        for (const ComparisonRow& row : result_.rows) {
            if (row.response == kExact) exact.push_back(&row);
        }
        for (ComparisonRow& row : result_.rows) {
            const auto equal = std::find_if(exact.begin(), exact.end(), [&](const ComparisonRow* candidate) {
                return candidate->time_step == row.time_step;
            });
            detail::settle_cost(row, **equal, exact);
        }
    }

    SetupCopies copies_;
    const ComparisonHook& hook_;
    Comparison result_;
    ComparisonProgress progress_;
};

}  // namespace

std::vector<const ComparisonRow*> Comparison::listed_rows() const {
    std::vector<const ComparisonRow*> listed;
    for (const ComparisonRow& row : rows) {
        if (row.listed) listed.push_back(&row);
    }
    return listed;
}

std::optional<Comparison> compare_responses(SimulationSetup setup, const ComparisonPlan& plan,
                                            const ComparisonHook& hook) {
    return Comparer(std::move(setup), plan, hook).run();
}

}  // namespace ricochet
