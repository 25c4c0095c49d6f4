#include "bench/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/suites.h"

namespace ricochet::bench {
namespace {

using Json = nlohmann::ordered_json;

template <class Number>
Cell cell_of(const std::optional<Number>& number) {
    return number ? Cell(*number) : Cell();
}

void set(Record& record, std::string_view name, Cell value) {
    const auto place = std::find_if(record.begin(), record.end(), [&](const Field& f) { return f.name == name; });
    place->value = std::move(value);
}

Cell ratio_of(double over, double under) { return under > 0.0 ? Cell(over / under) : Cell(); }

Json json_of(const Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) return *text;
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return *count;
    const auto* number = std::get_if<double>(&cell);
    return number != nullptr && std::isfinite(*number) ? Json(*number) : Json(nullptr);
}

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string result = "\"";
    for (const char c : text) {
        if (c == '"') result += '"';
        result += c;
    }
    return result + '"';
}

std::string text_of(const Cell& cell) {
    if (const auto* text = std::get_if<std::string>(&cell)) return quoted(*text);
    if (const auto* count = std::get_if<std::uint64_t>(&cell)) return fmt::to_string(*count);
    const auto* number = std::get_if<double>(&cell);
    return number != nullptr && std::isfinite(*number) ? fmt::to_string(*number) : std::string();
}

}  // namespace

Record record_of(const Row& row) {
    return {{"suite", row.suite},
            {"case", row.name},
            {"response", row.response},
            {"particles", std::uint64_t{row.particles}},
            {"triangles", std::uint64_t{row.triangles}},
            {"threads", static_cast<std::uint64_t>(row.threads)},
            {"steps", row.steps},
            {"seconds", row.seconds},
            {"particle_steps_per_second", row.particle_steps_per_second},
            {"contacts_per_second", row.contacts_per_second},
            {"raw_rays_per_second", row.raw_rays_per_second},
            {"ratio_raw", row.ratio_raw},
            {"raw_sorted_rays_per_second", row.raw_sorted_rays_per_second},
            {"ratio_raw_sorted", row.ratio_raw_sorted},
            {"native_bounces_per_second", row.native_bounces_per_second},
            {"ratio_native_bounces", cell_of(row.ratio_native_bounces)},
            {"leaks", cell_of(row.leaks)},
            {"state_hash", fmt::format("{:016x}", row.state_hash)},
            {"bytes_per_particle", row.bytes_per_particle},
            {"bytes_per_triangle", row.bytes_per_triangle},
            {"contacts_per_particle_step",
             ratio_of(static_cast<double>(row.contacts), static_cast<double>(row.particle_steps))},
            {"ratio_points", cell_of(row.ratio_points)},
            {"ratio_exact", cell_of(row.ratio_exact)},
            {"speedup", cell_of(row.speedup)},
            {"speedup_raw", cell_of(row.speedup_raw)}};
}

Record record_of(const LoadRow& row) {
    Record record = record_of(Row{});
    for (Field& field : record) field.value = {};
    set(record, "suite", std::string(kLoadSuite));
    set(record, "case", row.name);
    set(record, "triangles", std::uint64_t{row.triangles});
    set(record, "threads", static_cast<std::uint64_t>(row.threads));
    const auto triangles = static_cast<double>(row.triangles);
    record.push_back({"format", row.format});
    record.push_back({"file_bytes", row.file_bytes});
    record.push_back({"read_seconds", row.read_seconds});
    record.push_back({"build_seconds", row.build_seconds});
    record.push_back({"read_bytes_per_second", ratio_of(static_cast<double>(row.file_bytes), row.read_seconds)});
    record.push_back({"read_triangles_per_second", ratio_of(triangles, row.read_seconds)});
    record.push_back({"build_triangles_per_second", ratio_of(triangles, row.build_seconds)});
    return record;
}

std::string to_json(std::span<const Record> records) {
    Json list = Json::array();
    for (const Record& record : records) {
        Json json;
        for (const Field& field : record) json[std::string(field.name)] = json_of(field.value);
        list.push_back(std::move(json));
    }
    return list.dump(2) + "\n";
}

std::string to_csv(std::span<const Record> records) {
    std::string text;
    const auto add_line = [&](const Record& record, const auto& cell) {
        for (std::size_t i = 0; i < record.size(); ++i) {
            if (i > 0) text += ',';
            text += cell(record[i]);
        }
        text += "\r\n";
    };
    if (!records.empty()) add_line(records.front(), [](const Field& field) { return std::string(field.name); });
    for (const Record& record : records) add_line(record, [](const Field& field) { return text_of(field.value); });
    return text;
}

}  // namespace ricochet::bench
