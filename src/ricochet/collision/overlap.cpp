#include "ricochet/collision/overlap.h"

#include <cmath>

#include "ricochet/core/tolerances.h"

namespace ricochet {

std::optional<Overlap> deepest_overlap(const CollisionWorld& world, const Vec3& center, double radius) {
    if (!(radius > 0.0) || !is_finite(center)) return std::nullopt;
    const double least = radius - sphere_tolerance(radius, max_abs(center));
    std::optional<Overlap> deepest;
    const auto consider = [&](SurfaceId surface, double distance) {
        if (!(distance < least)) return;
        if (deepest && (distance > deepest->distance || (distance == deepest->distance && surface >= deepest->surface)))
            return;
        deepest = Overlap{surface, distance};
    };
    for (const auto& plane : world.planes()) {
        consider(plane.surface, std::fabs(signed_distance(center, plane.plane)));
    }
    for (const auto& shape : world.shapes()) {
        consider(shape.surface, std::fabs(shape.shape.closest_point(center).distance));
    }
    if (world.triangles().empty()) return deepest;
    world.bvh_for(0.0).query_point(center, deepest ? deepest->distance : radius, [&](std::uint32_t triangle) {
        if (!world.is_degenerate(triangle)) {
            const auto [a, b, c] = world.corners_of_triangle(triangle);
            const double squared = closest_point_on_triangle(center, a, b, c).distance_squared;
            consider(world.surface_of_triangle(triangle), std::sqrt(squared));
        }
        return deepest ? deepest->distance : radius;
    });
    return deepest;
}

double core_radius(const Overlap& overlap, const Vec3& center, double radius) {
    const double core = overlap.distance - contact_offset(center);
    return core < kSmallestCore * radius ? 0.0 : core;
}

}  // namespace ricochet
