// Camera and surroundings of a run's pictures.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "cli/run_pictures.h"
#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/mesh/winding_number.h"
#include "run/camera_frames.h"
#include "run/vtp_reader.h"
#include "view/export/frame_reader.h"
#include "view/export/moving_meshes.h"

namespace ricochet::cli {

// Takes settings from the scene unless the command line sets them.
void RunPictures::choose_scenery(const RunInfo& info) {
    if (!info.picture) return;
    const PictureDescription& own = *info.picture;
    if (style_.drawing == ParticleDrawing::automatic && !own.particles.empty()) {
        style_.drawing = drawing_from_name(own.particles).value_or(style_.drawing);
    }
    if (!style_.shutter) style_.shutter = own.shutter;
    if (!style_.particle_radius) style_.particle_radius = own.particle_radius;
    if (!style_.black_body) style_.black_body = own.black_body;
    if (!style_.light && !own.light.empty()) style_.light = lighting_from_name(own.light);
    if (!style_.background) style_.background = Background{own.background, own.transparent};
    if (!style_.ground && own.ground) style_.ground = Ground{Ground::Kind::at_height, *own.ground};
}

void RunPictures::set_scenery(PictureOptions& options) const {
    options.lighting = style_.light.value_or(Lighting::day);
    if (!style_.background) return;
    options.background = style_.background->color;
    options.transparent = style_.background->transparent;
}

void RunPictures::lay_ground(const RunFolder& folder) {
    if (!style_.ground || style_.ground->kind == Ground::Kind::none) return;
    const Vec3 up = normalized(style_.up ? *style_.up : folder.info.up);
    double height = style_.ground->height;
    if (style_.ground->kind == Ground::Kind::automatic) {
        height = std::numeric_limits<double>::infinity();
        for (const std::vector<Vec3>* points : {&subject_.particles, &subject_.colliders}) {
            for (const Vec3& p : *points) {
                if (is_finite(p)) height = std::min(height, dot(p, up));
            }
        }
        if (!std::isfinite(height)) height = 0.0;
    }
    planes_.push_back({height * up, up, kPlaneColor});
}

void RunPictures::choose_camera(const RunFolder& folder, double aspect) {
    const Vec3 up = style_.up ? *style_.up : folder.info.up;
    if (style_.camera) {
        camera_ = *style_.camera;
        camera_.up = up;
    } else if (const auto& own = folder.info.camera) {
        camera_ = {own->position, own->target, up, own->field_of_view_degrees, own->aperture, own->focus_distance};
    } else {
        camera_ = automatic_camera(subject_, up, aspect);
    }
    if (style_.lens) {
        camera_.aperture = style_.lens->aperture;
        camera_.focus_distance = style_.lens->focus_distance;
    }
    subject_ = {};
}

Vec3 RunPictures::camera_place_in(const VtkPolyData& frame) const {
    const auto camera_position = camera_of_frame(frame);
    return camera_position && !style_.camera ? camera_position->position : camera_.position;
}

/// Returns the visible meshes at rest, and the planes.
WallClearance RunPictures::walls_at_rest() const {
    WallClearance walls(planes_);
    for (const std::filesystem::path& file : mesh_files_) {
        VtkPolyData data = read_vtp(file);
        walls.add({std::move(data.points), std::move(data.triangles)});
    }
    return walls;
}

// Returns true if a mesh encloses most of the probes, which are particle positions, but not the eye of the camera.
bool RunPictures::hides(const TriangleMesh& mesh, const std::vector<Vec3>& probes, const Vec3& eye) const {
    constexpr double kInside = 0.5;  // threshold of the winding number, which is 1 inside a closed mesh
    const Box3 box = bounds(mesh);
    const auto in_box = std::count_if(probes.begin(), probes.end(), [&](const Vec3& p) { return box.contains(p); });
    if (2 * static_cast<std::size_t>(in_box) <= probes.size()) return false;
    if (std::fabs(winding_number(mesh, eye)) > kInside) return false;
    std::vector<std::uint8_t> is_inside(probes.size(), 0);
    parallel_for_blocks(probes.size(), 1, [&](std::size_t i, std::size_t, std::size_t) {
        is_inside[i] = box.contains(probes[i]) && std::fabs(winding_number(mesh, probes[i])) > kInside ? 1 : 0;
    });
    return 2 * std::accumulate(is_inside.begin(), is_inside.end(), std::size_t{0}) > probes.size();
}

// Finds a collider that hides the particles from the camera. Uses the last chosen frame that contains particles.
void RunPictures::find_hiding(const RunFolder& folder, const std::vector<FrameFile>& chosen) {
    constexpr std::size_t kProbes = 32;
    const std::vector<FrameFile> sample = spread_sample(chosen);
    for (auto file = sample.rbegin(); file != sample.rend(); ++file) {
        const VtkPolyData frame = read_frame(file->path);
        if (frame.points.empty()) continue;
        std::vector<Vec3> probes;
        const std::size_t stride = (frame.points.size() - 1) / kProbes + 1;
        for (std::size_t i = 0; i < frame.points.size(); i += stride) probes.push_back(frame.points[i]);
        const Vec3 eye = camera_place_in(frame);
        for (std::size_t m = 0; m < meshes_.size(); ++m) {
            if (!meshes_[m].glass && hides(meshes_[m].mesh, probes, eye))
                hiding_ = collider_name(folder.info, mesh_files_[m]);
        }
        if (file->moving.empty() || !hiding_.empty()) return;
        for (const auto& [number, mesh] : read_moving_meshes(*file)) {
            const Looks& looks = moving_looks_[number];
            if (!looks.glass && !looks.hidden && hides(mesh, probes, eye))
                hiding_ = collider_name(folder.info, moving_files_[number]);
        }
        return;
    }
}

void RunPictures::place_camera(const VtkPolyData& frame) {
    const auto camera_position = camera_of_frame(frame);
    if (!camera_position || style_.camera) return;
    camera_.position = camera_position->position;
    camera_.target = camera_position->target;
    if (!style_.up) camera_.up = normalized(camera_position->up);
}

}  // namespace ricochet::cli
