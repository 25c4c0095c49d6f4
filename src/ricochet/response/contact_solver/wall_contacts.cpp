#include "ricochet/response/contact_solver/wall_contacts.h"

#include <algorithm>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/point_sweep.h"

namespace ricochet {
namespace {

struct Near {
    SurfaceId surface;
    CollisionWorld::Nearest nearest;
};

/// Calls visit(surface) for all surfaces within a distance of a point, in m, and possibly for others.
template <class Visit>
void visit_near(const CollisionWorld& world, const Vec3& p, double within, const Visit& visit) {
    for (const CollisionWorld::PlaneSurface& plane : world.planes()) {
        if (!is_farther_than(plane.plane, p, within)) visit(plane.surface);
    }
    for (const CollisionWorld::ShapeSurface& shape : world.shapes()) {
        for (SurfaceId part = 0; part < shape.shape.part_count(); ++part) visit(shape.surface + part);
    }
    const auto visit_triangle = [&](std::uint32_t triangle) {
        if (!world.is_degenerate(triangle)) visit(world.surface_of_triangle(triangle));
        return within;
    };
    if (world.culls()) {
        world.bvh_for(0.0).query_point(p, within, visit_triangle);
    } else {
        for (std::uint32_t triangle = 0; triangle < world.triangles().size(); ++triangle) visit_triangle(triangle);
    }
}

/// Appends the near surfaces at which the distance from the sphere's centre has a local minimum. distance_to(surface,
/// p) returns a distance in m. Distances that differ by up to `same`, in m, count as equal.
template <class DistanceTo>
void keep_smallest(std::vector<Near>& near, const Vec3& center, double radius, double same,
                   const DistanceTo& distance_to, std::vector<WallContact>& found) {
    std::ranges::sort(near, [](const Near& a, const Near& b) { return a.surface < b.surface; });
    for (std::size_t i = 0; i < near.size(); ++i) {
        const CollisionWorld::Nearest& nearest = near[i].nearest;
        const Vec3 foot = center - nearest.distance * nearest.normal;
        bool is_smallest = true;
        for (std::size_t k = 0; k < near.size() && is_smallest; ++k) {
            if (k == i) continue;
            const double difference = nearest.distance - near[k].nearest.distance;
            const bool comes_first = difference > same || (difference >= -same && k < i);
            if (!comes_first) continue;
            is_smallest = distance_to(near[k].surface, foot) > same;
        }
        if (is_smallest) found.push_back({near[i].surface, nearest.normal, nearest.distance - radius});
    }
}

/// Finds the contacts with a body in its own coordinates, and sets the velocities of its surfaces in the world.
void find_on_body(const MovingColliders& bodies, BodyId body, const TimeOfStep& step, const Vec3& center, double radius,
                  double reach, std::vector<WallContact>& found) {
    const CollisionWorld& world = bodies.world(body);
    if (world.empty()) return;
    TrianglePlaneCache planes;
    const std::size_t first = found.size();
    const MovingPose begin = bodies.pose(body, step.begin);
    const Vec3 local_position = begin.local_position(center);
    static_cast<void>(find_wall_contacts(SurfaceGeometry(world, planes, contact_offset(center)), local_position, radius,
                                         reach, found));
    if (found.size() == first || !(step.end > step.begin)) return;
    const MovingPose middle = bodies.pose(body, 0.5 * (step.begin + step.end));
    const MovingPose end = bodies.pose(body, step.end);
    for (std::size_t k = first; k < found.size(); ++k) {
        WallContact& contact = found[k];
        const Vec3 foot = local_position - (radius + contact.gap) * contact.normal;
        contact.carried = (end.point(foot) - begin.point(foot)) / (step.end - step.begin);
        contact.normal = middle.world_from_frame.direction(contact.normal);
    }
}

/// Finds the contacts with deforming meshes, which move with their triangles. Returns true if any may come near.
bool find_on_deforming(const DeformingColliders& deforming, const TimeOfStep& step, const Vec3& center, double radius,
                       double reach, std::vector<WallContact>& found) {
    const double within = radius + reach;
    std::vector<SurfaceId> surfaces;
    deforming.near(ball_box(center, within), surfaces);
    std::vector<Near> near;
    double offset = 0.0;
    for (const SurfaceId surface : surfaces) {
        const CollisionWorld::Nearest nearest = deforming.triangle_at(surface, step.begin).nearest(center);
        if (nearest.distance > within) continue;
        near.push_back({surface, nearest});
        offset = std::max(offset, deforming.mesh_with(surface).offset());
    }
    const std::size_t first = found.size();
    const double same = kSameDirection * radius + 2.0 * offset;
    keep_smallest(
        near, center, radius, same,
        [&](SurfaceId surface, const Vec3& p) {
            return deforming.triangle_at(surface, step.begin).nearest(p).distance;
        },
        found);
    for (std::size_t k = first; k < found.size() && step.end > step.begin; ++k) {
        WallContact& contact = found[k];
        const Vec3 foot = center - (radius + contact.gap) * contact.normal;
        const DeformedTriangle later = deforming.triangle_at(contact.surface, step.end);
        contact.carried =
            deforming.triangle_at(contact.surface, step.begin).displacement_of(foot, later) / (step.end - step.begin);
    }
    return !surfaces.empty();
}

}  // namespace

bool find_wall_contacts(const SurfaceGeometry& geometry, const Vec3& center, double radius, double reach,
                        std::vector<WallContact>& found) {
    std::vector<Near> near;
    const double within = radius + reach;
    visit_near(geometry.world(), center, within, [&](SurfaceId surface) {
        const CollisionWorld::Nearest nearest = geometry.nearest(surface, center);
        if (nearest.distance <= within) near.push_back({surface, nearest});
    });
    const double same = kSameDirection * radius + 2.0 * geometry.contact_offset(center);
    keep_smallest(
        near, center, radius, same,
        [&](SurfaceId surface, const Vec3& p) { return geometry.nearest(surface, p).distance; }, found);
    return !near.empty();
}

bool find_wall_contacts(const MovingColliders& bodies, const SurfaceGeometry& at_rest, const TimeOfStep& step,
                        const Vec3& center, double radius, double reach, std::vector<WallContact>& found) {
    std::vector<BodyId> near;
    bodies.near(ball_box(center, radius + reach), kWorldBody, near);
    for (const BodyId body : near) {
        if (!bodies.is_deforming(body)) find_on_body(bodies, body, step, center, radius, reach, found);
    }
    bool is_near = find_wall_contacts(at_rest, center, radius, reach, found);
    if (!bodies.deforming().empty()) {
        is_near = find_on_deforming(bodies.deforming(), step, center, radius, reach, found) || is_near;
    }
    return is_near || !near.empty();
}

}  // namespace ricochet
