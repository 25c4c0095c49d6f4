#include "bench/measurement_report.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

namespace ricochet::bench {
namespace {

using Json = nlohmann::ordered_json;

template <class Number>
Json json_of(const std::optional<Number>& number) {
    return number ? Json(*number) : Json(nullptr);
}

Json json_of(const Row& row) {
    Json json;
    json["suite"] = row.suite;
    json["case"] = row.name;
    json["response"] = row.response;
    json["particles"] = row.particles;
    json["triangles"] = row.triangles;
    json["threads"] = row.threads;
    json["steps"] = row.steps;
    json["seconds"] = row.seconds;
    json["particle_steps_per_second"] = row.particle_steps_per_second;
    json["contacts_per_second"] = row.contacts_per_second;
    json["raw_rays_per_second"] = row.raw_rays_per_second;
    json["ratio_raw"] = row.ratio_raw;
    json["raw_sorted_rays_per_second"] = row.raw_sorted_rays_per_second;
    json["ratio_raw_sorted"] = row.ratio_raw_sorted;
    json["native_bounces_per_second"] = row.native_bounces_per_second;
    json["ratio_native_bounces"] = json_of(row.ratio_native_bounces);
    json["leaks"] = json_of(row.leaks);
    json["state_hash"] = fmt::format("{:016x}", row.state_hash);
    json["bytes_per_particle"] = row.bytes_per_particle;
    json["bytes_per_triangle"] = row.bytes_per_triangle;
    return json;
}

std::string short_rate(double rate) {
    if (rate >= 1e6) return fmt::format("{:.3g}M", rate / 1e6);
    if (rate >= 1e3) return fmt::format("{:.3g}k", rate / 1e3);
    return fmt::format("{:.3g}", rate);
}

std::vector<std::string> cells_of(const Row& row) {
    const double hits = static_cast<double>(row.contacts) / static_cast<double>(row.particle_steps);
    return {row.suite + "/" + row.name,
            fmt::to_string(row.particles),
            fmt::to_string(row.triangles),
            fmt::to_string(row.threads),
            short_rate(row.particle_steps_per_second),
            short_rate(row.contacts_per_second),
            fmt::format("{:.3g}", row.ratio_raw),
            fmt::format("{:.3g}", row.ratio_raw_sorted),
            row.ratio_native_bounces ? fmt::format("{:.3g}", *row.ratio_native_bounces) : "-",
            row.leaks ? fmt::to_string(*row.leaks) : "-",
            fmt::format("{:.3g}", hits),
            fmt::format("{:016x}", row.state_hash),
            fmt::format("{:.0f}", row.bytes_per_particle),
            fmt::format("{:.0f}", row.bytes_per_triangle)};
}

}  // namespace

std::string to_json(std::span<const Row> rows) {
    Json list = Json::array();
    for (const Row& row : rows) list.push_back(json_of(row));
    return list.dump(2) + "\n";
}

std::vector<std::vector<std::string>> to_table(std::span<const Row> rows) {
    std::vector<std::vector<std::string>> table{{"case", "particles", "triangles", "threads", "steps/s", "contacts/s",
                                                 "/raw", "/sorted", "/native", "leaks", "hits/step", "state",
                                                 "B/particle", "B/triangle"}};
    for (const Row& row : rows) table.push_back(cells_of(row));
    return table;
}

}  // namespace ricochet::bench
