#include "ricochet/compare/detail/timed_run.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <utility>

#include "ricochet/compare/detail/error_spread.h"

namespace ricochet::detail {
namespace {

constexpr double kNanoseconds = 1e9;

double per_count(double seconds, std::uint64_t count) {
    return count == 0 ? kNoNumber : kNanoseconds * seconds / static_cast<double>(count);
}

bool is_as_good(const ReferenceErrors& exact, const ReferenceErrors& row) {
    if (row.position.count > 0 && exact.position.count > 0) {
        return exact.position.root_mean_square <= row.position.root_mean_square;
    }
    return exact.impact.median <= row.impact.median;  // false where there is none
}

}  // namespace

std::optional<TimedRun> time_run(SimulationSetup setup, const StepHook& go_on) {
    using Clock = std::chrono::steady_clock;
    setup.options.verify = false;
    setup.options.record_contacts = false;
    Simulation simulation(std::move(setup));
    bool goes_on = true;
    Clock::duration asked{};
    const auto ask = [&] {
        const Clock::time_point start = Clock::now();
        goes_on = go_on(simulation);
        asked += Clock::now() - start;
        return goes_on;
    };
    const Clock::time_point start = Clock::now();
    simulation.advance(simulation.step_count(), ask);
    const Clock::duration spent = Clock::now() - start - asked;
    if (!goes_on) return std::nullopt;
    return TimedRun{std::chrono::duration<double>(spent).count(), simulation.state_hash()};
}

double ratio_of_times(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> ratios;
    for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) ratios.push_back(a[k] / b[k]);
    return median(ratios);
}

const ComparisonRow* equally_good(const ComparisonRow& row, const std::vector<const ComparisonRow*>& exact) {
    const auto found = std::find_if(exact.begin(), exact.end(), [&](const ComparisonRow* candidate) {
        return is_as_good(candidate->errors, row.errors);
    });
    return found == exact.end() ? nullptr : *found;
}

void settle_cost(ComparisonRow& row, const ComparisonRow& at_equal_step,
                 const std::vector<const ComparisonRow*>& exact) {
    RunCost& cost = row.cost;
    cost.seconds = median(cost.seconds_each);
    cost.ns_per_particle_step = per_count(cost.seconds, row.figures.statistics.particle_steps);
    cost.ns_per_contact = per_count(cost.seconds, row.figures.statistics.contacts);
    cost.ratio_at_equal_step = ratio_of_times(cost.seconds_each, at_equal_step.cost.seconds_each);
    if (const ComparisonRow* const equal = equally_good(row, exact)) {
        cost.ratio_at_equal_error = ratio_of_times(cost.seconds_each, equal->cost.seconds_each);
        row.equal_error_step = equal->time_step;
    }
}

}  // namespace ricochet::detail
