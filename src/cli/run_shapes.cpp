// Shapes of a run's particles: images, copies of a mesh, and stretched balls.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "cli/run_pictures.h"
#include "ricochet/core/box3.h"
#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "view/render/turning.h"

namespace ricochet::cli {
namespace {

template <class Value>
const std::vector<Value>& column(const VtkPolyData& frame, std::string_view name) {
    static const std::vector<Value> kNone;
    const VtkArray* array = find_array(frame.point_arrays, std::string(name));
    const auto* values = array == nullptr ? nullptr : std::get_if<std::vector<Value>>(&array->values);
    return values == nullptr ? kNone : *values;
}

template <class Value>
Value value_of(const std::vector<Value>& values, std::size_t i, Value otherwise) {
    return i < values.size() ? values[i] : otherwise;
}

ParticleShape::Facing facing_of(const std::string& name) {
    if (name == "random") return ParticleShape::Facing::random;
    return name == "velocity" ? ParticleShape::Facing::velocity : ParticleShape::Facing::upright;
}

std::uint64_t id_of(const std::vector<std::int64_t>& ids, std::size_t i) {
    return static_cast<std::uint64_t>(value_of(ids, i, static_cast<std::int64_t>(i)));
}

}  // namespace

TriangleMesh shape_from(const std::filesystem::path& file) {
    TriangleMesh mesh = read_mesh(file, MeshContent::triangles).mesh;
    const Vec3 middle = bounds(mesh).center();
    double reach = 0.0;
    for (Vec3& v : mesh.vertices) {
        v -= middle;
        reach = std::max(reach, length(v));
    }
    if (!(reach > 0.0)) throw InputError(fmt::format("{}: has no size, expected a mesh to draw", file.string()));
    for (Vec3& v : mesh.vertices) v = v / reach;
    return mesh;
}

// Chooses the drawings. A drawing on the command line applies to all particles.
void RunPictures::choose_shape(const RunFolder& folder) {
    const std::filesystem::path own = folder.frames.front().path.parent_path();
    Drawing common{style_.drawing, {}, 0, nullptr};
    if (const auto& picture = folder.info.picture) {
        if (style_.sprite.empty() && !picture->sprite.empty()) style_.sprite = own / picture->sprite;
        if (style_.mesh.empty() && !picture->mesh.empty()) style_.mesh = own / picture->mesh;
        common.shape = {facing_of(picture->turn), picture->turning.value_or(MeanSpread{}), picture->stretch};
    }
    load_drawing(common, style_.sprite, style_.mesh);
    drawings_ = {common};
    for (const ParticleDrawingDescription& drawing : folder.info.drawings) {
        if (!is_told_) add_drawing(folder, drawing);
    }
    if (!shapes_.empty()) turning_ = RunTurning(folder.frames);
}

// Adds the drawing of the particles of some emitters.
void RunPictures::add_drawing(const RunFolder& folder, const ParticleDrawingDescription& own) {
    const std::filesystem::path files = folder.frames.front().path.parent_path();
    const auto& picture = folder.info.picture;
    Drawing drawing{drawing_from_name(own.particles).value_or(ParticleDrawing::spheres),
                    {facing_of(own.turn), own.turning.value_or(MeanSpread{}),
                     picture ? picture->stretch : std::optional<StretchDescription>{}},
                    0,
                    nullptr};
    load_drawing(drawing, files / own.sprite, files / own.mesh);
    drawings_.push_back(std::move(drawing));
}

void RunPictures::load_drawing(Drawing& drawing, const std::filesystem::path& sprite,
                               const std::filesystem::path& mesh) {
    if (drawing.kind == ParticleDrawing::sprites) {
        if (sprite.empty()) throw InputError("--draw sprites: the run has no sprite, expected --sprite FILE.png");
        const Image image = read_png(sprite);
        require_memory(SpriteImage::bytes(static_cast<double>(image.rgb.size()) / 3.0), sprite.string());
        drawing.sprite = std::make_shared<const SpriteImage>(image);
    }
    if (drawing.kind == ParticleDrawing::meshes) {
        if (mesh.empty()) throw InputError("--draw meshes: the run has no mesh for it, expected --mesh FILE");
        shapes_.push_back(shape_from(mesh));
        drawing.mesh = static_cast<std::uint32_t>(shapes_.size());
    }
}

bool RunPictures::draws_copies() const {
    return std::any_of(drawings_.begin(), drawings_.end(), [](const Drawing& drawing) { return drawing.is_copy(); });
}

// Adds the extent of large particles to the view.
void RunPictures::widen_subject(const VtkPolyData& frame) {
    const bool has_images = std::any_of(drawings_.begin(), drawings_.end(),
                                        [](const Drawing& drawing) { return drawing.sprite != nullptr; });
    if (!has_images && !draws_copies()) return;
    const auto& radii = column<double>(frame, has_sizes_ ? kSizeAttribute : std::string_view("radius"));
    const auto& stretch = drawings_[0].shape.stretch;
    const double longest = stretch && draws_copies() ? stretch->most : 1.0;
    for (std::size_t i = 0; i < frame.points.size(); ++i) {
        const double reach = style_.particle_radius.value_or(longest * value_of(radii, i, 0.0));
        if (!(reach > 0.0)) continue;
        for (const double side : {-reach, reach}) {
            subject_.particles.push_back(frame.points[i] + Vec3{side, side, side});
        }
    }
}

void RunPictures::require_room_for_copies() const {
    if (!draws_copies()) return;
    constexpr double kCopy = 600.0;       // bytes of a copy, including its entries in the lists of a picture and in
                                          // Embree's BVH
    constexpr double kPathPoint = 300.0;  // bytes of a point of a path: two copies of the point, and its entry in the
                                          // BVH
    constexpr double kTriangle = 400.0;
    const double paths =
        shutter() > 0.0 ? kPathPoint * (timeline_.knows_impacts() ? kMostPathSteps : kFewPathSteps) : 0.0;
    double triangles = 0.0;
    for (const TriangleMesh& shape : shapes_) triangles += static_cast<double>(shape.triangles.size());
    require_memory(static_cast<double>(most_particles_) * (kCopy + paths) + triangles * kTriangle,
                   fmt::format("a picture of {} particles as {}", most_particles_,
                               shapes_.empty() ? "spheres that stretch" : "meshes"));
}

std::vector<AffineMap> RunPictures::turns_of(const Group& group) const {
    std::vector<AffineMap> maps(group.shown.size());
    if (group.drawing->mesh == 0) return maps;
    for (std::size_t k = 0; k < maps.size(); ++k) maps[k] = map_of(turns_[group.shown[k]]);
    return maps;
}

// Stretches copies along the velocity. Near an impact, copies are flattened along the contact normal instead. Flattened
// copies are moved towards the surface, so that they touch it.
void RunPictures::stretch_copies(const VtkPolyData& frame, const Group& group, const std::vector<double>& radii,
                                 PreviewCopies& copies) {
    const StretchDescription& stretch = *group.drawing->shape.stretch;
    const std::vector<std::size_t>& shown = group.shown;
    std::vector<NearImpact> impacts(frame.points.size());
    if (stretch.impact > 0.0) impacts = timeline_.impacts_near(frame, frame.time, 0.5 * stretch.time);
    const auto& velocities = column<Vec3>(frame, "velocity");
    for (std::size_t k = 0; k < shown.size(); ++k) {
        const Vec3 velocity = value_of(velocities, shown[k], Vec3{});
        const NearImpact& impact = impacts[shown[k]];
        const double swing = impact.speed > 0.0 ? std::cos(std::numbers::pi * impact.away / stretch.time) : 0.0;
        const double near = swing * swing;
        AffineMap shape;
        const double speed = length(velocity);
        const double longer = std::min(stretch.most, 1.0 + stretch.speed * speed) - 1.0;
        if (longer > 0.0 && speed > 0.0) shape = stretch_along(velocity / speed, 1.0 + (1.0 - near) * longer);
        AffineMap& placement = copies.placements[k];
        if (near > 0.0) {
            const double flat = std::max(1.0 / stretch.most, 1.0 / (1.0 + stretch.impact * impact.speed));
            const double high = 1.0 - near * (1.0 - flat);
            shape = linear_product(stretch_along(impact.normal, high), shape);
            const Vec3 shift = radii[k] * (high - 1.0) * impact.normal;
            placement.translation += shift;
            if (!copies.shutter_paths.empty()) {
                for (Vec3& point : copies.shutter_paths[k]) point += shift;
            }
        }
        const Vec3 translation = placement.translation;
        placement = linear_product(shape, placement);
        placement.translation = translation;
    }
}

// Adds the particles of a group as copies of a mesh or of a ball.
void RunPictures::add_copies(const Moment& moment, const Group& group, PreviewSpheres&& spheres, PreviewCopies& all) {
    PreviewCopies copies;
    copies.placements = turns_of(group);
    for (std::size_t k = 0; k < copies.placements.size(); ++k) {
        AffineMap& placement = copies.placements[k];
        for (Vec3* const row : {&placement.row_x, &placement.row_y, &placement.row_z}) *row = spheres.radii[k] * *row;
        placement.translation = spheres.centers[k];
    }
    copies.shutter_paths = std::move(spheres.shutter_paths);
    if (group.drawing->shape.stretch) stretch_copies(moment.frame, group, spheres.radii, copies);
    all.placements.insert(all.placements.end(), copies.placements.begin(), copies.placements.end());
    all.shutter_paths.insert(all.shutter_paths.end(), std::make_move_iterator(copies.shutter_paths.begin()),
                             std::make_move_iterator(copies.shutter_paths.end()));
    all.colors.insert(all.colors.end(), spheres.colors.begin(), spheres.colors.end());
    all.emissions.insert(all.emissions.end(), spheres.emissions.begin(), spheres.emissions.end());
    all.shapes.resize(all.placements.size(), group.drawing->mesh);
}

std::vector<double> RunPictures::sprite_angles(const VtkPolyData& frame, const Group& group) const {
    const auto& ids = column<std::int64_t>(frame, "id");
    const auto& ages = column<double>(frame, "age");
    const auto& velocities = column<Vec3>(frame, "velocity");
    const CameraFrame view = camera_frame(camera_);
    const ParticleShape& shape = group.drawing->shape;
    std::vector<double> angles(group.shown.size(), 0.0);
    for (std::size_t k = 0; k < angles.size(); ++k) {
        const std::size_t i = group.shown[k];
        const ParticleTurning own = particle_turning(id_of(ids, i));
        if (shape.facing == ParticleShape::Facing::random) {
            angles[k] = own.angle;
        } else if (shape.facing == ParticleShape::Facing::velocity) {
            const Vec3 velocity = value_of(velocities, i, Vec3{});
            const Vec3 away = frame.points[i] - camera_.position;
            const double depth = dot(away, view.forward);
            const double nearer = dot(velocity, view.forward) / depth;
            const double right = dot(velocity, view.right) - dot(away, view.right) * nearer;
            const double up = dot(velocity, view.up) - dot(away, view.up) * nearer;
            if (depth > 0.0 && std::hypot(right, up) > 0.0) angles[k] = std::atan2(-right, up);
        }
        angles[k] += (shape.turning.mean + own.spread * shape.turning.spread) * value_of(ages, i, 0.0);
    }
    return angles;
}

}  // namespace ricochet::cli
