#include "ricochet/collision/collision_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

constexpr std::size_t kBlock = 1 << 14;

[[noreturn]] void refuse(const ColliderDescription& collider, const std::string& what) {
    throw InputError("collider \"" + collider.name + "\": " + what);
}

AffineMap checked_map(const ColliderDescription& collider, const AffineMap& map) {
    const double determinant = map.determinant();
    if (!is_finite(map.row_x) || !is_finite(map.row_y) || !is_finite(map.row_z) || !is_finite(map.translation)) {
        refuse(collider, "its placement is not finite, expected finite position, rotation and scale");
    }
    if (determinant == 0.0) refuse(collider, "its placement is singular, expected a scale without zeros");
    return map;
}

/// Throws InputError if a surface is too small after its placement. `extents`, in m, are its sizes along its own axes.
/// A scale of zero is left to checked_map().
void require_size(const ColliderDescription& collider, const AffineMap& map, const Vec3& extents) {
    for (int axis = 0; axis < 3; ++axis) {
        const double scale = max_abs(Vec3{map.row_x[axis], map.row_y[axis], map.row_z[axis]});
        const double size = extents[axis] * scale;
        if (size >= kSmallestSize || extents[axis] == 0.0 || scale == 0.0) continue;
        if (!std::isfinite(scale)) continue;
        refuse(collider,
               fmt::format("it measures {:g} m along its own {} axis, expected at least {:g} m: choose a larger "
                           "size, scale or unit",
                           size, "xyz"[axis], kSmallestSize));
    }
}

/// Throws InputError if a mesh is too small after its placement. A mesh may be flat, so its largest extent counts for
/// all axes.
void require_size(const ColliderDescription& collider, const AffineMap& map, const std::vector<Vec3>& vertices) {
    Box3 box;
    for (const Vec3& vertex : vertices) box.include(vertex);
    const double largest = vertices.empty() ? 0.0 : max_abs(box.size());
    require_size(collider, map, Vec3{largest, largest, largest});
}

/// Returns the map of a shape after checks of its size and placement.
AffineMap checked_shape(const ColliderDescription& collider, const AffineMap& map) {
    require_size(collider, map, Vec3{2, 2, 2});
    return checked_map(collider, map);
}

void bake_vertices(const ColliderDescription& collider, const std::vector<Vec3>& local, const AffineMap& map,
                   std::span<Vec3> world) {
    parallel_for_blocks(local.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Vec3 vertex = flush_tiny(map.point(local[i]));
            if (!is_finite(vertex) || max_abs(vertex) > kLargestCoordinate) {
                refuse(collider,
                       "a placed vertex is not finite or beyond 1e75 m, expected a smaller position or scale");
            }
            world[i] = vertex;
        }
    });
}

Box3 box_of(std::span<const Vec3> vertices, std::span<const Triangle> triangles) {
    std::vector<Box3> boxes((triangles.size() + kBlock - 1) / kBlock);
    parallel_for_blocks(triangles.size(), kBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        Box3 box;
        for (std::size_t t = begin; t < end; ++t) {
            for (const std::uint32_t v : triangles[t]) box.include(vertices[v]);
        }
        boxes[block] = box;
    });
    Box3 all;
    for (const Box3& box : boxes) all.include(box);
    return all;
}

/// Returns true if p is above the triangle's face and the distances from its rim and its face differ by rounding only.
/// A sphere that rolls over a rim then changes from face to rim exactly there, and not 1e-8 of its radius too early.
bool is_over_rim(const TrianglePlane& triangle, const Vec3& p, double distance_from_rim) {
    const double height = std::fabs(triangle.signed_distance(p));
    if (height < (1.0 - kRimTie) * distance_from_rim || height == 0.0) return false;
    return projects_into_triangle(p, triangle.a(), triangle.b(), triangle.c(), triangle.unit_normal());
}

}  // namespace

CollisionWorld::CollisionWorld(std::vector<ColliderDescription> colliders, double chord_margin)
    : CollisionWorld(std::make_shared<ColliderList>(std::move(colliders)), {}, chord_margin) {}

CollisionWorld::CollisionWorld(std::shared_ptr<ColliderList> colliders, std::string_view frame, double chord_margin)
    : list_(std::move(colliders)) {
    for (std::size_t number = 0; number < list_->all().size(); ++number) {
        if (list_->all()[number].frame == frame && !is_deforming(list_->all()[number])) {
            add(number);
        } else {
            add_range(number, Kind::elsewhere);
        }
    }
    flag_degenerate_triangles();
    triangle_bounds_ = box_of(vertices_, triangles_);
    bounds_ = triangle_bounds_;
    for (const ShapeSurface& shape : shapes_) bounds_.include(shape.shape.bounds());
    const double extent = triangles_.empty() ? 0.0 : triangle_bounds_.diagonal();
    chord_margin_ = std::max(chord_margin * mean_box(), kLeastChordMargin * extent);
    prepare_radius(0.0);
    distance_field_ = DistanceField(vertices_, triangles_, triangle_bounds_);
}

void CollisionWorld::add(std::size_t number) {
    const ColliderDescription& collider = list_->all()[number];
    if (const auto* plane = std::get_if<PlaneShape>(&collider.shape)) {
        add_plane(number, *plane);
    } else if (const auto* ball = std::get_if<BallShape>(&collider.shape)) {
        add_shape(number, AnalyticShape::ball(checked_shape(collider, world_from_unit(*ball))));
    } else if (const auto* cylinder = std::get_if<CylinderShape>(&collider.shape)) {
        add_shape(number, AnalyticShape::cylinder(checked_shape(collider, world_from_unit(*cylinder))));
    } else if (const auto* cuboid = std::get_if<CuboidShape>(&collider.shape)) {
        require_size(collider, world_from_local(cuboid->placement), cuboid->size);
        add_mesh(number, {std::make_shared<const TriangleMesh>(cuboid_mesh(cuboid->size)), cuboid->placement, {}, {}});
    } else {
        add_mesh(number, std::get<MeshShape>(collider.shape));
        list_->drop_mesh(number);  // the baked copy is the collider from here on
    }
}

/// Appends the range of a collider. The running triangle count keeps the ranges sorted by first triangle.
void CollisionWorld::add_range(std::size_t number, Kind kind, std::size_t index) {
    ranges_.push_back({list_->first_surface_of(number), static_cast<std::uint32_t>(triangles_.size()),
                       static_cast<std::uint32_t>(vertices_.size()), static_cast<std::uint32_t>(index), kind});
}

void CollisionWorld::add_shape(std::size_t number, const AnalyticShape& shape) {
    add_range(number, Kind::shape, shapes_.size());
    shapes_.push_back({shape, list_->first_surface_of(number)});
}

// Boxes of a class are enlarged by its largest radius and the chord margin. Radii up to half the chord margin share the
// class of points.
double CollisionWorld::largest_radius_of_class(double radius) const {
    if (radius <= 0.5 * chord_margin_) return 0.5 * chord_margin_;
    const int exponent = std::ilogb(radius);
    const double power = std::ldexp(1.0, exponent);
    return power == radius ? power : 2.0 * power;
}

void CollisionWorld::prepare_radius(double radius) {
    const double largest = largest_radius_of_class(radius);
    const auto at = std::lower_bound(classes_.begin(), classes_.end(), largest,
                                     [](const RadiusClass& c, double r) { return c.largest_radius < r; });
    if (at != classes_.end() && at->largest_radius == largest) return;
    const double beside_chords = std::max(chord_margin_, kLeastChordMargin * largest);
    const double box_margin = largest <= 0.5 * chord_margin_ ? chord_margin_ : largest + beside_chords;
    if (!clusters_) {
        clusters_ = std::make_shared<const TriangleClusters>(make_clusters(vertices_, triangles_));
    }
    classes_.insert(at, RadiusClass{largest, TriangleBvh(clusters_, box_margin)});
}

const TriangleBvh& CollisionWorld::bvh_for(double radius) const {
    for (const RadiusClass& c : classes_) {
        if (radius <= c.largest_radius) return c.bvh;
    }
    throw RunError("a particle is larger than any radius class that was prepared");
}

void CollisionWorld::add_plane(std::size_t number, const PlaneShape& shape) {
    const ColliderDescription& collider = list_->all()[number];
    const double size = length(shape.normal);
    if (!(size > 0.0) || !std::isfinite(size))
        refuse(collider, "its normal is zero or not finite, expected a direction");
    if (!is_finite(shape.point) || max_abs(shape.point) > kLargestCoordinate) {
        refuse(collider, "its point is not finite or beyond 1e75 m");
    }
    add_range(number, Kind::plane, planes_.size());
    planes_.push_back({{flush_tiny(shape.point), flush_tiny(shape.normal / size)}, list_->first_surface_of(number)});
}

void CollisionWorld::add_mesh(std::size_t number, const MeshShape& shape) {
    const ColliderDescription& collider = list_->all()[number];
    const TriangleMesh& mesh = *shape.mesh;
    const std::size_t triangles_after = triangles_.size() + mesh.triangles.size();
    if (std::max(triangles_after, vertices_.size() + mesh.vertices.size()) >
        std::numeric_limits<SurfaceId>::max() / 2) {
        refuse(collider, "the scene's meshes have more than 2^31 triangles or vertices together");
    }
    const AffineMap placed = world_from_local(shape.placement);
    require_size(collider, placed, mesh.vertices);
    const AffineMap map = checked_map(collider, placed);
    const auto base = static_cast<std::uint32_t>(vertices_.size());
    add_range(number, Kind::mesh);
    vertices_.resize(vertices_.size() + mesh.vertices.size());
    bake_vertices(collider, mesh.vertices, map, std::span(vertices_).subspan(base));
    const std::size_t first = triangles_.size();
    const bool flip = map.mirrors();
    triangles_.resize(triangles_after);
    parallel_for_blocks(mesh.triangles.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Triangle& t = mesh.triangles[i];
            triangles_[first + i] = flip ? Triangle{base + t[0], base + t[2], base + t[1]}
                                         : Triangle{base + t[0], base + t[1], base + t[2]};
        }
    });
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

double CollisionWorld::mean_box() const {
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
    return sum / static_cast<double>(triangles_.size());
}

SurfaceId CollisionWorld::surface_of_triangle(std::uint32_t triangle) const {
    if (ranges_.size() == 1) return triangle;
    // Planes own no triangles. The owner is therefore the last range that starts at or before the triangle.
    auto after = std::upper_bound(ranges_.begin(), ranges_.end(), triangle,
                                  [](std::uint32_t t, const Range& range) { return t < range.first_triangle; });
    --after;
    return after->first_surface + (triangle - after->first_triangle);
}

CollisionWorld::Nearest CollisionWorld::nearest(SurfaceId surface, const Vec3& p) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.kind == Kind::plane) {
        const Plane& plane = planes_[range.index].plane;
        const double distance = signed_distance(p, plane);
        return {distance < 0.0 ? -plane.normal : plane.normal, std::fabs(distance), true};
    }
    if (range.kind == Kind::shape) {
        const ShapeSurface& shape = shapes_[range.index];
        const ShapePoint closest = shape.shape.closest_point_of(shape.part_of(surface), p);
        return {closest.distance < 0.0 ? -closest.normal : closest.normal, std::fabs(closest.distance),
                closest.part != ShapePart::side && !closest.on_rim, closest.on_rim};
    }
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return nearest(TrianglePlane(a, b, c), p);
}

CollisionWorld::Nearest CollisionWorld::nearest(const TrianglePlane& triangle, const Vec3& p) {
    const ClosestPointOnTriangle closest = closest_point_on_triangle(p, triangle.a(), triangle.b(), triangle.c());
    const double distance = length(closest.offset);
    if (closest.feature == TriangleFeature::kFace || is_over_rim(triangle, p, distance)) {
        const double height = triangle.signed_distance(p);
        const Vec3& normal = triangle.unit_normal();
        return {height < 0.0 ? -normal : normal, std::fabs(height), true};
    }
    return {distance > 0.0 ? closest.offset / distance : triangle.unit_normal(), distance, false, true};
}

SurfacePosition CollisionWorld::closest_point_on(SurfaceId surface, const Vec3& p) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.kind != Kind::mesh) {
        const Nearest to = nearest(surface, p);
        return {p - to.distance * to.normal, {}};
    }
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    const ClosestPointOnTriangle closest = closest_point_on_triangle(p, a, b, c);
    return {closest.point, barycentric_coordinates(closest, a, b, c)};
}

Vec3 CollisionWorld::unit_normal_of(SurfaceId surface, const Vec3& p) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.kind == Kind::plane) return planes_[range.index].plane.normal;
    if (range.kind == Kind::shape) {
        const ShapeSurface& shape = shapes_[range.index];
        return shape.shape.closest_point_beyond(shape.part_of(surface), p).normal;
    }
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return unit_normal(a, b, c);
}

double CollisionWorld::signed_distance_from(SurfaceId surface, const Vec3& p) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.kind == Kind::plane) return signed_distance(p, planes_[range.index].plane);
    if (range.kind == Kind::shape) {
        const ShapeSurface& shape = shapes_[range.index];
        return shape.shape.closest_point_beyond(shape.part_of(surface), p).distance;
    }
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return signed_distance(p, a, b, c);
}

double CollisionWorld::size_of(SurfaceId surface) const {
    // The diagonal of a ball's box is 3.5 of its radii. A long cylinder has the same curvature as a short one. Local: a
    // scale, not a tolerance.
    constexpr double kMostRadii = 4.0;
    const Range& range = ranges_[collider_of(surface)];
    if (range.kind != Kind::shape) return bounds_.diagonal();
    const AnalyticShape& shape = shapes_[range.index].shape;
    const double radius = std::fabs(shape.closest_point_of(ShapePart::side, shape.bounds().center()).distance);
    return std::min(shape.bounds().diagonal(), kMostRadii * radius);
}

int CollisionWorld::rim_of(SurfaceId surface, const Vec3& p) const {
    const AnalyticShape& shape = shapes_[ranges_[collider_of(surface)].index].shape;
    const auto height = [&](ShapePart cap) { return shape.closest_point_beyond(cap, p).distance; };
    return height(ShapePart::top) > height(ShapePart::bottom) ? 2 : 1;
}

int CollisionWorld::side_of_surface(SurfaceId surface, const Vec3& p) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.kind == Kind::plane) return side_of(planes_[range.index].plane, p);
    if (range.kind == Kind::shape) return shapes_[range.index].shape.side(p);
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return orient3d(a, b, c, p);
}

double CollisionWorld::time_over(SurfaceId surface, const Path& path, double slack) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.kind == Kind::plane) return path.duration;
    if (range.kind == Kind::shape) {
        const ShapeSurface& shape = shapes_[range.index];
        return shape.shape.time_over(shape.part_of(surface), path, slack);
    }
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return triangle_exit_time(path, a, b, c, unit_normal(a, b, c), slack);
}

bool CollisionWorld::segment_intersects(SurfaceId surface, const Vec3& p, const Vec3& q) const {
    const Range& range = ranges_[collider_of(surface)];
    if (range.kind == Kind::shape) return !shapes_[range.index].shape.segment_is_clear(p, q);
    if (range.kind == Kind::plane) {
        const Plane& plane = planes_[range.index].plane;
        return side_of(plane, p) * side_of(plane, q) <= 0;
    }
    const auto [a, b, c] = corners_of_triangle(range.first_triangle + (surface - range.first_surface));
    return segment_intersects_triangle(p, q, a, b, c);
}

std::size_t CollisionWorld::surface_count_of(std::size_t collider) const {
    return list_->first_surface_of(collider + 1) - list_->first_surface_of(collider);
}

std::optional<TriangleMesh> CollisionWorld::mesh_of(std::size_t collider) const {
    const Range& range = ranges_[collider];
    if (range.kind != Kind::mesh) return std::nullopt;
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

void CollisionWorld::add_pages_to(std::vector<std::span<const std::byte>>& pages) const {
    for (const auto list : {own_pages(vertices_), own_pages(triangles_), own_pages(degenerate_),
                            clusters_ ? own_pages(*clusters_) : std::span<const std::byte>()}) {
        if (!list.empty()) pages.push_back(list);
    }
}

std::size_t CollisionWorld::memory_bytes() const {
    const auto used_bytes = [](const auto& list) { return list.capacity() * sizeof(list[0]); };
    std::size_t bytes = distance_field_.memory_bytes() + used_bytes(ranges_) + used_bytes(planes_) +
                        used_bytes(vertices_) + used_bytes(triangles_) + used_bytes(degenerate_) + used_bytes(shapes_) +
                        list_->memory_bytes();
    if (clusters_) bytes += used_bytes(*clusters_);
    for (const RadiusClass& one : classes_) bytes += one.bvh.memory_bytes();
    return bytes;
}

}  // namespace ricochet
