#include "ricochet/geometry/mesh/placed_mesh_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "ricochet/core/tolerances.h"

namespace ricochet {

AffineMap joined(const AffineMap& outer, const AffineMap& inner) {
    AffineMap map;
    for (auto row : {&AffineMap::row_x, &AffineMap::row_y, &AffineMap::row_z}) {
        map.*row = inner.direction_back(outer.*row);
    }
    map.translation = outer.point(inner.translation);
    return map;
}

std::string misplaced_point(std::size_t number, const Vec3& placed) {
    return fmt::format("point {} is ({}, {}, {}) in the scene, expected finite numbers of at most {} in size", number,
                       placed.x, placed.y, placed.z, kLargestCoordinate);
}

void PlacedMeshBuilder::reserve(std::size_t corners) {
    mesh_.corners.reserve(corners);
    mesh_.face_offsets.reserve(corners / 3 + 1);
}

void PlacedMeshBuilder::begin(const AffineMap& world, const std::string& object, const std::string& group) {
    world_ = world;
    mirrors_ = world.mirrors();
    names_.names() = {"", group, object};
    points_.clear();
    welder_.emplace(points_);
}

std::optional<Vec3> PlacedMeshBuilder::add_corner(const Vec3& local) {
    const Vec3 placed = world_.point(local);
    Vec3 point = placed;
    for (int axis = 0; axis < 3; ++axis) {
        const std::optional<double> accepted = accepted_coordinate(point[axis]);
        if (!accepted) return placed;
        point[axis] = *accepted;
    }
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    mesh_.corners.push_back(first + welder_->index_of(y_up_as_z_up(point)));
    return std::nullopt;
}

void PlacedMeshBuilder::end_face() {
    const std::size_t begin = mesh_.face_offsets.back();
    if (mirrors_) std::reverse(mesh_.corners.begin() + static_cast<std::ptrdiff_t>(begin) + 1, mesh_.corners.end());
    close_face(mesh_);
    names_.record(mesh_);
}

void PlacedMeshBuilder::end() { mesh_.vertices.insert(mesh_.vertices.end(), points_.begin(), points_.end()); }

ImportedMesh PlacedMeshBuilder::finish(std::string format) {
    const WeldReport weld{mesh_.corners.size(), mesh_.vertices.size()};
    ImportedMesh result = imported(std::move(mesh_), std::move(format), weld);
    result.y_up = true;
    return result;
}

}  // namespace ricochet
