#include "lab/study/study_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <system_error>

#include "lab/compare/gnuplot.h"

namespace ricochet {
namespace {

using SummaryJson = nlohmann::json;

/// Returns a value of a CSV table, in quotes if it contains a character with a meaning.
std::string csv_cell(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

/// Returns the text of an axis value without the quotes of a JSON text.
std::string plain(const std::string& json_text) {
    const SummaryJson value = SummaryJson::parse(json_text, nullptr, false);
    return value.is_string() ? value.get<std::string>() : json_text;
}

std::string number_text(double value) { return std::isnan(value) ? "" : fmt::format("{:.17g}", value); }

/// Returns the member of an object, or the entry of a list with this name or index. Null if there is none.
const SummaryJson* member_of(const SummaryJson& json, const std::string& name) {
    if (json.is_object()) {
        const auto found = json.find(name);
        return found == json.end() ? nullptr : &*found;
    }
    if (!json.is_array()) return nullptr;
    for (const SummaryJson& entry : json) {
        if (entry.is_object() && entry.value("name", SummaryJson()) == SummaryJson(name)) return &entry;
    }
    std::size_t index = 0;
    const auto [stop, error] = std::from_chars(name.data(), name.data() + name.size(), index);
    const bool is_index = error == std::errc{} && stop == name.data() + name.size() && index < json.size();
    return is_index ? &json[index] : nullptr;
}

/// Returns the value at a path, or null. Names can contain points, so a point may or may not end a name.
const SummaryJson* value_at(const SummaryJson& json, const std::string& path) {
    for (std::size_t end = path.find('.'); end != std::string::npos; end = path.find('.', end + 1)) {
        const SummaryJson* const member = member_of(json, path.substr(0, end));
        if (member == nullptr) continue;
        if (const SummaryJson* const found = value_at(*member, path.substr(end + 1))) return found;
    }
    return member_of(json, path);
}

StudyMean mean_of(const std::vector<double>& values) {
    if (values.empty()) return {std::numeric_limits<double>::quiet_NaN(), std::nullopt};
    const auto count = static_cast<double>(values.size());
    double sum = 0.0;
    for (const double value : values) sum += value;
    StudyMean result{sum / count, std::nullopt};
    if (values.size() < 2) return result;
    double squares = 0.0;
    for (const double value : values) squares += (value - result.mean) * (value - result.mean);
    result.error = std::sqrt(squares / (count * (count - 1.0)));
    return result;
}

/// Returns the position of a case along the first axis: its value, or the number of the value if it is no number.
double abscissa_of(const StudyPlan& plan, const StudyRow& row) {
    const StudyAxis& axis = plan.axes.front();
    const auto number = [](const std::string& text) { return SummaryJson::parse(text, nullptr, false); };
    const bool is_numeric =
        std::ranges::all_of(axis.values, [&](const auto& text) { return number(text).is_number(); });
    if (is_numeric) return number(row.values.front()).get<double>();
    return static_cast<double>(std::ranges::find(axis.values, row.values.front()) - axis.values.begin());
}

/// Returns a text of a gnuplot script in quotes, in which no character has a meaning.
std::string gnuplot_text(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
    return quoted + "'";
}

/// Lines of a picture: the rows that differ only in the first axis, by the values of the other axes.
std::map<std::string, std::vector<const StudyRow*>> lines_of(const StudyPlan& plan, const std::vector<StudyRow>& rows) {
    std::map<std::string, std::vector<const StudyRow*>> lines;
    for (const StudyRow& row : rows) {
        std::string name;
        for (std::size_t k = 1; k < plan.axes.size(); ++k) {
            name += fmt::format("{}{} = {}", k > 1 ? ", " : "", plan.axes[k].key, plain(row.values[k]));
        }
        if (row.runs > 0) lines[name].push_back(&row);
    }
    return lines;
}

}  // namespace

std::optional<double> number_in_summary(const std::string& summary, const std::string& path) {
    const SummaryJson root = SummaryJson::parse(summary, nullptr, false);
    const SummaryJson* const at = value_at(root, path);
    if (at == nullptr || !(at->is_number() || at->is_boolean())) return std::nullopt;
    return at->is_boolean() ? static_cast<double>(at->get<bool>()) : at->get<double>();
}

std::vector<StudyRow> study_rows(const StudyPlan& plan, const std::vector<StudyRun>& runs,
                                 const std::vector<StudyOutcome>& outcomes) {
    std::vector<StudyRow> rows;
    std::vector<std::vector<double>> values(plan.results.size());
    for (std::size_t k = 0; k < runs.size(); ++k) {
        if (rows.empty() || rows.back().study_case != runs[k].study_case) {
            rows.push_back({runs[k].study_case, runs[k].values, 0, 0, {}});
            for (auto& list : values) list.clear();
        }
        const bool is_failed = !outcomes[k].failure.empty();
        ++(is_failed ? rows.back().failed : rows.back().runs);
        for (std::size_t r = 0; r < plan.results.size() && !is_failed; ++r) values[r].push_back(outcomes[k].results[r]);
        rows.back().results.clear();
        for (const auto& list : values) rows.back().results.push_back(mean_of(list));
    }
    return rows;
}

std::string study_csv(const StudyPlan& plan, const std::vector<StudyRow>& rows) {
    std::string text = "case";
    for (const StudyAxis& axis : plan.axes) text += "," + csv_cell(axis.key);
    text += ",runs,failed";
    for (const std::string& result : plan.results) text += "," + csv_cell(result) + "," + csv_cell(result + "_error");
    text += "\n";
    for (const StudyRow& row : rows) {
        text += std::to_string(row.study_case);
        for (const std::string& value : row.values) text += "," + csv_cell(plain(value));
        text += fmt::format(",{},{}", row.runs, row.failed);
        for (const StudyMean& result : row.results) {
            text += "," + number_text(result.mean) + "," + (result.error ? number_text(*result.error) : "");
        }
        text += "\n";
    }
    return text;
}

std::string study_runs_csv(const StudyPlan& plan, const std::vector<StudyRun>& runs,
                           const std::vector<StudyOutcome>& outcomes) {
    std::string text = "run,case,repeat";
    for (const StudyAxis& axis : plan.axes) text += "," + csv_cell(axis.key);
    for (const std::string& result : plan.results) text += "," + csv_cell(result);
    text += ",failure\n";
    for (std::size_t k = 0; k < runs.size(); ++k) {
        text += fmt::format("{},{},{}", runs[k].number, runs[k].study_case, runs[k].repeat);
        for (const std::string& value : runs[k].values) text += "," + csv_cell(plain(value));
        for (std::size_t r = 0; r < plan.results.size(); ++r) {
            text += "," + (outcomes[k].failure.empty() ? number_text(outcomes[k].results[r]) : std::string());
        }
        text += "," + csv_cell(outcomes[k].failure) + "\n";
    }
    return text;
}

std::vector<std::string> study_pictures(const StudyPlan& plan) {
    std::vector<std::string> names;
    for (std::size_t k = 1; k <= plan.results.size(); ++k) names.push_back(fmt::format("study_{}.png", k));
    return names;
}

std::string study_script(const StudyPlan& plan, const std::vector<StudyRow>& rows) {
    const auto lines = lines_of(plan, rows);
    std::string text = gnuplot_start("Results of a study. `gnuplot study.gp` in this folder draws them.");
    text += gnuplot_line_styles(lines.size());
    text += fmt::format("set xlabel {} noenhanced\n", gnuplot_text(plan.axes.front().key));
    const std::vector<std::string> pictures = study_pictures(plan);
    for (std::size_t r = 0; r < plan.results.size() && !lines.empty(); ++r) {
        std::string plots;
        std::size_t number = 0;
        for (const auto& [name, list] : lines) {
            text += fmt::format("$line{}_{} << END\n", r, ++number);
            for (const StudyRow* row : list) {
                const StudyMean& result = row->results[r];
                text += fmt::format("{:.9g} {:.9g} {:.9g}\n", abscissa_of(plan, *row), result.mean,
                                    result.error.value_or(0.0));
            }
            text += "END\n";
            plots += fmt::format("{} $line{}_{} using 1:2:3 with yerrorlines linestyle {} title {}",
                                 number > 1 ? "," : "plot", r, number, number, gnuplot_text(name));
        }
        text += fmt::format("set ylabel {} noenhanced\nset output '{}'.ending\n{}\n", gnuplot_text(plan.results[r]),
                            pictures[r], plots);
    }
    return text;
}

}  // namespace ricochet
