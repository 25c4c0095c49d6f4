#include "ricochet/io/run_info.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

Vec3 vec3_of(const Json& json) {
    if (json.size() != 3) throw InputError("a vector needs three numbers");
    const Vec3 v{json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
    if (!is_finite(v)) throw InputError("a vector is not finite");
    return v;
}

RunInfo run_info_of(const Json& json) {
    RunInfo info;
    info.version = json.at("version").get<std::string>();
    info.scene = json.at("scene").get<std::string>();
    info.up = vec3_of(json.at("up"));
    if (const Json& camera = json.at("camera"); !camera.is_null()) {
        info.camera = {vec3_of(camera.at("position")), vec3_of(camera.at("target")), camera.at("fov").get<double>()};
    }
    for (const Json& collider : json.at("colliders")) {
        info.colliders.push_back({collider.at("name").get<std::string>(), collider.at("type").get<std::string>(),
                                  collider.at("file").get<std::string>(),
                                  collider.at("material").get<std::uint32_t>()});
    }
    return info;
}

// The axis that points most against the uniform forces; z where there are none.
Vec3 upward_axis(const SimulationSetup& setup) {
    Vec3 fall;
    for (const auto& force : setup.forces) {
        if (force->is_uniform()) fall += force->acceleration({Vec3{}, Vec3{}, 1.0, 0.0, 0.0});
    }
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
    if (scene.camera) {
        info.camera = CameraInfo{scene.camera->position, scene.camera->target, scene.camera->field_of_view_degrees};
        if (scene.camera->up) info.up = normalized(*scene.camera->up);
    }
    return info;
}

std::string run_info_text(const RunInfo& info) {
    Json json;
    json["version"] = info.version;
    json["scene"] = info.scene;
    json["up"] = json_of(info.up);
    json["camera"] = nullptr;
    if (info.camera) {
        json["camera"] = {{"position", json_of(info.camera->position)},
                          {"target", json_of(info.camera->target)},
                          {"fov", info.camera->fov_degrees}};
    }
    json["colliders"] = Json::array();
    for (const ColliderInfo& collider : info.colliders) {
        json["colliders"].push_back({{"name", collider.name},
                                     {"type", collider.type},
                                     {"file", collider.file},
                                     {"material", collider.material}});
    }
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

RunInfo read_run_info(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    if (!in)
        throw InputError(fmt::format("{}: cannot be read; expected the run.json of a ricochet run", path.string()));
    try {
        return run_info_of(Json::parse(text));
    } catch (const std::exception& error) {
        throw InputError(fmt::format("{}: not the run.json of a ricochet run ({}); run the scene again", path.string(),
                                     error.what()));
    }
}

}  // namespace ricochet
