#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "lab/compare/comparison_files.h"
#include "lab/compare/gnuplot.h"
#include "run/run_folder.h"

namespace ricochet {
namespace {

/// Picture whose horizontal axis is the time step.
struct StepPlot {
    const char* file;
    const char* title;
    const char* label;   // label of the vertical axis
    const char* column;  // name of the column with the values
    bool logarithmic;
};

constexpr std::array kStepPlots{
    StepPlot{"cost.png", "Cost per particle-step", "ns per particle-step", "cost_ns_per_particle_step", true},
    StepPlot{"error_position.png", "Distance from the reference at the end", "rms distance [m]", "position_error_rms",
             true},
    StepPlot{"error_impact.png", "Error of the time of the first impact", "median error [s]", "impact_error_median",
             true},
    StepPlot{"penetration.png", "Largest depth behind a surface", "depth [m]", "penetration_deepest", true},
    StepPlot{"tunnelled.png", "Particles that went through a surface", "particles tunnelled", "tunnelled", false},
};

constexpr std::size_t kMostTics = 8;

struct Values {
    std::vector<double> positive;  // values above 0
    bool any = false;              // true: at least one value is finite
};

double value_of(const ComparisonRow& row, const Comparison& comparison, const char* column) {
    return number_of(comparison_columns()[column_index(column)].cell(row, comparison));
}

void add_values(const ComparisonRow& row, const Comparison& comparison, const char* column, Values& values) {
    const double value = value_of(row, comparison, column);
    if (!std::isfinite(value)) return;
    values.any = true;
    if (value > 0.0) values.positive.push_back(value);
}

std::string script_start(const Comparison& comparison) {
    return gnuplot_start("Draws the pictures of a comparison: gnuplot compare.gp, in the folder of compare.dat.") +
           gnuplot_line_styles(comparison.plan.responses.size());
}

/// Returns commands for the axis of time steps. If there are at most kMostTics time steps, each step has a tick.
std::string step_axis(const std::vector<double>& steps) {
    constexpr double kMargin = 1.3;
    std::string text = fmt::format("set xlabel 'time step [s]'\nset logscale x\nset xrange [{:.6g}:{:.6g}]\n",
                                   steps.back() / kMargin, steps.front() * kMargin);
    if (steps.size() > kMostTics) return text + "set xtics autofreq\nset format x '%g'\n";
    std::string tics;
    for (const double step : steps) tics += fmt::format("{}'{:.4g}' {:.17g}", tics.empty() ? "" : ", ", step, step);
    return text + "set xtics (" + tics + ")\n";
}

/// Returns commands for the axis of values. A logarithmic axis covers whole decades, so that it has labels for any
/// values. If no value is above 0, the axis is linear.
std::string value_axis(const Values& values, bool logarithmic) {
    if (values.positive.empty()) return "unset logscale y\nset yrange [-0.05:1]\n";
    const auto [least, most] = std::minmax_element(values.positive.begin(), values.positive.end());
    if (!logarithmic) return fmt::format("unset logscale y\nset yrange [0:{:.6g}]\n", 1.1 * *most);
    const double lower = std::floor(std::log10(*least) - 0.05);
    const double upper = std::max(std::ceil(std::log10(*most) + 0.05), lower + 1.0);
    return fmt::format("set logscale y\nset yrange [1e{:.0f}:1e{:.0f}]\n", lower, upper);
}

/// Returns the plot command for the curve of one response. If the curve has no points, the key shows the response's
/// name with the reason.
std::string curve(const Comparison& comparison, std::size_t index, const StepPlot& plot, bool logarithmic) {
    Values values;
    const std::string name = name_of(comparison.plan.responses[index]);
    for (const ComparisonRow* row : comparison.rows_of(comparison.plan.responses[index])) {
        add_values(*row, comparison, plot.column, values);
    }
    const char* const reason = !values.any ? " (none)" : values.positive.empty() ? " (0 everywhere)" : "";
    if (!values.any || (logarithmic && values.positive.empty())) {
        return fmt::format("NaN with linespoints linestyle {} title '{}{}'", index + 1, name, reason);
    }
    const std::size_t column = column_index(plot.column) + 1;
    const std::string y = logarithmic ? fmt::format("(${0} > 0 ? ${0} : NaN)", column) : fmt::format("{}", column);
    return fmt::format("'{}' index {} using 2:{} with linespoints linestyle {} title '{}{}'", kComparisonPointsFile,
                       index, y, index + 1, name, reason);
}

std::string step_plot(const Comparison& comparison, const StepPlot& plot) {
    Values values;
    for (const ComparisonRow* row : comparison.listed_rows()) add_values(*row, comparison, plot.column, values);
    const bool logarithmic = plot.logarithmic && !values.positive.empty();
    std::string text =
        fmt::format("\nset output '{}'.ending\nset title '{}'\nset ylabel '{}'\n", plot.file, plot.title, plot.label);
    text += value_axis(values, plot.logarithmic) + "plot ";
    for (std::size_t i = 0; i < comparison.plan.responses.size(); ++i) {
        text += (i == 0 ? "" : ", \\\n     ") + curve(comparison, i, plot, logarithmic);
    }
    return text + "\nset output\n";
}

std::string energy_plot(const Comparison& comparison) {
    std::string text = fmt::format(
        "\nset output 'energy_time.png'.ending\nset title 'Energy against the reference, step {:.4g} s'\n"
        "set xlabel 'time [s]'\nset ylabel 'energy error / energy scale'\n"
        "unset logscale\nset xtics autofreq\nset xrange [0:{:.17g}]\nset yrange [*:*]\nplot ",
        comparison.plan.shown_step, comparison.options.duration);
    std::size_t drawn = 0;
    const std::vector<const ComparisonRow*> rows = comparison.listed_rows();
    for (std::size_t block = 0; block < rows.size(); ++block) {
        if (rows[block]->time_step != comparison.plan.shown_step) continue;
        const std::string name = name_of(rows[block]->response);
        const bool has_points = std::any_of(rows[block]->errors.energy.begin(), rows[block]->errors.energy.end(),
                                            [](const EnergyPoint& point) { return std::isfinite(point.error); });
        ++drawn;
        text += drawn == 1 ? "" : ", \\\n     ";
        text += has_points ? fmt::format("'{}' index {} using 1:2 with lines linestyle {} title '{}'",
                                         kComparisonEnergyFile, block, drawn, name)
                           : fmt::format("NaN with lines linestyle {} title '{} (none)'", drawn, name);
    }
    return text + "\nset output\n";
}

}  // namespace

std::string comparison_script(const Comparison& comparison) {
    std::string text = script_start(comparison) + step_axis(comparison.plan.time_steps);
    for (const StepPlot& plot : kStepPlots) text += step_plot(comparison, plot);
    return text + energy_plot(comparison);
}

}  // namespace ricochet
