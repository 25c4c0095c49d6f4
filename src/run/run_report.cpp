#include "run/run_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <new>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <variant>

#include "ricochet/core/atomic_file.h"
#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "run/counter_tables.h"
#include "run/load_tables.h"
#include "run/picture_files.h"
#include "run/regular_file.h"

namespace ricochet {

// run.json.

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

Vec3 vec3_of(const Json& json) {
    if (json.size() != 3) throw InputError("a vector needs three numbers");
    const Vec3 v{json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
    if (!is_finite(v)) throw InputError("a vector is not finite");
    return v;
}

StretchDescription stretch_of(const Json& json) {
    return {json.at("speed").get<double>(), json.at("impact").get<double>(), json.at("time").get<double>(),
            json.at("most").get<double>()};
}

/// Accepts only the names that ricochet itself gives to picture files, because run.json can come from an untrusted
/// source.
std::string picture_file_of(const Json& json, const char* key, const char* file) {
    const std::string name = json.value(key, "");
    if (!name.empty() && !is_picture_file(name, file)) {
        throw InputError(fmt::format("picture.{}: found \"{}\", expected {} beside it", key, name, file));
    }
    return name;
}

ParticleDrawingDescription drawing_of(const Json& json) {
    ParticleDrawingDescription drawing;
    drawing.particles = json.value("particles", "");
    drawing.sprite = picture_file_of(json, "sprite", kParticleSpriteFile);
    drawing.mesh = picture_file_of(json, "mesh", kParticleMeshFile);
    drawing.turn = json.value("turn", "");
    if (json.contains("turning")) {
        drawing.turning = MeanSpread{json.at("turning").at(0).get<double>(), json.at("turning").at(1).get<double>()};
    }
    return drawing;
}

PictureDescription picture_of(const Json& json) {
    PictureDescription picture;
    static_cast<ParticleDrawingDescription&>(picture) = drawing_of(json);
    picture.light = json.value("light", "");
    if (json.contains("background")) picture.background = vec3_of(json.at("background"));
    picture.transparent = json.value("transparent", false);
    picture.shutter = json.value("shutter", 0.0);
    if (json.contains("ground")) picture.ground = json.at("ground").get<double>();
    if (json.contains("black_body")) picture.black_body = json.at("black_body").get<double>();
    if (json.contains("stretch")) picture.stretch = stretch_of(json.at("stretch"));
    if (json.contains("particle_radius")) picture.particle_radius = json.at("particle_radius").get<double>();
    if (json.contains("time")) picture.time = json.at("time").get<double>();
    return picture;
}

Json json_of(const ParticleDrawingDescription& drawing) {
    Json json = Json::object();
    if (!drawing.particles.empty()) json["particles"] = drawing.particles;
    if (!drawing.sprite.empty()) json["sprite"] = drawing.sprite;
    if (!drawing.mesh.empty()) json["mesh"] = drawing.mesh;
    if (!drawing.turn.empty()) json["turn"] = drawing.turn;
    if (drawing.turning) json["turning"] = {drawing.turning->mean, drawing.turning->spread};
    return json;
}

Json json_of(const PictureDescription& picture) {
    Json json = json_of(static_cast<const ParticleDrawingDescription&>(picture));
    if (!picture.light.empty()) json["light"] = picture.light;
    if (picture.background) json["background"] = json_of(*picture.background);
    if (picture.transparent) json["transparent"] = true;
    if (picture.ground) json["ground"] = *picture.ground;
    if (picture.shutter > 0.0) json["shutter"] = picture.shutter;
    if (picture.black_body) json["black_body"] = *picture.black_body;
    if (picture.particle_radius) json["particle_radius"] = *picture.particle_radius;
    if (picture.time) json["time"] = *picture.time;
    if (const auto& stretch = picture.stretch) {
        json["stretch"] = {
            {"speed", stretch->speed}, {"impact", stretch->impact}, {"time", stretch->time}, {"most", stretch->most}};
    }
    return json;
}

ColliderLooks looks_of(const Json& json) {
    ColliderLooks looks;
    if (json.contains("color")) looks.color = vec3_of(json.at("color"));
    looks.roughness = json.value("roughness", looks.roughness);
    looks.glass = json.value("glass", false);
    looks.hidden = json.value("hidden", false);
    looks.pattern = json.value("pattern", true);
    return looks;
}

Json json_of(const ColliderLooks& looks) {
    Json json = Json::object();
    if (looks.color) json["color"] = json_of(*looks.color);
    if (looks.roughness < 1.0) json["roughness"] = looks.roughness;
    if (looks.glass) json["glass"] = true;
    if (looks.hidden) json["hidden"] = true;
    if (!looks.pattern) json["pattern"] = false;
    return json;
}

RunInfo run_info_of(const Json& json) {
    RunInfo info;
    info.version = json.at("version").get<std::string>();
    info.scene = json.at("scene").get<std::string>();
    info.up = vec3_of(json.at("up"));
    info.time_step = json.value("time_step", 0.0);
    if (const Json& camera = json.at("camera"); !camera.is_null()) {
        info.camera.emplace();
        info.camera->position = vec3_of(camera.at("position"));
        info.camera->target = vec3_of(camera.at("target"));
        info.camera->up = info.up;
        info.camera->field_of_view_degrees = camera.at("fov").get<double>();
        info.camera->aperture = camera.value("aperture", 0.0);
        info.camera->focus_distance = camera.value("focus_distance", 0.0);
    }
    if (json.contains("picture")) info.picture = picture_of(json.at("picture"));
    if (json.contains("drawings")) {
        for (const Json& drawing : json.at("drawings")) info.drawings.push_back(drawing_of(drawing));
    }
    for (const Json& collider : json.at("colliders")) {
        info.colliders.push_back({collider.at("name").get<std::string>(),
                                  collider.at("type").get<std::string>(),
                                  collider.at("file").get<std::string>(),
                                  collider.at("material").get<std::uint32_t>(),
                                  collider.value("moves", false),
                                  {}});
        if (collider.contains("looks")) info.colliders.back().looks = looks_of(collider.at("looks"));
    }
    return info;
}

// Returns the unit vector along a coordinate axis, with sign, that points most against the uniform forces. Returns +z
// without such forces.
Vec3 upward_axis(const SimulationSetup& setup) {
    const Vec3 fall = uniform_acceleration(setup);
    Vec3 up{0, 0, 1};
    for (int axis = 0; axis < 3; ++axis) {
        if (std::fabs(fall[axis]) < max_abs(fall) || fall[axis] == 0.0) continue;
        up = {};
        up[axis] = fall[axis] > 0.0 ? -1.0 : 1.0;
    }
    return up;
}

}  // namespace

RunInfo run_info_of(const SceneDescription& scene) {
    RunInfo info;
    info.scene = scene.file;
    info.up = upward_axis(scene.setup);
    info.time_step = scene.setup.options.time_step;
    info.camera = scene.camera;
    info.picture = scene.picture;
    info.drawings = scene.drawings;
    info.looks = scene.looks;
    info.groups = scene.groups;
    if (scene.camera && scene.camera->up) info.up = normalized(*scene.camera->up);
    return info;
}

std::string run_info_text(const RunInfo& info) {
    Json json;
    json["version"] = info.version;
    json["scene"] = info.scene;
    json["up"] = json_of(info.up);
    json["time_step"] = info.time_step;
    json["camera"] = nullptr;
    if (info.camera) {
        json["camera"] = {{"position", json_of(info.camera->position)},
                          {"target", json_of(info.camera->target)},
                          {"fov", info.camera->field_of_view_degrees}};
        if (info.camera->aperture > 0.0) {
            json["camera"]["aperture"] = info.camera->aperture;
            json["camera"]["focus_distance"] = info.camera->focus_distance;
        }
    }
    if (info.picture) json["picture"] = json_of(*info.picture);
    for (const ParticleDrawingDescription& drawing : info.drawings) json["drawings"].push_back(json_of(drawing));
    json["colliders"] = Json::array();
    for (const ColliderInfo& collider : info.colliders) {
        json["colliders"].push_back({{"name", collider.name},
                                     {"type", collider.type},
                                     {"file", collider.file},
                                     {"material", collider.material}});
        if (collider.moves) json["colliders"].back()["moves"] = true;
        if (collider.looks != ColliderLooks{}) json["colliders"].back()["looks"] = json_of(collider.looks);
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunInfo read_run_info(const std::filesystem::path& path) {
    constexpr std::uint64_t kMostBytes = std::uint64_t{64} << 20;
    const std::string text = read_regular_file(path, kMostBytes, "the run.json of a ricochet run");
    try {
        return run_info_of(Json::parse(text));
    } catch (const std::bad_alloc&) {
        throw;  // being out of memory is not a fault of the file
    } catch (const std::exception& error) {
        throw InputError(fmt::format("{}: not the run.json of a ricochet run ({}); run the scene again", path.string(),
                                     error.what()));
    }
}

// summary.json.

namespace {

/// Returns the share of impacts in the impulses, or null if the surfaces received no impulse.
Json share_of(const ImpulseSizes& sizes) { return sizes.any() ? Json(sizes.share_of_impacts()) : Json(nullptr); }

Json json_of(const GroupTotals& group) {
    return {{"name", group.name},
            {"triangles", group.triangles},
            {"hits", group.hits},
            {"impulse", json_of(group.impulse)},
            {"lasting_impulse", json_of(group.lasting_impulse)}};
}

Json json_of(const ColliderSummary& collider) {
    Json json = {{"name", collider.name},           {"type", collider.type}, {"file", collider.file},
                 {"triangles", collider.triangles}, {"hits", collider.hits}, {"impulse", json_of(collider.impulse)}};
    json["lasting_impulse"] = json_of(collider.lasting_impulse);
    json["impact_share"] = share_of(collider.sizes);
    if (collider.loads) {
        json["angular_impulse"] = json_of(collider.loads->moment);
        json["work"] = collider.loads->work;
    }
    for (const GroupTotals& group : collider.groups) json["groups"].push_back(json_of(group));
    return json;
}

Json json_of(const BodyState& body) {
    return {{"name", body.frame},
            {"mass", body.mass},
            {"center", json_of(body.center)},
            {"velocity", json_of(body.velocity)},
            {"angular_velocity", json_of(body.angular_velocity)},
            {"coordinate", body.coordinate},
            {"rate", body.rate},
            {"kinetic_energy", body.kinetic_energy}};
}

void add_statistics(Json& json, const RunSummary& summary) {
    using enum InSummary;
    for (const Statistic& line : kStatistics) {
        const InSummary where = line.in_summary;
        const auto value_of = [&](auto member) { return Json(std::invoke(member, summary.statistics)); };
        const Json value = std::visit(value_of, line.member);
        if (where == apart || (where == above_zero && value == 0)) continue;
        if ((where == of_spheres || where == of_spheres_verified) && !summary.spheres_meet) continue;
        const bool is_unknown = is_found_by_verification(line) && !summary.verified;
        json[std::string(line.summary_name)] = is_unknown ? Json(nullptr) : value;
    }
}

ColliderSummary collider_summary(const Simulation& simulation, std::size_t i, const TriangleGroups& groups) {
    const ColliderDescription& collider = simulation.colliders()[i];
    const TriangleTotals totals = simulation.triangle_totals(i);
    ColliderSummary summary;
    summary.name = collider.name;
    summary.type = type_name(collider.shape);
    // Planes, balls and cylinders are a single surface; their triangles only serve for display.
    const bool is_mesh =
        std::holds_alternative<MeshShape>(collider.shape) || std::holds_alternative<CuboidShape>(collider.shape);
    if (is_mesh) summary.triangles = simulation.collider_mesh(i)->triangles.size();
    summary.hits = std::accumulate(totals.hits.begin(), totals.hits.end(), std::uint64_t{0});
    if (!simulation.collider_totals().empty() && has_loads(simulation, i)) {
        summary.loads = simulation.collider_totals()[i];
    }
    summary.impulse = std::accumulate(totals.impulse.begin(), totals.impulse.end(), Vec3{});
    summary.lasting_impulse = std::accumulate(totals.lasting_impulse.begin(), totals.lasting_impulse.end(), Vec3{});
    summary.sizes.add(totals);
    summary.groups = totals_by_group(groups, totals);
    return summary;
}

}  // namespace

ImpulseSizes RunSummary::impulse_sizes() const {
    ImpulseSizes sizes;
    for (const ColliderSummary& collider : colliders) sizes.add(collider.sizes);
    return sizes;
}

RunSummary summarize(const Simulation& simulation, const std::vector<TriangleGroups>& groups) {
    RunSummary summary;
    summary.response = name_of(simulation.options().response);
    summary.seed = simulation.options().seed;
    summary.time_step = simulation.options().time_step;
    summary.simulated_time = simulation.time();
    summary.particles_alive = simulation.particles().size();
    summary.statistics = simulation.statistics();
    summary.spheres_meet = simulation.options().particle_contacts.has_value();
    summary.verified = simulation.options().verify;
    summary.kinetic_energy = simulation.kinetic_energy();
    summary.potential_energy = simulation.potential_energy();
    summary.state_hash = simulation.state_hash();
    for (std::size_t i = 0; i < simulation.colliders().size(); ++i) {
        summary.colliders.push_back(collider_summary(simulation, i, i < groups.size() ? groups[i] : TriangleGroups{}));
    }
    summary.bodies = simulation.bodies();
    summary.counters = simulation.counters();
    return summary;
}

std::string summary_text(const RunSummary& summary) {
    Json json;
    json["version"] = summary.version;
    json["scene"] = summary.scene;
    if (summary.processes > 1) {
        json["processes"] = summary.processes;
        json["busiest_process"] = summary.balance.busiest;
        json["particles_moved"] = summary.balance.moved;
        json["common_memory_bytes"] = summary.common_memory_bytes;
    }
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
    add_statistics(json, summary);
    json["kinetic_energy"] = summary.kinetic_energy;
    json["potential_energy"] = summary.potential_energy ? Json(*summary.potential_energy) : Json(nullptr);
    json["state_hash"] = fmt::format("{:016x}", summary.state_hash);
    json["state_hash_algorithm"] = StateHash::kName;
    json["peak_memory_bytes"] = summary.peak_memory_bytes;
    json["impact_share"] = share_of(summary.impulse_sizes());
    json["colliders"] = Json::array();
    for (const ColliderSummary& collider : summary.colliders) json["colliders"].push_back(json_of(collider));
    for (const BodyState& body : summary.bodies) json["bodies"].push_back(json_of(body));
    for (const CounterTotals& counter : summary.counters) {
        json["counters"].push_back(Json::parse(counter_json(counter)));
    }
    // Names come from files and can contain invalid UTF-8. Such bytes are replaced, because an exception would lose the
    // summary.
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace ricochet
