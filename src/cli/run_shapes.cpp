// What the particles of a run's pictures are: images, copies of a mesh, balls that stretch.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
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
#include "ricochet/io/picture_files.h"
#include "ricochet/render/turning.h"

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

// The middle of its box in the origin, its farthest vertex 1 away.
TriangleMesh fitted(TriangleMesh mesh, const std::filesystem::path& file) {
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

ParticleShape::Facing facing_of(const std::string& name) {
    if (name == "random") return ParticleShape::Facing::random;
    return name == "velocity" ? ParticleShape::Facing::velocity : ParticleShape::Facing::upright;
}

std::uint64_t id_of(const std::vector<std::int64_t>& ids, std::size_t i) {
    return static_cast<std::uint64_t>(value_of(ids, i, static_cast<std::int64_t>(i)));
}

}  // namespace

void RunPictures::choose_shape(const RunFolder& folder) {
    const std::filesystem::path own = folder.frames.front().path.parent_path();
    if (const auto& picture = folder.info.picture) {
        if (style_.sprite.empty() && !picture->sprite.empty()) style_.sprite = own / picture->sprite;
        if (style_.mesh.empty() && !picture->mesh.empty()) style_.mesh = own / picture->mesh;
        shape_ = {facing_of(picture->turn), picture->turning.value_or(MeanSpread{}), picture->stretch};
    }
    if (style_.drawing == ParticleDrawing::sprites) {
        if (style_.sprite.empty())
            throw InputError("--draw sprites: the run has no sprite, expected --sprite FILE.png");
        const Image image = read_png(style_.sprite);
        require_memory(SpriteImage::bytes(static_cast<double>(image.rgb.size()) / 3.0), style_.sprite.string());
        sprite_ = std::make_shared<const SpriteImage>(image);
    }
    if (style_.drawing == ParticleDrawing::meshes) {
        if (style_.mesh.empty()) throw InputError("--draw meshes: the run has no mesh for it, expected --mesh FILE");
        shape_mesh_ = fitted(read_mesh(style_.mesh, MeshContent::triangles).mesh, style_.mesh);
        turning_ = RunTurning(folder.frames);
    }
}

bool RunPictures::draws_copies() const {
    return style_.drawing == ParticleDrawing::meshes || (style_.drawing == ParticleDrawing::spheres && shape_.stretch);
}

// Large ones reach further than their middles.
void RunPictures::widen_subject(const VtkPolyData& frame) {
    if (!sprite_ && !draws_copies()) return;
    const auto& radii = column<double>(frame, has_sizes_ ? kSizeAttribute : std::string_view("radius"));
    const double longest = shape_.stretch && draws_copies() ? shape_.stretch->most : 1.0;
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
    constexpr double kCopy = 600.0;      // with its entries in the lists of a picture and in Embree's hierarchy
    constexpr double kWayPoint = 300.0;  // twice as a point, and in the hierarchy
    constexpr double kTriangle = 400.0;
    const double ways = shutter() > 0.0 ? kWayPoint * (timeline_.knows_impacts() ? kMostWaySteps : kFewWaySteps) : 0.0;
    const double triangles = shape_mesh_ ? static_cast<double>(shape_mesh_->triangles.size()) : 0.0;
    require_memory(static_cast<double>(most_particles_) * (kCopy + ways) + triangles * kTriangle,
                   fmt::format("a picture of {} particles as {}", most_particles_,
                               shape_mesh_ ? "meshes" : "spheres that stretch"));
}

std::vector<AffineMap> RunPictures::turns_of(const VtkPolyData& frame, const std::vector<std::size_t>& shown) {
    std::vector<AffineMap> maps(shown.size());
    if (!shape_mesh_) return maps;
    const bool spins = find_array(frame.point_arrays, "spin") != nullptr;
    const std::vector<Turn> turns = spins ? turning_.turns(frame) : std::vector<Turn>{};
    const auto& ids = column<std::int64_t>(frame, "id");
    const auto& ages = column<double>(frame, "age");
    const auto& radii = column<double>(frame, "radius");
    for (std::size_t k = 0; k < shown.size(); ++k) {
        const std::size_t i = shown[k];
        if (spins && value_of(radii, i, 0.0) > 0.0) {
            maps[k] = map_of(turns[i]);
            continue;
        }
        const OwnTurning own = own_turning(id_of(ids, i));
        const double rate = shape_.turning.mean + own.spread * shape_.turning.spread;
        maps[k] = map_of(turned_on(random_turn(id_of(ids, i)), rate * own.axis, value_of(ages, i, 0.0)));
    }
    return maps;
}

// Along the velocity longer; near an impact flatter along its normal instead, and nearer to the surface by what the
// flattening would leave between them.
void RunPictures::stretch_copies(const VtkPolyData& frame, const std::vector<std::size_t>& shown,
                                 PreviewMoving& moving) {
    const StretchDescription& stretch = *shape_.stretch;
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
        AffineMap& place = moving.copies.places[k];
        if (near > 0.0) {
            const double flat = std::max(1.0 / stretch.most, 1.0 / (1.0 + stretch.impact * impact.speed));
            const double high = 1.0 - near * (1.0 - flat);
            shape = linear_product(stretch_along(impact.normal, high), shape);
            const Vec3 shift = moving.spheres.radii[k] * (high - 1.0) * impact.normal;
            place.translation += shift;
            if (!moving.copies.ways.empty()) {
                for (Vec3& point : moving.copies.ways[k]) point += shift;
            }
        }
        const Vec3 translation = place.translation;
        place = linear_product(shape, place);
        place.translation = translation;
    }
}

// Spheres become copies.
void RunPictures::make_copies(const Moment& moment, const std::vector<std::size_t>& shown, PreviewMoving& moving) {
    PreviewSpheres& spheres = moving.spheres;
    PreviewCopies& copies = moving.copies;
    copies.places = turns_of(moment.frame, shown);
    for (std::size_t k = 0; k < shown.size(); ++k) {
        AffineMap& place = copies.places[k];
        for (Vec3* const row : {&place.row_x, &place.row_y, &place.row_z}) *row = spheres.radii[k] * *row;
        place.translation = spheres.centers[k];
    }
    copies.ways = std::move(spheres.ways);
    if (shape_.stretch) stretch_copies(moment.frame, shown, moving);
    copies.colors = std::move(spheres.colors);
    copies.emissions = std::move(spheres.emissions);
    spheres = {};
}

std::vector<double> RunPictures::sprite_angles(const VtkPolyData& frame) const {
    const auto& ids = column<std::int64_t>(frame, "id");
    const auto& ages = column<double>(frame, "age");
    const auto& velocities = column<Vec3>(frame, "velocity");
    const CameraFrame view = camera_frame(camera_);
    std::vector<double> angles(frame.points.size(), 0.0);
    for (std::size_t i = 0; i < angles.size(); ++i) {
        const OwnTurning own = own_turning(id_of(ids, i));
        if (shape_.facing == ParticleShape::Facing::random) {
            angles[i] = own.angle;
        } else if (shape_.facing == ParticleShape::Facing::velocity) {
            const Vec3 velocity = value_of(velocities, i, Vec3{});
            const Vec3 away = frame.points[i] - camera_.position;
            const double depth = dot(away, view.forward);
            const double nearer = dot(velocity, view.forward) / depth;
            const double right = dot(velocity, view.right) - dot(away, view.right) * nearer;
            const double up = dot(velocity, view.up) - dot(away, view.up) * nearer;
            if (depth > 0.0 && std::hypot(right, up) > 0.0) angles[i] = std::atan2(-right, up);
        }
        angles[i] += (shape_.turning.mean + own.spread * shape_.turning.spread) * value_of(ages, i, 0.0);
    }
    return angles;
}

}  // namespace ricochet::cli
