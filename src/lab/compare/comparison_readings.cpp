#include "lab/compare/comparison_readings.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace ricochet {
namespace {

using Rows = std::vector<const ComparisonRow*>;
using Number = double (*)(const ComparisonRow& row);

std::string with_unit(double number, const char* unit) {
    return std::isfinite(number) ? fmt::format("{} {}", short_text(number), unit) : "none";
}

std::string joined(const std::vector<std::string>& parts) {
    std::string text;
    for (const std::string& part : parts) text += (text.empty() ? "" : "; ") + part;
    return text;
}

/// Returns a text with one part per response, separated by semicolons.
std::string for_each_response(const Comparison& comparison, const std::function<std::string(const Rows&)>& part_of) {
    std::vector<std::string> parts;
    for (const ResponseChoice& response : comparison.plan.responses) {
        parts.push_back(fmt::format("{} {}", name_of(response), part_of(comparison.rows_of(response))));
    }
    return joined(parts);
}

/// Returns a text with one part per response. Each part describes the row at ComparisonPlan::shown_step.
std::string at_shown_step(const Comparison& comparison,
                          const std::function<std::string(const ComparisonRow&)>& part_of) {
    return for_each_response(comparison, [&](const Rows& rows) {
        for (const ComparisonRow* row : rows) {
            if (row->time_step == comparison.plan.shown_step) return part_of(*row);
        }
        return std::string("none");
    });
}

std::string cost_reading(const Comparison& comparison) {
    return fmt::format("With a step of {:.4g} s a particle-step takes: {}.", comparison.plan.shown_step,
                       at_shown_step(comparison, [](const ComparisonRow& row) {
                           return fmt::format("{} ({} times exact)", with_unit(row.cost.ns_per_particle_step, "ns"),
                                              short_text(row.cost.ratio_at_equal_step));
                       }));
}

/// Returns the values at the longest and the shortest time step as text. If both are above 0, adds the exponent p for
/// which step^p is proportional to the values.
std::string trend(const Rows& rows, Number number, const char* unit) {
    const double from = number(*rows.front());
    const double to = number(*rows.back());
    if (rows.size() == 1) return with_unit(from, unit);
    std::string text = fmt::format("{} to {}", with_unit(from, unit), with_unit(to, unit));
    if (from > 0.0 && to > 0.0) {
        const double power = std::log(from / to) / std::log(rows.front()->time_step / rows.back()->time_step);
        text += fmt::format(" (step^{:.1f})", power + 0.0);
    }
    return text;
}

std::string trends(const Comparison& comparison, const char* what, Number number, const char* unit) {
    const std::vector<double>& steps = comparison.plan.time_steps;
    const std::string when =
        steps.size() == 1
            ? fmt::format("With a step of {:.4g} s", steps.front())
            : fmt::format("From the longest step, {:.4g} s, to the shortest, {:.4g} s,", steps.front(), steps.back());
    return fmt::format("{} {}: {}.", when, what,
                       for_each_response(comparison, [&](const Rows& rows) { return trend(rows, number, unit); }));
}

std::string position_reading(const Comparison& comparison) {
    return trends(
        comparison, "the rms distance from the reference is",
        [](const ComparisonRow& row) { return row.errors.position.root_mean_square; }, "m");
}

std::string impact_reading(const Comparison& comparison) {
    std::string text = trends(
        comparison, "the median error of the first impact's time is",
        [](const ComparisonRow& row) { return row.errors.impact.median; }, "s");
    std::vector<std::string> parts;
    for (const ComparisonRow* row : comparison.listed_rows()) {
        if (row->errors.impacts_missed + row->errors.impacts_extra == 0) continue;
        parts.push_back(fmt::format("{} at {:.4g} s {} and {}", name_of(row->response), row->time_step,
                                    row->errors.impacts_missed, row->errors.impacts_extra));
    }
    if (parts.empty()) return text + " Every run has a first impact for the same particles as the reference.";
    return text + fmt::format(
                      " Particles whose impact is missing, and particles with one that the reference does not "
                      "have: {}.",
                      joined(parts));
}

std::string energy_reading(const Comparison& comparison) {
    return fmt::format(
        "With a step of {:.4g} s the largest energy error, and the last, as parts of the energy scale: {}.",
        comparison.plan.shown_step, at_shown_step(comparison, [](const ComparisonRow& row) {
            return fmt::format("{} and {}", short_text(row.errors.energy_largest), short_text(row.errors.energy_final));
        }));
}

std::string penetration_reading(const Comparison& comparison) {
    std::vector<std::string> parts;
    std::vector<std::string> never;
    for (const ResponseChoice& response : comparison.plan.responses) {
        const ComparisonRow* deepest = nullptr;
        for (const ComparisonRow* row : comparison.rows_of(response)) {
            const double depth = row->figures.statistics.penetration_deepest;
            if (depth > 0.0 && (!deepest || depth > deepest->figures.statistics.penetration_deepest)) deepest = row;
        }
        if (deepest == nullptr) {
            never.push_back(name_of(response));
        } else {
            parts.push_back(fmt::format("{} {} m, with a step of {:.4g} s", name_of(response),
                                        short_text(deepest->figures.statistics.penetration_deepest),
                                        deepest->time_step));
        }
    }
    std::string text;
    if (!parts.empty()) text += fmt::format("Largest depths behind a surface: {}.", joined(parts));
    if (!never.empty())
        text += fmt::format("{}Never seen behind a surface: {}.", text.empty() ? "" : " ", joined(never));
    return text;
}

std::string tunnel_reading(const Comparison& comparison) {
    std::vector<std::string> parts;
    for (const ComparisonRow* row : comparison.listed_rows()) {
        if (row->figures.tunnel.tunnelled == 0) continue;
        parts.push_back(fmt::format("{} at {:.4g} s {} of {}", name_of(row->response), row->time_step,
                                    row->figures.tunnel.tunnelled, row->figures.statistics.emitted));
    }
    if (parts.empty()) return "No particle went through a surface in any run.";
    return fmt::format("Particles that went through a surface: {}. In all other runs none did.", joined(parts));
}

}  // namespace

std::string short_text(double number) { return std::isfinite(number) ? fmt::format("{:.3g}", number) : "-"; }

std::string describe_picture(const std::string& picture, const Comparison& comparison) {
    if (picture == "cost.png") return cost_reading(comparison);
    if (picture == "error_position.png") return position_reading(comparison);
    if (picture == "error_impact.png") return impact_reading(comparison);
    if (picture == "energy_time.png") return energy_reading(comparison);
    if (picture == "penetration.png") return penetration_reading(comparison);
    if (picture == "tunnelled.png") return tunnel_reading(comparison);
    throw std::invalid_argument("a comparison has no picture " + picture);
}

}  // namespace ricochet
