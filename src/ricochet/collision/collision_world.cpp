#include "ricochet/collision/collision_world.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

constexpr std::size_t kTrianglesInBlock = 1 << 14;

/// Returns the mean diagonal of the boxes of all triangles, in m.
double mean_box(const PlacedColliders& world) {
    const auto triangles = world.triangles();
    const auto vertices = world.vertices();
    if (triangles.empty()) return 0.0;
    const double sum = ordered_sum(triangles.size(), kTrianglesInBlock, [&](std::size_t begin, std::size_t end) {
        double partial = 0.0;
        for (std::size_t t = begin; t < end; ++t) {
            Box3 box;
            for (const std::uint32_t v : triangles[t]) box.include(vertices[v]);
            partial += box.diagonal();
        }
        return partial;
    });
    return sum / static_cast<double>(triangles.size());
}

/// Returns true if p is above the triangle's face and the distances from its rim and its face differ by rounding only.
/// A rolling sphere then changes from face to rim exactly at the rim, and not too early by 1e-8 of its radius.
bool is_over_rim(const TrianglePlane& triangle, const Vec3& p, double distance_from_rim) {
    const double height = std::fabs(triangle.signed_distance(p));
    if (height < (1.0 - kRimTie) * distance_from_rim || height == 0.0) return false;
    return projects_into_triangle(p, triangle.a(), triangle.b(), triangle.c(), triangle.unit_normal());
}

PageVector<Vec3> unit_normals_of(const PlacedColliders& colliders) {
    PageVector<Vec3> normals(colliders.triangles().size());
    parallel_for_blocks(normals.size(), std::size_t{1} << 12, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            const auto triangle = static_cast<std::uint32_t>(t);
            if (colliders.is_degenerate(triangle)) continue;
            const auto [a, b, c] = colliders.corners_of_triangle(triangle);
            normals[t] = unit_normal(a, b, c);
        }
    });
    return normals;
}

}  // namespace

CollisionWorld::CollisionWorld(std::vector<ColliderDescription> colliders, double chord_margin)
    : CollisionWorld(std::make_shared<ColliderList>(std::move(colliders)), {}, chord_margin) {}

CollisionWorld::CollisionWorld(std::shared_ptr<ColliderList> colliders, std::string_view frame, double chord_margin)
    : PlacedColliders(std::move(colliders), frame) {
    const double extent = triangles().empty() ? 0.0 : triangle_bounds().diagonal();
    chord_margin_ = std::max(chord_margin * mean_box(*this), kLeastChordMargin * extent);
    prepare_radius(0.0);
    distance_field_ = DistanceField(vertices(), triangles(), triangle_bounds());
    unit_normals_ = unit_normals_of(*this);
}

// Boxes of a class are enlarged by its largest radius and the chord margin. Small radii share the class of points.
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
        clusters_ = std::make_shared<const TriangleClusters>(make_clusters(vertices(), triangles()));
    }
    classes_.insert(at, RadiusClass{largest, TriangleBvh(clusters_, box_margin)});
}

const TriangleBvh& CollisionWorld::bvh_for(double radius) const {
    for (const RadiusClass& c : classes_) {
        if (radius <= c.largest_radius) return c.bvh;
    }
    throw RunError("a particle is larger than any radius class that was prepared");
}

CollisionWorld::Nearest CollisionWorld::nearest(SurfaceId surface, const Vec3& p) const {
    const Range& range = range_of(surface);
    if (range.kind == Kind::plane) {
        const Plane& plane = planes()[range.index].plane;
        const double distance = signed_distance(p, plane);
        return {distance < 0.0 ? -plane.normal : plane.normal, std::fabs(distance), true};
    }
    if (range.kind == Kind::shape) {
        const ShapeSurface& shape = shapes()[range.index];
        const ShapePoint closest = shape.shape.closest_point_of(shape.part_of(surface), p);
        return {closest.distance < 0.0 ? -closest.normal : closest.normal, std::fabs(closest.distance),
                closest.part != ShapePart::side && !closest.on_rim, closest.on_rim};
    }
    return nearest(plane_of_triangle(triangle_in(range, surface)), p);
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
    const Range& range = range_of(surface);
    if (range.kind != Kind::mesh) {
        const Nearest to = nearest(surface, p);
        return {p - to.distance * to.normal, {}};
    }
    const auto [a, b, c] = corners_in(range, surface);
    const ClosestPointOnTriangle closest = closest_point_on_triangle(p, a, b, c);
    return {closest.point, barycentric_coordinates(closest, a, b, c)};
}

Vec3 CollisionWorld::unit_normal_of(SurfaceId surface, const Vec3& p) const {
    const Range& range = range_of(surface);
    if (range.kind == Kind::plane) return planes()[range.index].plane.normal;
    if (range.kind == Kind::shape) {
        const ShapeSurface& shape = shapes()[range.index];
        return shape.shape.closest_point_beyond(shape.part_of(surface), p).normal;
    }
    return unit_normals_[triangle_in(range, surface)];
}

double CollisionWorld::signed_distance_from(SurfaceId surface, const Vec3& p) const {
    const Range& range = range_of(surface);
    if (range.kind == Kind::plane) return signed_distance(p, planes()[range.index].plane);
    if (range.kind == Kind::shape) {
        const ShapeSurface& shape = shapes()[range.index];
        return shape.shape.closest_point_beyond(shape.part_of(surface), p).distance;
    }
    const auto [a, b, c] = corners_in(range, surface);
    return signed_distance(p, a, b, c);
}

double CollisionWorld::size_of(SurfaceId surface) const {
    // The diagonal of a ball's box is 3.5 radii. A long cylinder is curved like a short one. Local: a scale.
    constexpr double kMostRadii = 4.0;
    const Range& range = range_of(surface);
    if (range.kind != Kind::shape) return bounds().diagonal();
    const AnalyticShape& shape = shapes()[range.index].shape;
    const double radius = std::fabs(shape.closest_point_of(ShapePart::side, shape.bounds().center()).distance);
    return std::min(shape.bounds().diagonal(), kMostRadii * radius);
}

int CollisionWorld::rim_of(SurfaceId surface, const Vec3& p) const {
    const AnalyticShape& shape = shapes()[range_of(surface).index].shape;
    const auto height = [&](ShapePart cap) { return shape.closest_point_beyond(cap, p).distance; };
    return height(ShapePart::top) > height(ShapePart::bottom) ? 2 : 1;
}

int CollisionWorld::side_of_surface(SurfaceId surface, const Vec3& p) const {
    const Range& range = range_of(surface);
    if (range.kind == Kind::plane) return side_of(planes()[range.index].plane, p);
    if (range.kind == Kind::shape) return shapes()[range.index].shape.side(p);
    const auto [a, b, c] = corners_in(range, surface);
    return orient3d(a, b, c, p);
}

double CollisionWorld::time_over(SurfaceId surface, const Path& path, double slack) const {
    const Range& range = range_of(surface);
    if (range.kind == Kind::plane) return path.duration;
    if (range.kind == Kind::shape) {
        const ShapeSurface& shape = shapes()[range.index];
        return shape.shape.time_over(shape.part_of(surface), path, slack);
    }
    const auto [a, b, c] = corners_in(range, surface);
    return triangle_exit_time(path, a, b, c, unit_normals_[triangle_in(range, surface)], slack);
}

bool CollisionWorld::segment_intersects(SurfaceId surface, const Vec3& p, const Vec3& q) const {
    const Range& range = range_of(surface);
    if (range.kind == Kind::shape) return !shapes()[range.index].shape.segment_is_clear(p, q);
    if (range.kind == Kind::plane) {
        const Plane& plane = planes()[range.index].plane;
        return side_of(plane, p) * side_of(plane, q) <= 0;
    }
    const auto [a, b, c] = corners_in(range, surface);
    return segment_intersects_triangle(p, q, a, b, c);
}

void CollisionWorld::add_pages_to(std::vector<std::span<const std::byte>>& pages) const {
    add_array_pages_to(pages);
    const auto add = [&](std::span<const std::byte> list) {
        if (!list.empty()) pages.push_back(list);
    };
    if (clusters_) add(own_pages(*clusters_));
    add(own_pages(unit_normals_));
}

std::size_t CollisionWorld::memory_bytes() const {
    std::size_t bytes = distance_field_.memory_bytes() + array_bytes();
    bytes += unit_normals_.capacity() * sizeof(Vec3);
    if (clusters_) bytes += clusters_->capacity() * sizeof((*clusters_)[0]);
    for (const RadiusClass& one : classes_) bytes += one.bvh.memory_bytes();
    return bytes;
}

}  // namespace ricochet
