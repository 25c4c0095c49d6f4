#include "ricochet/compare/comparison_files.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "ricochet/compare/detail/columns.h"
#include "ricochet/core/hash.h"

namespace ricochet {
namespace {

using detail::Cell;
using detail::Column;
using Json = nlohmann::ordered_json;

Json json_of(double number) { return std::isfinite(number) ? Json(number) : Json(nullptr); }

Json json_of(const Cell& cell) {
    if (const auto* number = std::get_if<double>(&cell)) return json_of(*number);
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return *count;
    return std::get<std::string>(cell);
}

Json json_of(const ResponseChoice& response, const SimulationOptions& scene) {
    const SimulationOptions options = options_for(scene, response, scene.time_step);
    Json json = {{"name", name_of(response)}};
    switch (response.kind) {
        case ResponseKind::exact:
            break;
        case ResponseKind::rollback:
            json["time_tolerance"] = options.rollback.time_tolerance;
            json["global"] = options.rollback.global;
            break;
        case ResponseKind::project:
            json["offset"] = options.project.offset;
            break;
        case ResponseKind::penalty:
            json["stiffness"] = options.penalty.stiffness ? Json(*options.penalty.stiffness) : Json(nullptr);
            json["contact_steps"] = options.penalty.contact_steps;
            json["substeps"] = options.penalty.substeps;
            json["friction_speed"] = options.penalty.friction_speed;
            break;
    }
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
    json["state_hash"] = detail::hash_text(reference.figures.state_hash);
    return json;
}

Json row_json(const ComparisonRow& row, const Comparison& comparison) {
    Json json;
    for (const Column& column : detail::comparison_columns()) json[column.name] = json_of(column.cell(row, comparison));
    json["warnings"] = row.figures.warnings;  // in words
    json["cost_seconds_each"] = row.cost.seconds_each;
    return json;
}

std::string text_of(const Cell& cell, const char* none) {
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return fmt::format("{}", *count);
    const double number = std::get<double>(cell);
    return std::isfinite(number) ? fmt::format("{}", number) : none;
}

std::string line_of(const ComparisonRow& row, const Comparison& comparison, char separator, const char* none) {
    std::string line;
    for (const Column& column : detail::comparison_columns()) {
        if (!line.empty()) line += separator;
        line += text_of(column.cell(row, comparison), none);
    }
    return line;
}

std::string header(char separator) {
    std::string line;
    for (const Column& column : detail::comparison_columns()) {
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
    json["base"] = Json::array();  // exact where it was not asked for
    for (const ComparisonRow& row : comparison.rows) {
        json[row.listed ? "rows" : "base"].push_back(row_json(row, comparison));
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

// No cell holds a comma, a quote or a line break, so none needs quotes.
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
