#include "ricochet/compare/detail/surface_normals.h"

#include <cmath>
#include <cstddef>
#include <variant>

namespace ricochet::detail {

SurfaceNormals::SurfaceNormals(const Simulation& simulation) {
    for (std::size_t i = 0; i < simulation.colliders().size(); ++i) {
        const ColliderShape& shape = simulation.colliders()[i].shape;
        Surface& surface = surfaces_.emplace_back();
        if (const auto* ball = std::get_if<BallShape>(&shape)) {
            surface.shape = Shape{world_from_unit(*ball), false};
        } else if (const auto* cylinder = std::get_if<CylinderShape>(&shape)) {
            surface.shape = Shape{world_from_unit(*cylinder), true};
        } else if (!std::holds_alternative<PlaneShape>(shape)) {
            surface.mesh = simulation.collider_mesh(i);
        }
    }
}

Vec3 SurfaceNormals::at(const Violation& crossing) const {
    const Surface& surface = surfaces_[*crossing.collider];
    if (surface.shape) return shape_normal(*surface.shape, crossing.place);
    if (!surface.mesh || !crossing.triangle) return {};
    const auto [a, b, c] = surface.mesh->triangles[*crossing.triangle];
    const auto& vertices = surface.mesh->vertices;
    return cross(vertices[b] - vertices[a], vertices[c] - vertices[a]);
}

// Normals go into the world by the transposed inverse, whose columns are the cross products of the map's own.
Vec3 SurfaceNormals::shape_normal(const Shape& shape, const Vec3& place) {
    const AffineMap& map = shape.world_from_unit;
    const Vec3 x{map.row_x.x, map.row_y.x, map.row_z.x};
    const Vec3 y{map.row_x.y, map.row_y.y, map.row_z.y};
    const Vec3 z{map.row_x.z, map.row_y.z, map.row_z.z};
    const double determinant = map.determinant();
    const Vec3 along_x = cross(y, z) / determinant;
    const Vec3 along_y = cross(z, x) / determinant;
    const Vec3 along_z = cross(x, y) / determinant;
    const Vec3 from_centre = place - map.translation;
    Vec3 unit{dot(along_x, from_centre), dot(along_y, from_centre), dot(along_z, from_centre)};
    if (shape.is_cylinder) {
        const double to_side = std::fabs(1.0 - std::hypot(unit.x, unit.y)) * length(x);
        const double to_cap = std::fabs(1.0 - std::fabs(unit.z)) * length(z);
        unit = to_cap < to_side ? Vec3{0.0, 0.0, unit.z} : Vec3{unit.x, unit.y, 0.0};
    }
    return unit.x * along_x + unit.y * along_y + unit.z * along_z;
}

}  // namespace ricochet::detail
