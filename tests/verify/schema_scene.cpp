#include "verify/schema_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <map>
#include <utility>
#include <vector>

#include "verify/schema_tables.h"

namespace ricochet::test {
namespace {

/// Returns the smallest and largest number of items by key. Lists not named here have one or two.
std::pair<std::uint64_t, std::uint64_t> most_items(const std::string& key) {
    static const std::map<std::string, std::pair<std::uint64_t, std::uint64_t>> all = {
        {"particles", {1, 6}}, {"emitters", {1, 3}}, {"colliders", {1, 3}},
        {"forces", {1, 3}},    {"keys", {1, 4}},     {"motion", {1, 4}}};
    const auto found = all.find(key);
    return found == all.end() ? std::pair<std::uint64_t, std::uint64_t>{1, 2} : found->second;
}

/// Sorts keyframes by time, as the reader requires.
void sort_by_time(nlohmann::json& list) {
    if (list.empty() || !list[0].is_object() || !list[0].contains("time")) return;
    std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a["time"] < b["time"]; });
}

}  // namespace

SchemaScene::SchemaScene(const nlohmann::json& schema, std::uint64_t seed) : schema_(schema), random_(seed, 1, 0) {}

nlohmann::json SchemaScene::draw() {
    constexpr std::array kSteps{1.0 / 60.0, 0.01, 1.0 / 30.0, 0.02, 0.05, 0.004};
    step_ = kSteps[below(kSteps.size())];
    duration_ = step_ * static_cast<double>(3 + below(30));
    Json scene = object(schema_, "scene");
    scene["ricochet"] = 1;
    scene["simulation"]["time_step"] = step_;
    scene["simulation"]["duration"] = duration_;
    if (!scene["simulation"].contains("most_particles")) scene["simulation"]["most_particles"] = 120;
    if (chance(0.06)) make_flow_scene(scene);
    if (scene.contains("heat")) make_heatable(scene);
    return scene;
}

/// Declares the temperature that heat needs and replaces points by spheres, because heat flows through surfaces.
void SchemaScene::make_heatable(Json& scene) {
    constexpr double kRadius = 0.1;
    scene["attributes"]["temperature"] = {{"default", 300.0}};
    for (const char* const key : {"emitters", "particles"}) {
        if (!scene.contains(key)) continue;
        if (!scene[key].is_array()) {  // a table, which may contain points
            scene.erase(key);
            continue;
        }
        for (Json& maker : scene[key]) maker[std::string(key) == "emitters" ? "particle_radius" : "radius"] = kRadius;
    }
}

/// Removes forces and springs, because a flow carries the particles.
void SchemaScene::make_flow_scene(Json& scene) {
    constexpr std::array kIntegrators{"rk4", "midpoint", "dormand_prince", "forward_euler"};
    for (const char* const key : {"forces", "springs", "particle_forces", "particle_contacts"}) scene.erase(key);
    scene["simulation"]["motion"] = "flow";
    scene["simulation"]["flow"] = value(schema_["$defs"]["simulation"]["properties"]["flow"], "simulation", "flow");
    scene["simulation"]["walls"] = chance(0.5) ? "slide" : "stop";
    scene["simulation"]["integrator"] = kIntegrators[below(kIntegrators.size())];
    scene["simulation"].erase("response");
    if (!scene.contains("flows")) scene["flows"] = value(schema_["properties"]["flows"], "scene", "flows");
}

std::uint64_t SchemaScene::below(std::uint64_t count) {
    return std::min(count - 1, static_cast<std::uint64_t>(random_.uniform() * static_cast<double>(count)));
}

std::string SchemaScene::one_of(const std::string& prefix, std::uint64_t count) {
    return prefix + std::to_string(below(count));
}

bool SchemaScene::is_drawn(const std::string& owner, const std::string& key) {
    const bool drawn = chance(probability_of(owner, key));
    return drawn && reason_not_drawn(owner + "." + key).empty();
}

nlohmann::json SchemaScene::value(const Json& rule, const std::string& owner, const std::string& key) {
    if (rule.contains("$ref")) {
        const std::string name = rule["$ref"].get<std::string>().substr(8);
        const Json& definition = schema_["$defs"][name];
        return object(alternative(definition, name), name);
    }
    if (rule.contains("oneOf")) return value(alternative(rule, key), owner, key);
    if (rule.contains("const")) return rule["const"];
    if (rule.contains("enum")) {
        // Most scenes get the default response.
        if (key == "response" && chance(0.6)) return rule["enum"][0];
        return rule["enum"][below(rule["enum"].size())];
    }
    const std::string type = rule["type"].get<std::string>();
    if (type == "object") return named_values(rule, owner, key);
    if (type == "array") return list(rule, owner, key);
    if (type == "boolean") return chance(0.5);
    return type == "string" ? text(owner, key) : number(rule, owner, key);
}

const nlohmann::json& SchemaScene::alternative(const Json& rule, const std::string& key) {
    if (!rule.contains("oneOf")) return rule;
    const Json& all = rule["oneOf"];
    // Nesting of flows must end, and named flows should be shared. Tables of particles are all alike.
    if (key == "flow" && depth_ > 0) return all[below(all.size() - 2)];
    if (key == "particles" && chance(0.8)) return all[0];
    return all[below(all.size())];
}

nlohmann::json SchemaScene::object(const Json& rule, const std::string& owner) {
    std::string name = owner;
    if (rule["properties"].contains("type")) {
        name += "(" + rule["properties"]["type"]["const"].get<std::string>() + ")";
    }
    const bool is_flow = owner == "flow";
    depth_ += is_flow ? 1 : 0;
    const Json required = rule.value("required", Json::array());
    Json made = Json::object();
    for (const auto& [key, of_key] : rule["properties"].items()) {
        const bool must = std::find(required.begin(), required.end(), key) != required.end();
        if (must || is_drawn(name, key)) made[key] = value(of_key, name, key);
    }
    depth_ -= is_flow ? 1 : 0;
    settle(name, made);
    return made;
}

void SchemaScene::keep_one(Json& made, const std::string& first, const std::string& second) {
    if (made.contains(first) == made.contains(second)) made.erase(chance(0.5) ? first : second);
}

/// Applies rules of the reader that tie keys of an object together.
void SchemaScene::settle(const std::string& name, Json& made) {
    const auto is_any_of = [&](std::initializer_list<const char*> names) {
        return std::any_of(names.begin(), names.end(), [&](const char* other) { return name == other; });
    };
    // Meshes at keys need the triangles of the collider's own mesh.
    if (made.contains("deformation")) made["file"] = "cube.obj";
    if (name == "emitter(mesh)") {
        made["file"] = made.value("file", "ball.obj");
        keep_one(made, "file", "collider");
    }
    if (name == "convection" && chance(0.7)) made.erase("coefficient");  // the other keys define how it is computed
    if (name == "force(quadratic_drag)") {
        made["coefficient"] = made.value("coefficient", 0.5);
        keep_one(made, "coefficient", "drag_coefficient");
        if (made.contains("coefficient")) made.erase("fluid_density");
    }
    if (is_any_of({"springs(rope)", "springs(chain)"})) {
        made["axial_stiffness"] = made.value("axial_stiffness", 20.0);
        keep_one(made, "axial_stiffness", "stiffness");
    }
    if (is_any_of({"springs(sheet)", "springs(cloth)"})) {
        made["mass"] = made.value("mass", 1.0);
        keep_one(made, "mass", "mass_per_area");
        if (name == "springs(sheet)") {
            made["side_u"] = {between(0.4, 1.0), 0.0, 0.1};
            made["side_v"] = {0.0, between(0.4, 1.0), between(-0.3, 0.3)};
        }
    }
    if (name == "body") {
        made["mass"] = made.value("mass", 1.0);
        keep_one(made, "mass", "density");
        const bool is_free = made.value("joint", "free") == "free";
        for (const char* const key : {"axis", "friction", "rate", "spring", "damping", "drive"}) {
            if (is_free) made.erase(key);
        }
    }
    if (name.starts_with("emitter(") && name != "emitter(child)" && !made.contains("rate")) {
        made["burst"] = std::max(made.value("burst", 0), 1);
    }
}

nlohmann::json SchemaScene::named_values(const Json& rule, const std::string& owner, const std::string& key) {
    Json made = Json::object();
    for (const std::string& name : names_of(owner, key)) {
        if (key == "materials" || key == "flows" || made.empty() || chance(0.6))
            made[name] = value(rule["additionalProperties"], owner, key);
    }
    if (owner == "scene" && key == "attributes") made["temperature"] = {{"components", 1}, {"default", 300}};
    return made;
}

nlohmann::json SchemaScene::list(const Json& rule, const std::string& owner, const std::string& key) {
    Json made = Json::array();
    if (rule.contains("prefixItems")) {
        for (const Json& item : rule["prefixItems"]) made.push_back(value(item, owner, key));
        if (made[0].is_number()) made[1] = 0.9 * random_.uniform() * std::abs(made[0].get<double>());
        return made;
    }
    const bool is_vector = rule.value("minItems", 0) == 3 && rule.value("maxItems", 0) == 3;
    const auto [least, most] = most_items(key);
    std::uint64_t count = is_vector ? 3 : least + below(most - least + 1);
    count = std::max<std::uint64_t>(count, rule.value("minItems", std::uint64_t{0}));
    for (std::uint64_t k = 0; k < count; ++k) {
        made.push_back(value(rule["items"], owner, key));
        if (owner == "scene" && key == "colliders") made.back()["name"] = "c" + std::to_string(k);
        if (owner == "scene" && key == "emitters") made.back()["name"] = "e" + std::to_string(k);
    }
    if (is_vector && key != "scale" && rule["items"].value("minimum", 0.0) < 0.0 && chance(0.15)) {
        const std::uint64_t kept = below(3);
        for (std::uint64_t k = 0; k < 3; ++k) made[k] = k == kept ? made[k] : Json(0.0);
    }
    sort_by_time(made);
    return made;
}

nlohmann::json SchemaScene::number(const Json& rule, const std::string& owner, const std::string& key) {
    const Range unknown{rule.value("minimum", 0.0) < 0.0 ? -1.0 : 0.0, 1.0};
    const Range range = range_of(owner, key).value_or(unknown);
    double drawn = between(range.low, range.high);
    if (chance(0.1)) drawn = range.low;
    if (chance(0.1)) drawn = range.high;
    if (range.unit == Range::Unit::logarithm) drawn = std::pow(10.0, drawn);
    if (range.unit == Range::Unit::of_duration) drawn *= duration_;
    if (range.unit == Range::Unit::per_duration) drawn /= duration_;
    if (rule.contains("exclusiveMinimum")) drawn = std::max(drawn, rule["exclusiveMinimum"].get<double>() + 1e-3);
    if (rule.contains("minimum")) drawn = std::max(drawn, rule["minimum"].get<double>());
    if (rule.contains("maximum")) drawn = std::min(drawn, rule["maximum"].get<double>());
    if (rule["type"] == "integer") return static_cast<std::uint64_t>(drawn);
    return drawn;
}

nlohmann::json SchemaScene::text(const std::string& owner, const std::string& key) {
    if (owner == "flow(grid)") return key == "file" ? "wind.vti" : "velocity";
    if (owner == "particle_table") return "particles.csv";
    if (owner == "mesh_key") return one_of("cube_", 3) + ".obj";
    if (key == "files") return "cube_*.obj";
    if (owner == "deformation(cache)") return "cube.pc2";
    if (owner == "springs(cloth)") return "sheet.obj";
    if (owner == "emitter(mesh)" && key == "file") return chance(0.5) ? "cube.obj" : "ball.obj";
    if (key == "file") return one_of("mesh_", 6) + ".obj";
    if (key == "flow") return one_of("w", 2);
    if (key == "frame" || key == "parent")
        return owner.starts_with("emitter") && key == "parent" ? "e0" : one_of("f", 3);
    if (key == "collider") return one_of("c", 2);
    if (key == "emitter") return "e0";
    if (key == "attribute") return "charge";
    if (key == "first" || key == "second") return chance(0.5) ? "a" : "b";
    const bool is_of_spheres = owner == "particle" || owner.starts_with("emitter");
    if (key == "material" && is_of_spheres) return chance(0.5) ? "a" : "b";
    return one_of("m", 3);
}

}  // namespace ricochet::test
