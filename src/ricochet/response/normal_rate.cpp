#include "ricochet/response/normal_rate.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Step of the derivative of a shape's normal, as a fraction of its size. Local: its error is far below that of an arc.
constexpr double kCurvatureStep = 1e-4;

/// Smallest scale of that step for a sphere away from rims, as a fraction of the shape's size. Over shorter steps the
/// normals of a large shape differ only by rounding. Local: a step of a numerical derivative.
constexpr double kSmallestScale = 1e-3;

/// Returns the derivative of a shape's normal, in 1/s, by its normals along the motion. Sides extend beyond rims.
Vec3 shape_normal_rate(const SurfaceGeometry& geometry, double radius, SurfaceId surface,
                       const CollisionWorld::Nearest& nearest, const Vec3& position, const Vec3& velocity) {
    const double speed = length(velocity);
    if (speed == 0.0) return {};
    const double size = geometry.world().size_of(surface);
    double scale = size;
    if (radius > 0.0) scale = std::clamp(radius, nearest.rim ? 0.0 : kSmallestScale * size, size);
    const double step = kCurvatureStep * scale;
    const Vec3 heading = velocity / speed;
    // A tangent of a concave surface soon crosses to the other side, where the normal is reversed.
    const auto normal_at = [&](double distance) {
        const Vec3 beside = position + distance * heading;
        const Vec3 there =
            nearest.rim ? geometry.nearest(surface, beside).normal : geometry.unit_normal_of(surface, beside);
        return dot(there, nearest.normal) < 0.0 ? -there : there;
    };
    const Vec3 ahead = normal_at(step) - nearest.normal;
    const Vec3 behind = nearest.normal - normal_at(-step);
    // Next to a rim, one of the two positions lies beyond it, so only the other one is used.
    const double difference = length(ahead - behind);
    if (difference > 0.5 * std::max(length(ahead), length(behind))) {
        return (speed / step) * (length(ahead) < length(behind) ? ahead : behind);
    }
    return (speed / (2.0 * step)) * (ahead + behind);
}

/// Returns two unit vectors that span the directions along all surfaces with these normals. There must be at least one
/// normal. If two normals are not parallel, only one direction remains, and the second vector is zero.
std::array<Vec3, 2> directions_along(std::span<const Vec3> normals) {
    for (const Vec3& normal : normals) {
        const Vec3 line = cross(normals.front(), normal);
        if (length(line) > kSameDirection) return {normalized(line), Vec3{}};
    }
    return tangent_frame(normals.front());
}

}  // namespace

int touched_feature(const SurfaceGeometry& geometry, SurfaceId surface, const Vec3& position) {
    const CollisionWorld& world = geometry.world();
    if (!geometry.nearest(surface, position).rim) return 0;
    if (world.is_shape(surface)) return geometry.world().rim_of(surface, position);
    const Vec3 weights = world.closest_point_on(surface, position).barycentric;
    int feature = 0;
    for (int k = 0; k < 3; ++k) feature |= (weights[k] > 0.0 ? 1 : 0) << k;
    return feature;
}

Vec3 normal_rate(const SurfaceGeometry& geometry, double radius, SurfaceId surface,
                 const CollisionWorld::Nearest& nearest, const Vec3& position, const Vec3& velocity) {
    const CollisionWorld& world = geometry.world();
    if (nearest.flat || (nearest.rim && radius == 0.0)) return {};
    if (world.is_shape(surface)) return shape_normal_rate(geometry, radius, surface, nearest, position, velocity);
    Vec3 across = velocity - dot(velocity, nearest.normal) * nearest.normal;
    const auto triangle = world.triangle_of(surface);
    const int corners = touched_feature(geometry, surface, position);
    if (triangle && (corners == 3 || corners == 5 || corners == 6)) {
        const auto [a, b, c] = world.corners_of_triangle(*triangle);
        const Vec3 edge = normalized(corners == 3 ? b - a : (corners == 5 ? c - a : c - b));
        across -= dot(across, edge) * edge;
    }
    return nearest.distance > 0.0 ? across / nearest.distance : Vec3{};
}

double largest_curvature(const SurfaceGeometry& geometry, double radius, SurfaceId surface,
                         const CollisionWorld::Nearest& nearest, const Vec3& position, std::span<const Vec3> normals) {
    if (normals.empty()) return 0.0;
    const auto [along, across] = directions_along(normals);
    const Vec3 first = normal_rate(geometry, radius, surface, nearest, position, along);
    const Vec3 second = normal_rate(geometry, radius, surface, nearest, position, across);
    const double mean = 0.5 * (length_squared(first) + length_squared(second));
    const double half = 0.5 * (length_squared(first) - length_squared(second));
    const double mixed = dot(first, second);
    return std::sqrt(mean + std::sqrt(half * half + mixed * mixed));
}

}  // namespace ricochet
