// Where pictures of a run are taken from, and what is around.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "cli/run_pictures.h"
#include "ricochet/io/camera_frames.h"

namespace ricochet::cli {

// What the command line leaves open is as the scene says.
void RunPictures::choose_scenery(const RunInfo& info) {
    if (!info.picture) return;
    const PictureDescription& own = *info.picture;
    if (style_.drawing == ParticleDrawing::automatic && !own.particles.empty()) {
        style_.drawing = drawing_from_name(own.particles).value_or(style_.drawing);
    }
    if (!style_.shutter) style_.shutter = own.shutter;
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

void RunPictures::place_camera(const VtkPolyData& frame) {
    const auto place = camera_of_frame(frame);
    if (!place || style_.camera) return;
    camera_.position = place->position;
    camera_.target = place->target;
    if (!style_.up) camera_.up = normalized(place->up);
}

}  // namespace ricochet::cli
