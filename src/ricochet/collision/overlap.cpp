#include "ricochet/collision/overlap.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Calls consider(surface, distance) for all planes and shapes, and for triangles up to `within`, m, which it returns
/// anew.
template <class Consider>
void visit_distances(const CollisionWorld& world, const Vec3& center, double within, const Consider& consider) {
    for (const auto& plane : world.planes()) {
        within = consider(plane.surface, std::fabs(signed_distance(center, plane.plane)));
    }
    for (const auto& shape : world.shapes()) {
        within = consider(shape.nearest_to(center), std::fabs(shape.shape.closest_point(center).distance));
    }
    if (world.triangles().empty()) return;
    world.bvh_for(0.0).query_point(center, within, [&](std::uint32_t triangle) {
        if (world.is_degenerate(triangle)) return within;
        const auto [a, b, c] = world.corners_of_triangle(triangle);
        const double squared = closest_point_on_triangle(center, a, b, c).distance_squared;
        within = consider(world.surface_of_triangle(triangle), std::sqrt(squared));
        return within;
    });
}

/// Returns the triangles of deforming meshes that come within a distance of a point in this step.
std::vector<SurfaceId> near_deforming(const MovingColliders& bodies, const Vec3& center, double within) {
    std::vector<SurfaceId> near;
    bodies.deforming().near(ball_box(center, within), near);
    return near;
}

}  // namespace

std::vector<BodyId> bodies_near(const MovingColliders& bodies, const Vec3& center, double radius, double time) {
    const double reach =
        radius + kBirthReach * (max_abs(center) + radius) + 2.0 * kTouchingOffsets * contact_offset(center);
    std::vector<BodyId> near;
    bodies.near_at(ball_box(center, reach), time, near);
    return near;
}

std::optional<Overlap> deepest_overlap(const CollisionWorld& world, const Vec3& center, double radius) {
    if (!(radius > 0.0) || !is_finite(center)) return std::nullopt;
    const double least = radius - sphere_tolerance(radius, max_abs(center));
    std::optional<Overlap> deepest;
    visit_distances(world, center, radius, [&](SurfaceId surface, double distance) {
        const bool is_nearer =
            !deepest || distance < deepest->distance || (distance == deepest->distance && surface < deepest->surface);
        if (distance < least && is_nearer) deepest = Overlap{surface, distance};
        return deepest ? deepest->distance : radius;
    });
    return deepest;
}

std::optional<Overlap> deepest_overlap(const MovingColliders& bodies, const Vec3& center, double radius, double time) {
    std::optional<Overlap> deepest = deepest_overlap(bodies.world(kWorldBody), center, radius);
    if (bodies.empty() || !(radius > 0.0) || !is_finite(center)) return deepest;
    for (const BodyId body : bodies_near(bodies, center, radius, time)) {
        const auto overlap = deepest_overlap(bodies.world(body), bodies.local_position(body, center, time), radius);
        if (overlap && (!deepest || overlap->distance < deepest->distance)) deepest = overlap;
    }
    const double least = radius - sphere_tolerance(radius, max_abs(center));
    for (const SurfaceId surface : near_deforming(bodies, center, radius)) {
        const double distance = bodies.deforming().triangle_at(surface, time).nearest(center).distance;
        if (distance < least && (!deepest || distance < deepest->distance)) deepest = Overlap{surface, distance};
    }
    return deepest;
}

std::optional<Vec3> off_bodies(const MovingColliders& bodies, const Vec3& center, double time) {
    std::optional<Vec3> off;
    for (const BodyId body : bodies_near(bodies, center, 0.0, time)) {
        const MovingPose pose = bodies.pose(body, time);
        const CollisionWorld& world = bodies.world(body);
        const Vec3 position = off.value_or(center);
        const Vec3 local_position = pose.local_position(position);
        const double offset =
            contact_offset(abs(position) + abs(pose.world_from_frame.translation) + abs(local_position));
        std::vector<SurfaceId> under;
        visit_distances(world, local_position, offset, [&](SurfaceId surface, double /*distance*/) {
            if (world.point_on(surface, local_position)) under.push_back(surface);
            return offset;
        });
        std::ranges::sort(under);
        Vec3 normal;
        for (const SurfaceId surface : under) normal += world.unit_normal_of(surface, local_position);
        if (normal == Vec3{}) continue;
        off = flush_tiny(pose.point(local_position + kBirthOffsets * offset * normalized(normal)));
    }
    Vec3 normal;
    double offset = 0.0;
    const Vec3 position = off.value_or(center);
    for (const SurfaceId surface : near_deforming(bodies, position, 0.0)) {
        const DeformedTriangle triangle = bodies.deforming().triangle_at(surface, time);
        if (!point_on_triangle(position, triangle.a, triangle.b, triangle.c)) continue;
        normal += triangle.unit_normal();
        offset = std::max(offset, bodies.deforming().mesh_with(surface).offset());
    }
    if (normal != Vec3{}) off = flush_tiny(position + kBirthOffsets * offset * normalized(normal));
    return off;
}

std::vector<SurfaceId> surfaces_touched(const CollisionWorld& world, const Vec3& center, double radius, double reach) {
    std::vector<SurfaceId> touched;
    if (!is_finite(center)) return touched;
    visit_distances(world, center, radius + reach, [&](SurfaceId surface, double distance) {
        if (distance > 0.0 && std::fabs(distance - radius) <= reach) touched.push_back(surface);
        return radius + reach;
    });
    std::ranges::sort(touched);
    return touched;
}

double core_radius(const Overlap& overlap, const Vec3& center, double radius) {
    const double core = overlap.distance - contact_offset(center);
    return core < kSmallestCore * radius ? 0.0 : core;
}

}  // namespace ricochet
