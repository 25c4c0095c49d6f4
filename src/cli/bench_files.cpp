#include "cli/bench_files.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "cli/interrupts.h"
#include "cli/terminal.h"
#include "lab/bench/cases.h"
#include "lab/compare/gnuplot.h"
#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"

namespace ricochet::cli {

BenchResults::BenchResults(const std::filesystem::path& folder, bench::Environment environment)
    : folder_(folder / environment.machine), environment_(std::move(environment)) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (!error && ::access(folder_.c_str(), W_OK | X_OK) != 0) error.assign(errno, std::generic_category());
    if (error) {
        throw InputError(fmt::format("--results {}: {} is not a writable folder ({}); choose another one",
                                     folder.string(), folder_.string(), error.message()));
    }
}

std::string BenchResults::write(const std::string& suite, std::vector<bench::Record> records,
                                const std::string& plot_script) const {
    const bench::Record environment = record_of(environment_);
    for (bench::Record& record : records) record.insert(record.end(), environment.begin(), environment.end());
    const std::string script = suite + ".gp";
    write_file(folder_ / (suite + ".csv"), bench::to_csv(records));
    write_file(folder_ / script, plot_script);
    return draw_with_gnuplot(folder_, script, {suite + ".png"}, [] { return InterruptGuard::signal() != 0; });
}

namespace {

using bench::LoadRow;
using bench::Row;

constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
constexpr double kNanosecondsPerSecond = 1e9;

/// One curve or one set of bars.
template <class AnyRow>
struct Series {
    std::string title;
    std::function<double(const AnyRow&)> value;  // value to draw; NaN leaves a gap
};

double or_nothing(const std::optional<double>& number) { return number.value_or(kNothing); }

std::string number_text(double number) { return std::isfinite(number) ? fmt::format("{:.6g}", number) : "nan"; }

std::string start(std::string_view suite, std::size_t styles, std::string_view title) {
    return gnuplot_start(fmt::format("Draws {0}.png: gnuplot {0}.gp", suite)) + gnuplot_line_styles(styles) +
           fmt::format("set output '{}.png'.ending\nset title '{}'\nset key outside top center horizontal\n", suite,
                       title);
}

/// Returns a gnuplot data block: the first column, then one column for each series.
template <class AnyRow>
std::string block(std::span<const AnyRow> rows, const std::function<std::string(const AnyRow&)>& first,
                  const std::vector<Series<AnyRow>>& series) {
    std::string text = "$numbers << EOD\n";
    for (const AnyRow& row : rows) {
        text += first(row);
        for (const auto& s : series) text += fmt::format(" {}", number_text(s.value(row)));
        text += '\n';
    }
    return text + "EOD\n";
}

struct Axes {
    const char* title;
    const char* x;
    const char* y;
    const char* scales;  // gnuplot commands for both axes
};

std::string lines(std::string_view suite, std::span<const Row> rows, const Axes& axes,
                  const std::function<double(const Row&)>& x, const std::vector<Series<Row>>& series) {
    std::string text = start(suite, series.size(), axes.title);
    text += fmt::format("set xlabel '{}'\nset ylabel '{}'\n{}", axes.x, axes.y, axes.scales);
    text += block<Row>(
                rows, [&](const Row& row) { return number_text(x(row)); }, series) +
            "plot ";
    for (std::size_t i = 0; i < series.size(); ++i) {
        text += fmt::format("{}$numbers using 1:{} with linespoints linestyle {} title '{}'",
                            i == 0 ? "" : ", \\\n     ", i + 2, i + 1, series[i].title);
    }
    return text + "\nset output\n";
}

/// Returns the commands for an axis with one named tick per row.
template <class AnyRow>
std::string name_axis(std::span<const AnyRow> rows) {
    std::string tics;
    for (std::size_t i = 0; i < rows.size(); ++i) {
        tics += fmt::format("{}'{}' {}", tics.empty() ? "" : ", ", rows[i].name, i);
    }
    const double end = static_cast<double>(rows.size()) - 0.4;
    return fmt::format("set xtics ({}) rotate by -30 noenhanced\nset xrange [-0.6:{:.4g}]\n", tics, end);
}

/// Returns the commands of a bar chart. A group of bars shows one row. Each bar is labelled with its value. with_one
/// adds a line at 1.
template <class AnyRow>
std::string bars(std::string_view suite, std::span<const AnyRow> rows, std::string_view title, std::string_view y,
                 const std::vector<Series<AnyRow>>& series, bool with_one) {
    const double count = static_cast<double>(series.size());
    const double width = 1.0 / (count + 1.0);  // the gap between two groups is one bar wide
    std::string text = start(suite, series.size(), title);
    text += fmt::format(
        "set ylabel '{}'\nset style fill solid 0.85 noborder\nset grid noxtics\nset boxwidth {:.4g}\n"
        "set yrange [0:*]\nset offsets 0,0,graph 0.05,0\n",
        y, width);
    text += name_axis(rows);
    const auto name = [](const AnyRow& row) { return fmt::format("\"{}\"", row.name); };
    text += block<AnyRow>(rows, name, series) + "plot ";
    for (std::size_t i = 0; i < series.size(); ++i) {
        const double shift = (static_cast<double>(i) - 0.5 * (count - 1.0)) * width;
        text += fmt::format(
            "{4}$numbers using ($0+({0:.4g})):{1} with boxes linestyle {2} title '{3}', \\\n"
            "     $numbers using ($0+({0:.4g})):{1}:(sprintf('%.2g',column({1}))) with labels offset 0,0.6 font ',10' "
            "notitle",
            shift, i + 2, i + 1, series[i].title, i == 0 ? "" : ", \\\n     ");
    }
    if (with_one) text += ", \\\n     1 with lines linecolor '#404040' dashtype 2 notitle";
    return text + "\nset output\n";
}

/// Returns the rows with the most threads.
template <class AnyRow>
std::vector<AnyRow> with_most_threads(std::span<const AnyRow> rows) {
    int most = 0;
    for (const AnyRow& row : rows) most = std::max(most, row.threads);
    std::vector<AnyRow> chosen;
    std::copy_if(rows.begin(), rows.end(), std::back_inserter(chosen),
                 [&](const AnyRow& row) { return row.threads == most; });
    return chosen;
}

std::string size_plot(std::span<const Row> rows) {
    const Axes axes{"Cost of a particle-step on meshes of growing size", "triangles", "ns",
                    "set logscale x\nset format x '10^{%L}'\nset yrange [0:*]\n"};
    return lines("size", rows, axes, [](const Row& row) { return static_cast<double>(row.triangles); },
                 {{"ricochet: a step of a particle",
                   [](const Row& row) { return kNanosecondsPerSecond / row.particle_steps_per_second; }},
                  {"bare ray", [](const Row& row) { return kNanosecondsPerSecond / row.raw_rays_per_second; }}});
}

std::string count_plot(std::span<const Row> rows) {
    const Axes axes{"Rates with growing numbers of particles", "particles", "millions a second",
                    "set logscale x\nset format x '10^{%L}'\nset yrange [0:*]\n"};
    constexpr double kMillion = 1e6;
    return lines(
        "count", rows, axes, [](const Row& row) { return static_cast<double>(row.particles); },
        {{"ricochet: steps of particles", [](const Row& row) { return row.particle_steps_per_second / kMillion; }},
         {"bare rays", [](const Row& row) { return row.raw_rays_per_second / kMillion; }}});
}

/// Returns the commands for the axes of a speedup plot. Both axes are logarithmic to base 2. The x axis has ticks at
/// the measured thread counts.
std::string threads_axis(std::span<const Row> rows) {
    constexpr double kMargin = 1.1;
    std::set<int> counts;
    for (const Row& row : rows) counts.insert(row.threads);
    return fmt::format(
        "set xlabel 'threads'\nset ylabel 'times as fast as one thread'\nset logscale xy 2\nset xtics ({})\n"
        "set xrange [{:.4g}:{:.4g}]\n",
        fmt::join(counts, ", "), *counts.begin() / kMargin, *counts.rbegin() * kMargin);
}

/// Returns a speedup plot. Each case has a solid curve for the simulation, and a dashed curve for the bare rays (Embree
/// alone).
std::string threads_plot(std::span<const Row> rows) {
    std::vector<std::string> names;
    for (const Row& row : rows) {
        if (std::find(names.begin(), names.end(), row.name) == names.end()) names.push_back(row.name);
    }
    std::string text = start("threads", names.size(), "Speedup over one thread") + threads_axis(rows);
    std::string curves;
    for (std::size_t i = 0; i < names.size(); ++i) {
        text += fmt::format("$case{} << EOD\n", i);
        for (const Row& row : rows) {
            if (row.name != names[i]) continue;
            text += fmt::format("{} {} {}\n", row.threads, number_text(or_nothing(row.speedup)),
                                number_text(or_nothing(row.speedup_raw)));
        }
        text += "EOD\n";
        curves += fmt::format(
            ", \\\n     $case{0} using 1:2 with linespoints linestyle {1} title '{2}'"
            ", \\\n     $case{0} using 1:3 with linespoints linestyle {1} dashtype 2 title '{2}, bare rays'",
            i, i + 1, names[i]);
    }
    return text + "plot x with lines linecolor '#a0a0a0' title 'ideal'" + curves + "\nset output\n";
}

std::string ratios_plot(std::string_view suite, std::span<const Row> rows) {
    return bars<Row>(
        suite, rows, fmt::format("Suite {}: rates relative to plain Embree", suite), "ratio",
        {{"particle-steps / bare rays", [](const Row& row) { return row.ratio_raw; }},
         {"particle-steps / sorted packets of rays", [](const Row& row) { return row.ratio_raw_sorted; }},
         {"impacts / native bounces", [](const Row& row) { return or_nothing(row.ratio_native_bounces); }}},
        true);
}

}  // namespace

std::string plot_script(std::string_view suite, std::span<const Row> all_rows) {
    if (suite == bench::kThreadsSuite) return threads_plot(all_rows);
    const std::vector<Row> rows = with_most_threads(all_rows);
    if (suite == "size") return size_plot(rows);
    if (suite == "count") return count_plot(rows);
    if (suite == "radius") {
        return bars<Row>(suite, rows, "Cost of spheres", "cost of a particle-step over that of points",
                         {{"cost over points", [](const Row& row) { return or_nothing(row.ratio_points); }}}, true);
    }
    if (suite == "response") {
        return bars<Row>(suite, rows, "Cost of the responses", "cost of a particle-step over the exact response",
                         {{"cost over exact", [](const Row& row) { return or_nothing(row.ratio_exact); }}}, true);
    }
    if (suite == "moving") {
        return bars<Row>(suite, rows, "Cost of moving colliders", "cost of a particle-step over that at rest",
                         {{"cost over rest", [](const Row& row) { return or_nothing(row.ratio_rest); }}}, true);
    }
    if (suite == "pairs") {
        return bars<Row>(
            suite, rows, "Cost of spheres in contact", "seconds for a simulated second",
            {{"s / simulated s", [](const Row& row) { return or_nothing(row.seconds_a_simulated_second); }}}, true);
    }
    return ratios_plot(suite, rows);
}

std::string plot_script(std::span<const LoadRow> all_rows) {
    const std::vector<LoadRow> rows = with_most_threads(all_rows);
    const auto millions = [](const LoadRow& row, double seconds) {
        return static_cast<double>(row.triangles) / seconds * 1e-6;
    };
    return bars<LoadRow>(
        bench::kLoadSuite, rows, "From a mesh file to a world that particles can collide with",
        "million triangles a second",
        {{"reading, one thread", [&](const LoadRow& row) { return millions(row, row.read_seconds); }},
         {"building, all threads", [&](const LoadRow& row) { return millions(row, row.build_seconds); }}},
        false);
}

}  // namespace ricochet::cli
