#include "ricochet/io/summary.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>

#include "ricochet/core/hash.h"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const ColliderSummary& collider) {
    return {{"name", collider.name}, {"type", collider.type},
            {"file", collider.file}, {"triangles", collider.triangles},
            {"hits", collider.hits}, {"impulse", {collider.impulse.x, collider.impulse.y, collider.impulse.z}}};
}

void add_statistics(Json& json, const SimulationStatistics& statistics) {
    json["particles_emitted"] = statistics.emitted;
    json["expired"] = statistics.expired;
    json["absorbed"] = statistics.absorbed;
    json["out_of_bounds"] = statistics.out_of_bounds;
    json["shattered"] = statistics.shattered;
    json["children"] = statistics.children;
    json["births_refused_by_depth"] = statistics.births_refused_by_depth;
    json["births_refused_by_population"] = statistics.births_refused_by_population;
    json["frozen"] = statistics.frozen;
    json["particle_steps"] = statistics.particle_steps;
    json["contacts"] = statistics.contacts;
    json["bounces_per_step_max"] = statistics.bounces_per_step_max;
    json["resting"] = statistics.resting;
    json["asleep"] = statistics.asleep;
    json["unsimulated_time"] = statistics.unsimulated_time;
    json["budget_exhausted"] = statistics.budget_exhausted;
    json["started_inside"] = statistics.started_inside;
    json["stayed"] = statistics.stayed;
    json["lost_impulses"] = statistics.lost_impulses;
    json["springs_broken"] = statistics.springs_broken;
    json["springs_lost"] = statistics.springs_lost;
    json["unsolved_steps"] = statistics.unsolved_steps;
    json["trials"] = statistics.trials;
    json["penetrations"] = statistics.penetrations;
    json["penetration_mean"] =
        statistics.penetrations > 0 ? statistics.penetration_sum / static_cast<double>(statistics.penetrations) : 0.0;
    json["penetration_deepest"] = statistics.penetration_deepest;
}

ColliderSummary collider_summary(const Simulation& simulation, std::size_t i) {
    const ColliderDescription& collider = simulation.colliders()[i];
    const TriangleTotals totals = simulation.triangle_totals(i);
    ColliderSummary summary;
    summary.name = collider.name;
    summary.type = type_name(collider.shape);
    // A plane and a shape with a formula are one surface, and no triangles that anything collides with.
    const bool is_mesh =
        std::holds_alternative<MeshShape>(collider.shape) || std::holds_alternative<CuboidShape>(collider.shape);
    if (is_mesh) summary.triangles = simulation.collider_mesh(i)->triangles.size();
    summary.hits = std::accumulate(totals.hits.begin(), totals.hits.end(), std::uint64_t{0});
    summary.impulse = std::accumulate(totals.impulse.begin(), totals.impulse.end(), Vec3{});
    return summary;
}

}  // namespace

RunSummary summarize(const Simulation& simulation) {
    RunSummary summary;
    summary.response = name_of(simulation.options().response);
    summary.seed = simulation.options().seed;
    summary.time_step = simulation.options().time_step;
    summary.simulated_time = simulation.time();
    summary.particles_alive = simulation.particles().size();
    summary.statistics = simulation.statistics();
    if (simulation.options().verify) summary.leaks = simulation.statistics().violations;
    summary.kinetic_energy = simulation.kinetic_energy();
    summary.potential_energy = simulation.potential_energy();
    summary.state_hash = simulation.state_hash();
    for (std::size_t i = 0; i < simulation.colliders().size(); ++i) {
        summary.colliders.push_back(collider_summary(simulation, i));
    }
    return summary;
}

std::string summary_text(const RunSummary& summary) {
    Json json;
    json["version"] = summary.version;
    json["scene"] = summary.scene;
    json["threads"] = summary.threads;
    json["response"] = summary.response;
    json["seed"] = summary.seed;
    json["time_step"] = summary.time_step;
    json["steps"] = summary.statistics.steps;
    json["frames"] = summary.frames;
    json["simulated_time"] = summary.simulated_time;
    json["wall_seconds"] = summary.wall_seconds;
    json["output_seconds"] = summary.output_seconds;
    json["interrupted"] = summary.interrupted;
    json["diverged"] = summary.diverged ? Json(*summary.diverged) : Json(nullptr);
    json["particles_alive"] = summary.particles_alive;
    add_statistics(json, summary.statistics);
    json["leaks"] = summary.leaks ? Json(*summary.leaks) : Json(nullptr);  // known only to a run that verifies itself
    json["kinetic_energy"] = summary.kinetic_energy;
    json["potential_energy"] = summary.potential_energy ? Json(*summary.potential_energy) : Json(nullptr);
    json["state_hash"] = fmt::format("{:016x}", summary.state_hash);
    json["state_hash_algorithm"] = StateHash::kName;
    json["peak_memory_bytes"] = summary.peak_memory_bytes;
    json["colliders"] = Json::array();
    for (const ColliderSummary& collider : summary.colliders) json["colliders"].push_back(json_of(collider));
    // Names come from files and may hold bytes that are no UTF-8: they are replaced, never a reason to lose the run.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ricochet
