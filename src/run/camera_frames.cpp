#include "run/camera_frames.h"

#include <vector>

namespace ricochet {
namespace {

AffineMap world_from_frame(const std::string& name, const FrameTree* frames, const Simulation& simulation) {
    for (const BodyState& body : simulation.bodies()) {
        if (body.frame == name) return body.world_from_frame;
    }
    const auto frame = frames == nullptr ? std::nullopt : frames->find(name);
    return frame ? frames->map(*frame, simulation.time()) : AffineMap{};
}

std::optional<Vec3> vector_field(const VtkPolyData& frame, const char* name) {
    const std::vector<double>* values = find_field(frame, name);
    if (values == nullptr || values->size() != 3) return std::nullopt;
    return Vec3{(*values)[0], (*values)[1], (*values)[2]};
}

}  // namespace

CameraPosition current_camera_position(const CameraDescription& camera, const Vec3& up, const FrameTree* frames,
                                       const Simulation& simulation) {
    const double time = simulation.time();
    CameraPosition camera_position{camera.path ? camera.path->value(time) : camera.position,
                                   camera.target_path ? camera.target_path->value(time) : camera.target, up};
    if (camera.frame.empty()) return camera_position;
    const AffineMap map = world_from_frame(camera.frame, frames, simulation);
    return {map.point(camera_position.position), map.point(camera_position.target), camera.up ? map.direction(up) : up};
}

void add_camera(VtkPolyData& frame, const CameraPosition& camera_position) {
    const auto add = [&](const char* name, const Vec3& v) { frame.fields.push_back({name, {v.x, v.y, v.z}}); };
    add("camera_position", camera_position.position);
    add("camera_target", camera_position.target);
    add("camera_up", camera_position.up);
}

std::optional<CameraPosition> camera_of_frame(const VtkPolyData& frame) {
    const auto position = vector_field(frame, "camera_position");
    const auto target = vector_field(frame, "camera_target");
    const auto up = vector_field(frame, "camera_up");
    if (!position || !target || !up) return std::nullopt;
    return CameraPosition{*position, *target, *up};
}

}  // namespace ricochet
