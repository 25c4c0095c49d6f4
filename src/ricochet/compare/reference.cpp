#include "ricochet/compare/reference.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "ricochet/compare/figures.h"

namespace ricochet {
namespace {

/// True for the steps that a series of at most kMostEnergyPoints keeps: the first, the last, evenly between.
bool is_kept(std::size_t step, std::size_t count) {
    if (count <= kMostEnergyPoints || step == 0) return true;
    const std::size_t intervals = kMostEnergyPoints - 1;
    return step * intervals / (count - 1) != (step - 1) * intervals / (count - 1);
}

void add_energy_errors(const RunTrace& run, const RunTrace& reference, ReferenceErrors& errors) {
    const bool has_potential = run.has_potential && reference.has_potential;
    const std::vector<double>& energy = has_potential ? run.total : run.kinetic;
    const std::vector<double>& expected = has_potential ? reference.total : reference.kinetic;
    const double scale = energy_scale(reference);
    if (!(scale > 0.0)) return;
    errors.energy_largest = 0.0;
    for (std::size_t k = 0; k < energy.size(); ++k) {
        const double error = (energy[k] - interpolate(reference.times, expected, run.times[k])) / scale;
        if (std::isnan(error) || std::fabs(error) > errors.energy_largest) errors.energy_largest = std::fabs(error);
        errors.energy_final = error;
        if (is_kept(k, energy.size())) errors.energy.push_back({run.times[k], error});
    }
}

void add_impact_errors(const RunTrace& run, const RunTrace& reference, ReferenceErrors& errors) {
    const std::size_t count = std::max(run.first_impact.size(), reference.first_impact.size());
    const auto first = [](const RunTrace& trace, std::size_t id) {
        return id < trace.first_impact.size() ? trace.first_impact[id] : kNoNumber;
    };
    std::vector<double> differences;
    for (std::size_t id = 0; id < count; ++id) {
        const double here = first(run, id);
        const double there = first(reference, id);
        if (std::isnan(here) && !std::isnan(there)) ++errors.impacts_missed;
        if (!std::isnan(here) && std::isnan(there)) ++errors.impacts_extra;
        if (!std::isnan(here) && !std::isnan(there)) differences.push_back(std::fabs(here - there));
    }
    errors.impact = spread_of(differences);
}

void add_position_errors(const RunTrace& run, const RunTrace& reference, ReferenceErrors& errors) {
    const std::size_t count = std::min(run.alive.size(), reference.alive.size());
    std::vector<double> distances;
    for (std::size_t id = 0; id < count; ++id) {
        if (run.alive[id] == 0 || reference.alive[id] == 0) continue;
        const double distance = length(run.end_position[id] - reference.end_position[id]);
        if (std::isfinite(distance)) distances.push_back(distance);
    }
    errors.position = spread_of(distances);
}

}  // namespace

double interpolate(std::span<const double> times, std::span<const double> values, double time) {
    const auto after = std::lower_bound(times.begin(), times.end(), time);
    if (after == times.begin()) return values.front();
    if (after == times.end()) return values.back();
    const auto k = static_cast<std::size_t>(after - times.begin());
    const double share = (time - times[k - 1]) / (times[k] - times[k - 1]);
    return share == 1.0 ? values[k] : values[k - 1] + share * (values[k] - values[k - 1]);
}

double energy_scale(const RunTrace& reference) {
    const std::vector<double>& energy = reference.energy();
    const auto [least, most] = std::minmax_element(energy.begin(), energy.end());
    return std::max(*most - *least, *std::max_element(reference.kinetic.begin(), reference.kinetic.end()));
}

ReferenceErrors errors_against(const RunTrace& run, const RunTrace& reference) {
    ReferenceErrors errors;
    add_energy_errors(run, reference, errors);
    add_impact_errors(run, reference, errors);
    add_position_errors(run, reference, errors);
    return errors;
}

}  // namespace ricochet
