#include "ricochet/collision/clear_path.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/collision/narrow_phase.h"

namespace ricochet {

namespace {

/// Bounds of the rounding of a distance from a triangle, relative to the distance and to the distance of the farthest
/// corner. The error of closest_point_on_triangle() is about 2^-50 of the latter. Local: error bounds of this
/// arithmetic.
constexpr double kDistanceRounding = 0x1p-40;
constexpr double kCornerRounding = 0x1p-46;

/// Part of the gap to the nearest known triangle within which a search goes on. More: larger balls. Less: fewer
/// triangles are tested. Local, because only the cost depends on it.
constexpr double kSearchedPart = 0.8;

/// Returns a lower bound, in m^2, on the squared distance of a point from a triangle: the distance from its box.
double squared_distance_from_box(const Vec3& p, const CollisionWorld::Corners& triangle) {
    const auto& [a, b, c] = triangle;
    const Vec3 outside = max(max(min(a, min(b, c)) - p, p - max(a, max(b, c))), Vec3{});
    return length_squared(outside);
}

/// Returns a lower bound, in m, on the distance of a point from a triangle.
double distance_bound(const Vec3& p, const CollisionWorld::Corners& triangle) {
    const auto& [a, b, c] = triangle;
    const double distance = std::sqrt(closest_point_on_triangle(p, a, b, c).distance_squared);
    const double farthest = std::max({max_abs(a - p), max_abs(b - p), max_abs(c - p)});
    return (1.0 - kDistanceRounding) * distance - kCornerRounding * farthest;
}

}  // namespace

ClearBall find_clear_ball(const CollisionWorld& world, const Vec3& center, double radius, double within) {
    double free = radius + kSearchedPart * within;
    world.bvh_for(0.0).query_point(center, free, [&](std::uint32_t triangle) {
        const CollisionWorld::Corners corners = world.corners_of_triangle(triangle);
        if (squared_distance_from_box(center, corners) >= free * free) return free;
        const double distance = distance_bound(center, corners);
        const double beside = radius + kSearchedPart * (distance - radius);
        free = std::max(0.0, std::min({free, distance, beside}));
        return free;
    });
    return {center, (1.0 - kDistanceRounding) * free};
}

double room_beside_triangles(const CollisionWorld& world, const Vec3& center, double radius, const ClearBall& clear) {
    if (world.triangles().empty()) return std::numeric_limits<double>::infinity();
    const double bound = std::max(world.distance_field().lower_bound(center), clear.bound_at(center));
    return bound - radius - query_slack(max_abs(center), radius);
}

bool is_path_clear(const CollisionWorld& world, const Path& path, double radius, double room) {
    const Vec3& start = path.c[0];
    double reach = length(path.end - start);
    for (const Vec3& control : path.control_points()) reach = std::max(reach, length(control - start));
    const double slack = query_slack(largest_coordinate(path), radius);
    if (!(reach + slack < room)) return false;
    const double margin = radius + slack;
    return std::all_of(world.planes().begin(), world.planes().end(),
                       [&](const auto& plane) { return stays_on_one_side(path, plane.plane, margin); }) &&
           std::all_of(world.shapes().begin(), world.shapes().end(),
                       [&](const auto& shape) { return shape.shape.can_cull(path, margin); });
}

}  // namespace ricochet
