#include "lab/compare/comparison_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <variant>

#include "ricochet/core/hash.h"
#include "ricochet/response/settings_table.h"

namespace ricochet {

namespace {

using Row = ComparisonRow;

// Defines a column. `value` is an expression of `row` and of the comparison `all`. This is a macro, because lambda
// expressions would repeat the same types forty times.
#define RICOCHET_COLUMN(name, value)                                                                          \
    ComparisonColumn {                                                                                        \
        name, []([[maybe_unused]] const Row& row, [[maybe_unused]] const Comparison& all) -> ComparisonCell { \
            return value;                                                                                     \
        }                                                                                                     \
    }
#define RICOCHET_COUNT(name, value) RICOCHET_COLUMN(name, static_cast<std::uint64_t>(value))

const std::vector<ComparisonColumn>& make_columns() {
    static const std::vector<ComparisonColumn> columns = {
        RICOCHET_COLUMN("response", name_of(row.response)),
        RICOCHET_COLUMN("time_step", row.time_step),
        RICOCHET_COUNT("steps", row.figures.statistics.steps),
        RICOCHET_COUNT("particle_steps", row.figures.statistics.particle_steps),
        RICOCHET_COUNT("emitted", row.figures.statistics.emitted),
        RICOCHET_COUNT("alive", row.figures.alive),
        RICOCHET_COUNT("alive_reference", all.reference.figures.alive),
        RICOCHET_COUNT("tunnelled", row.figures.tunnel.tunnelled),
        RICOCHET_COUNT("wrong_side", row.figures.tunnel.wrong_side),
        RICOCHET_COUNT("penetrating", row.figures.tunnel.penetrating),
        RICOCHET_COUNT("jumped", row.figures.tunnel.jumped),
        RICOCHET_COUNT("passed", row.figures.tunnel.passed),
        RICOCHET_COUNT("penetrations", row.figures.statistics.penetrations),
        RICOCHET_COLUMN("penetration_share", row.figures.penetration_share()),
        RICOCHET_COLUMN("penetration_mean", row.figures.statistics.penetration_mean()),
        RICOCHET_COLUMN("penetration_deepest", row.figures.statistics.penetration_deepest),
        RICOCHET_COLUMN("energy_error_max", row.errors.energy_largest),
        RICOCHET_COLUMN("energy_error_final", row.errors.energy_final),
        RICOCHET_COUNT("impacts_compared", row.errors.impact.count),
        RICOCHET_COLUMN("impact_error_median", row.errors.impact.median),
        RICOCHET_COLUMN("impact_error_p95", row.errors.impact.percentile_95),
        RICOCHET_COLUMN("impact_error_max", row.errors.impact.largest),
        RICOCHET_COUNT("impacts_missed", row.errors.impacts_missed),
        RICOCHET_COUNT("impacts_extra", row.errors.impacts_extra),
        RICOCHET_COUNT("positions_compared", row.errors.position.count),
        RICOCHET_COLUMN("position_error_median", row.errors.position.median),
        RICOCHET_COLUMN("position_error_rms", row.errors.position.root_mean_square),
        RICOCHET_COLUMN("position_error_max", row.errors.position.largest),
        RICOCHET_COUNT("contacts", row.figures.statistics.contacts),
        RICOCHET_COUNT("bounces_per_step_max", row.figures.statistics.bounces_per_step_max),
        RICOCHET_COLUMN("unsimulated_time", row.figures.statistics.unsimulated_time),
        RICOCHET_COUNT("resting", row.figures.statistics.resting),
        RICOCHET_COUNT("frozen", row.figures.statistics.frozen),
        RICOCHET_COUNT("trials", row.figures.statistics.trials),
        RICOCHET_COUNT("warnings", row.figures.warnings.size()),
        RICOCHET_COLUMN("state_hash", hash_text(row.figures.state_hash)),
        RICOCHET_COLUMN("equal_error_step", row.equal_error_step.value_or(kNoNumber)),
        RICOCHET_COLUMN("cost_seconds", row.cost.seconds),
        RICOCHET_COLUMN("cost_ns_per_particle_step", row.cost.ns_per_particle_step),
        RICOCHET_COLUMN("cost_ns_per_contact", row.cost.ns_per_contact),
        RICOCHET_COLUMN("cost_ratio_equal_step", row.cost.ratio_at_equal_step),
        RICOCHET_COLUMN("cost_ratio_equal_error", row.cost.ratio_at_equal_error),
    };
    return columns;
}

#undef RICOCHET_COUNT
#undef RICOCHET_COLUMN

}  // namespace

const std::vector<ComparisonColumn>& comparison_columns() { return make_columns(); }

std::size_t column_index(const std::string& name) {
    const auto& columns = comparison_columns();
    const auto found =
        std::find_if(columns.begin(), columns.end(), [&](const ComparisonColumn& c) { return name == c.name; });
    if (found == columns.end()) throw std::invalid_argument("a comparison has no column " + name);
    return static_cast<std::size_t>(found - columns.begin());
}

double number_of(const ComparisonCell& cell) {
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return static_cast<double>(*count);
    const auto* number = std::get_if<double>(&cell);
    return number != nullptr ? *number : kNoNumber;
}

std::string hash_text(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

namespace {

using Json = nlohmann::ordered_json;

Json json_of(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json json_of(const ComparisonCell& cell) {
    if (const auto* number = std::get_if<double>(&cell)) return json_of(*number);
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return *count;
    return std::get<std::string>(cell);
}

void add_settings(Json& json, const auto& settings, const auto& table) {
    const auto json_of_value = [](const auto& value) {
        if constexpr (requires { value.has_value(); }) return value ? Json(*value) : Json(nullptr);
        if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) return Json(value);
        return Json();
    };
    for (const auto& line : table) json[std::string(line.name)] = std::visit(json_of_value, value_of(line, settings));
}

Json json_of(const ResponseChoice& response, const SimulationOptions& scene) {
    const SimulationOptions options = options_for(scene, response, scene.time_step);
    Json json = {{"name", name_of(response)}};
    if (response.kind == ResponseKind::rollback) add_settings(json, options.rollback, kRollbackTable);
    if (response.kind == ResponseKind::project) add_settings(json, options.project, kProjectTable);
    if (response.kind == ResponseKind::penalty) add_settings(json, options.penalty, kPenaltyTable);
    return json;
}

Json settings_json(const Comparison& comparison, const ComparisonSource& source) {
    const SimulationOptions& options = comparison.options;
    Json json;
    json["version"] = source.version;
    json["scene"] = source.scene;
    json["overrides"] = source.overrides;
    json["threads"] = source.threads;
    json["seed"] = options.seed;
    json["integrator"] = name_of(options.integrator.kind);
    json["duration"] = options.duration;
    json["scene_time_step"] = options.time_step;
    json["resting_speed"] = options.resting_speed;
    json["bounce_budget"] = options.bounce_budget;
    json["repeats"] = comparison.plan.repeats;
    json["time_steps"] = comparison.plan.time_steps;
    json["responses"] = Json::array();
    for (const auto& response : comparison.plan.responses) json["responses"].push_back(json_of(response, options));
    json["state_hash_algorithm"] = StateHash::kName;
    return json;
}

Json reference_json(const Comparison& comparison) {
    const ComparisonReference& reference = comparison.reference;
    Json json;
    json["response"] = name_of(ResponseKind::exact);
    json["time_step"] = comparison.plan.reference_step;
    json["steps"] = reference.figures.statistics.steps;
    json["alive"] = reference.figures.alive;
    json["contacts"] = reference.figures.statistics.contacts;
    json["tunnelled"] = reference.figures.tunnel.tunnelled;
    json["energy"] = reference.has_potential ? "kinetic and potential" : "kinetic";
    json["energy_scale"] = json_of(reference.energy_scale);
    json["state_hash"] = hash_text(reference.figures.state_hash);
    return json;
}

Json row_json(const ComparisonRow& row, const Comparison& comparison) {
    Json json;
    for (const ComparisonColumn& column : comparison_columns())
        json[column.name] = json_of(column.cell(row, comparison));
    json["warnings"] = row.figures.warnings;  // the texts replace the number of warnings
    json["cost_seconds_each"] = row.cost.seconds_each;
    return json;
}

std::string text_of(const ComparisonCell& cell, const char* none) {
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return fmt::format("{}", *count);
    const double number = std::get<double>(cell);
    return std::isfinite(number) ? fmt::format("{}", number) : none;
}

std::string line_of(const ComparisonRow& row, const Comparison& comparison, char separator, const char* none) {
    std::string line;
    for (const ComparisonColumn& column : comparison_columns()) {
        if (!line.empty()) line += separator;
        line += text_of(column.cell(row, comparison), none);
    }
    return line;
}

std::string header(char separator) {
    std::string line;
    for (const ComparisonColumn& column : comparison_columns()) {
        if (!line.empty()) line += separator;
        line += column.name;
    }
    return line;
}

}  // namespace

std::string comparison_json(const Comparison& comparison, const ComparisonSource& source) {
    Json json;
    json["settings"] = settings_json(comparison, source);
    json["reference"] = reference_json(comparison);
    json["rows"] = Json::array();
    json["base"] = Json::array();  // rows of `exact`, if `exact` was not requested
    for (const ComparisonRow& row : comparison.rows) {
        json[row.listed ? "rows" : "base"].push_back(row_json(row, comparison));
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// Cells need no quotes, because they contain no commas, quotes or line breaks.
std::string comparison_csv(const Comparison& comparison) {
    std::string text = header(',') + "\r\n";
    for (const ComparisonRow* row : comparison.listed_rows()) text += line_of(*row, comparison, ',', "") + "\r\n";
    return text;
}

std::string comparison_points(const Comparison& comparison) {
    std::string text = "# " + header(' ') + "\n";
    const ComparisonRow* before = nullptr;
    for (const ComparisonRow* row : comparison.listed_rows()) {
        if (before != nullptr && before->response != row->response) text += "\n\n";
        text += line_of(*row, comparison, ' ', "nan") + "\n";
        before = row;
    }
    return text;
}

std::string comparison_energies(const Comparison& comparison) {
    std::string text;
    for (const ComparisonRow* row : comparison.listed_rows()) {
        if (!text.empty()) text += "\n\n";
        text += fmt::format("# {}, step {} s: time (s), energy error\n", name_of(row->response), row->time_step);
        if (row->errors.energy.empty()) text += "nan nan\n";
        for (const EnergyPoint& point : row->errors.energy) {
            text += fmt::format("{:.17g} {:.17g}\n", point.time, point.error);
        }
    }
    return text;
}

}  // namespace ricochet
