#include "ricochet/collision/collision_world.h"

#include <algorithm>
#include <limits>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1 << 14;

[[noreturn]] void refuse(const ColliderDescription& collider, const std::string& what) {
    throw InputError("collider \"" + collider.name + "\": " + what);
}

AffineMap checked_map(const ColliderDescription& collider, const Placement& placement) {
    const AffineMap map = world_from_local(placement);
    const double determinant = map.determinant();
    if (!is_finite(map.row_x) || !is_finite(map.row_y) || !is_finite(map.row_z) || !is_finite(map.translation)) {
        refuse(collider, "its placement is not finite, expected finite position, rotation and scale");
    }
    if (determinant == 0.0) refuse(collider, "its placement is singular, expected a scale without zeros");
    return map;
}

}  // namespace

CollisionWorld::CollisionWorld(std::vector<ColliderDescription> colliders)
    : colliders_(std::move(colliders)), bvh_({}, {}, 0.0) {
    for (ColliderDescription& collider : colliders_) {
        if (const auto* plane = std::get_if<PlaneShape>(&collider.shape)) {
            add_plane(collider, *plane);
        } else {
            auto& mesh = std::get<MeshShape>(collider.shape);
            add_mesh(collider, mesh);
            mesh.mesh.reset();  // the baked copy is the collider from here on
        }
    }
    flag_degenerate_triangles();
    for (const Triangle& t : triangles_) {
        for (const std::uint32_t v : t) bounds_.include(vertices_[v]);
    }
    bvh_ = TriangleBvh(vertices_, triangles_, curvature_allowance());
}

void CollisionWorld::add_plane(const ColliderDescription& collider, const PlaneShape& shape) {
    const double size = length(shape.normal);
    if (!(size > 0.0) || !std::isfinite(size))
        refuse(collider, "its normal is zero or not finite, expected a direction");
    if (!is_finite(shape.point) || max_abs(shape.point) > kLargestCoordinate) {
        refuse(collider, "its point is not finite or beyond 1e75 m");
    }
    const auto surface = static_cast<SurfaceId>(surface_count_);
    // The running triangle count keeps the ranges sorted by first triangle.
    ranges_.push_back(
        {surface, static_cast<std::uint32_t>(triangles_.size()), 0, static_cast<std::uint32_t>(planes_.size()), true});
    planes_.push_back({{flush_tiny(shape.point), flush_tiny(shape.normal / size)}, surface});
    ++surface_count_;
}

void CollisionWorld::add_mesh(const ColliderDescription& collider, const MeshShape& shape) {
    if (!shape.mesh || shape.mesh->triangles.empty())
        refuse(collider, "its mesh has no triangles, expected at least one");
    const TriangleMesh& mesh = *shape.mesh;
    const std::size_t triangles_after = triangles_.size() + mesh.triangles.size();
    if (std::max(triangles_after, vertices_.size() + mesh.vertices.size()) >
        std::numeric_limits<SurfaceId>::max() / 2) {
        refuse(collider, "the scene's meshes have more than 2^31 triangles or vertices together");
    }
    const AffineMap map = checked_map(collider, shape.placement);
    const auto base = static_cast<std::uint32_t>(vertices_.size());
    ranges_.push_back(
        {static_cast<SurfaceId>(surface_count_), static_cast<std::uint32_t>(triangles_.size()), base, 0, false});
    vertices_.reserve(vertices_.size() + mesh.vertices.size());
    for (const Vec3& v : mesh.vertices) {
        const Vec3 placed = flush_tiny(map.point(v));
        if (!is_finite(placed) || max_abs(placed) > kLargestCoordinate) {
            refuse(collider, "a placed vertex is not finite or beyond 1e75 m, expected a smaller position or scale");
        }
        vertices_.push_back(placed);
    }
    const bool flip = map.mirrors();
    triangles_.reserve(triangles_after);
    for (const Triangle& t : mesh.triangles) {
        triangles_.push_back(flip ? Triangle{base + t[0], base + t[2], base + t[1]}
                                  : Triangle{base + t[0], base + t[1], base + t[2]});
    }
    surface_count_ += mesh.triangles.size();
}

void CollisionWorld::flag_degenerate_triangles() {
    degenerate_.assign(triangles_.size(), 0);
    parallel_for_blocks(triangles_.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const auto [a, b, c] = corners_of_triangle(static_cast<std::uint32_t>(t));
            degenerate_[t] = are_collinear(a, b, c) ? 1 : 0;
        }
    });
    degenerate_count_ = static_cast<std::size_t>(std::count(degenerate_.begin(), degenerate_.end(), 1));
    if (degenerate_count_ == 0) degenerate_ = {};
}

// An eighth of the mean triangle's box: boxes grow little, and few paths need more than one chord.
double CollisionWorld::curvature_allowance() const {
    if (triangles_.empty()) return 0.0;
    const double sum = ordered_sum(triangles_.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        double partial = 0.0;
        for (std::size_t t = begin; t < end; ++t) {
            Box3 box;
            for (const std::uint32_t v : triangles_[t]) box.include(vertices_[v]);
            partial += box.diagonal();
        }
        return partial;
    });
    return 0.125 * sum / static_cast<double>(triangles_.size());
}

std::uint32_t CollisionWorld::collider_of(SurfaceId surface) const {
    const auto after = std::upper_bound(ranges_.begin(), ranges_.end(), surface,
                                        [](SurfaceId s, const Range& range) { return s < range.first_surface; });
    return static_cast<std::uint32_t>(after - ranges_.begin() - 1);
}

SurfaceName CollisionWorld::name_of(SurfaceId surface) const {
    const std::uint32_t collider = collider_of(surface);
    return {collider, surface - ranges_[collider].first_surface};
}

SurfaceId CollisionWorld::surface_of_triangle(std::uint32_t triangle) const {
    // Planes own no triangles, so the last range that starts at or before the triangle and is a mesh is the owner.
    auto after = std::upper_bound(ranges_.begin(), ranges_.end(), triangle,
                                  [](std::uint32_t t, const Range& range) { return t < range.first_triangle; });
    --after;
    return after->first_surface + (triangle - after->first_triangle);
}

bool CollisionWorld::is_plane(SurfaceId surface) const { return ranges_[collider_of(surface)].is_plane; }

Vec3 CollisionWorld::unit_normal_of(SurfaceId surface) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.is_plane) return planes_[range.plane].plane.normal;
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return unit_normal(a, b, c);
}

double CollisionWorld::signed_distance_from(SurfaceId surface, const Vec3& p) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.is_plane) return signed_distance(p, planes_[range.plane].plane);
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return signed_distance(p, a, b, c);
}

int CollisionWorld::side_of_surface(SurfaceId surface, const Vec3& p) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.is_plane) return side_of(planes_[range.plane].plane, p);
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return orient3d(a, b, c, p);
}

double CollisionWorld::time_over(SurfaceId surface, const Path& path, double slack) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.is_plane) return path.duration;
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return time_over_triangle(path, a, b, c, unit_normal(a, b, c), slack);
}

bool CollisionWorld::segment_meets(SurfaceId surface, const Vec3& p, const Vec3& q) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.is_plane) {
        const Plane& plane = planes_[range.plane].plane;
        return side_of(plane, p) * side_of(plane, q) <= 0;
    }
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return segment_meets_triangle(p, q, a, b, c);
}

std::size_t CollisionWorld::surface_count_of(std::size_t collider) const {
    const std::size_t end = collider + 1 < ranges_.size() ? ranges_[collider + 1].first_surface : surface_count_;
    return end - ranges_[collider].first_surface;
}

std::optional<TriangleMesh> CollisionWorld::mesh_of(std::size_t collider) const {
    const Range& range = ranges_[collider];
    if (range.is_plane) return std::nullopt;
    TriangleMesh mesh;
    const std::size_t count = surface_count_of(collider);
    mesh.triangles.reserve(count);
    std::uint32_t last_vertex = range.first_vertex;
    for (std::size_t t = 0; t < count; ++t) {
        const Triangle& world = triangles_[range.first_triangle + t];
        mesh.triangles.push_back(
            {world[0] - range.first_vertex, world[1] - range.first_vertex, world[2] - range.first_vertex});
        last_vertex = std::max({last_vertex, world[0], world[1], world[2]});
    }
    mesh.vertices.assign(vertices_.begin() + range.first_vertex, vertices_.begin() + last_vertex + 1);
    return mesh;
}

}  // namespace ricochet
