#include "ricochet/collision/clear_space.h"

#include <algorithm>
#include <cmath>

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

/// Bound of the terms of a cubic path in a ball, in units of the room that it leaves, beside the coordinates of its
/// centre: the coefficients are differences of up to four control points, with the sum of weights 6 + 12 + 8. Local: an
/// error bound of this arithmetic.
constexpr double kTermsOfPath = 32.0;

/// Number of times that a ball is halved until a shape is certainly outside of it. Local, because only the cost depends
/// on it.
constexpr int kMostHalvings = 6;

/// Returns a lower bound, in m^2, on the squared distance of a point from a triangle: the distance from its box.
double squared_distance_from_box(const Vec3& p, const CollisionWorld::Corners& triangle) {
    const auto& [a, b, c] = triangle;
    const Vec3 outside = max(max(min(a, min(b, c)) - p, p - max(a, max(b, c))), Vec3{});
    return length_squared(outside);
}

/// Returns a lower bound, in m, on a distance that was computed from points up to `farthest` m away.
double lower_bound(double distance, double farthest) {
    return (1.0 - kDistanceRounding) * distance - kCornerRounding * farthest;
}

/// Returns a lower bound, in m, on the distance of a point from a triangle.
double distance_bound(const Vec3& p, const CollisionWorld::Corners& triangle) {
    const auto& [a, b, c] = triangle;
    const double distance = std::sqrt(closest_point_on_triangle(p, a, b, c).distance_squared);
    return lower_bound(distance, std::max({max_abs(a - p), max_abs(b - p), max_abs(c - p)}));
}

/// Returns the radius, in m, of a ball without triangles. `free`: its largest useful radius, in m.
double radius_without_triangles(const CollisionWorld& world, const Vec3& center, double radius, double free) {
    if (world.triangles().empty() || world.distance_field().lower_bound(center) >= free) return free;
    world.bvh_for(0.0).query_point(center, free, [&](std::uint32_t triangle) {
        const CollisionWorld::Corners corners = world.corners_of_triangle(triangle);
        if (squared_distance_from_box(center, corners) >= free * free) return free;
        const double distance = distance_bound(center, corners);
        const double beside = radius + kSearchedPart * (distance - radius);
        free = std::max(0.0, std::min({free, distance, beside}));
        return free;
    });
    return (1.0 - kDistanceRounding) * free;
}

/// Returns the part of the room around a particle, in m, that planes and shapes leave. margin: distance from the
/// centre, in m, beyond which the room begins.
double room_beside_planes_and_shapes(const CollisionWorld& world, const Vec3& center, double room, double margin) {
    for (const auto& [plane, surface] : world.planes()) {
        const double distance = std::fabs(signed_distance(center, plane));
        room = std::min(room, lower_bound(distance, max_abs(center - plane.point) + max_abs(center)) - margin);
    }
    const Path here = line_path(center, Vec3{}, 1.0);
    for (const auto& shape : world.shapes()) {
        for (int k = 0; room > 0.0 && !shape.shape.can_cull(here, room + margin); ++k) {
            room = k < kMostHalvings ? 0.5 * room : 0.0;
        }
    }
    return room;
}

}  // namespace

bool ClearSpace::contains(const Path& path, double time, double radius) const {
    const double h = path.duration;
    const double s = time - begin;
    const double width = reach - radius;
    // The end of a query's step and the start of the next one can differ by the rounding of the clock.
    const bool is_in_time = s >= -4.0 * ulp(time) && s + h <= end - begin;
    if (!(width > 0.0) || !is_in_time) return false;
    const Vec3 d0 = path.c[0] - (center + s * (velocity + s * half_acceleration));
    const Vec3 d1 = path.c[1] - (velocity + (2.0 * s) * half_acceleration);
    const Vec3 d2 = path.c[2] - half_acceleration;
    const Vec3 b1 = d0 + (h / 3.0) * d1;
    const Vec3 b2 = b1 + (h / 3.0) * (d1 + h * d2);
    const Vec3 b3 = d0 + h * (d1 + h * (d2 + h * path.c[3]));
    const auto is_within = [&](const Vec3& d) { return length_squared(d) < width * width; };  // false for NaN
    return is_within(d0) && is_within(b1) && is_within(b2) && is_within(b3);
}

ClearSpace find_clear_ball(const CollisionWorld& world, const Vec3& center, double radius, double within) {
    ClearSpace space{center};
    space.begin = 0.0;
    // A larger particle may use the ball later: the core of a sphere in overlap can grow.
    const double slack = query_slack(max_abs(center) + kTermsOfPath * within, radius + within);
    const double free = radius_without_triangles(world, center, radius, radius + kSearchedPart * within);
    const double room = room_beside_planes_and_shapes(world, center, free - radius - slack, radius + slack);
    if (room > 0.0) space.reach = radius + room;
    return space;
}

}  // namespace ricochet
