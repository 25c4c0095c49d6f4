#include "ricochet/io/camera_frames.h"

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

CameraPlace camera_place(const CameraDescription& camera, const Vec3& up, const FrameTree* frames,
                         const Simulation& simulation) {
    const double time = simulation.time();
    CameraPlace place{camera.path ? camera.path->value(time) : camera.position,
                      camera.target_path ? camera.target_path->value(time) : camera.target, up};
    if (camera.frame.empty()) return place;
    const AffineMap map = world_from_frame(camera.frame, frames, simulation);
    return {map.point(place.position), map.point(place.target), camera.up ? map.direction(up) : up};
}

void add_camera(VtkPolyData& frame, const CameraPlace& place) {
    const auto add = [&](const char* name, const Vec3& v) { frame.fields.push_back({name, {v.x, v.y, v.z}}); };
    add("camera_position", place.position);
    add("camera_target", place.target);
    add("camera_up", place.up);
}

std::optional<CameraPlace> camera_of_frame(const VtkPolyData& frame) {
    const auto position = vector_field(frame, "camera_position");
    const auto target = vector_field(frame, "camera_target");
    const auto up = vector_field(frame, "camera_up");
    if (!position || !target || !up) return std::nullopt;
    return CameraPlace{*position, *target, *up};
}

}  // namespace ricochet
