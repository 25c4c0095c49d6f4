#include "ricochet/collision/obstacles.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Tests a segment in the frames of rigid colliders, moving and at rest.
bool is_free_of_rigid(const MovingColliders& bodies, const StoredPosition& from, const StoredPosition& to,
                      double radius) {
    const auto is_free_in = [&](BodyId body) {
        const CollisionWorld& world = bodies.world(body);
        if (world.empty()) return true;
        const Obstacles obstacles(world, bodies.local_position(body, from.position, from.time), radius);
        return !obstacles.block(bodies.local_position(body, to.position, to.time));
    };
    for (BodyId body = 0; body < bodies.size(); ++body) {
        if (!is_free_in(body)) return false;
    }
    return is_free_in(kWorldBody);
}

}  // namespace

bool Obstacles::blocks(SurfaceId surface, const Vec3& to) const {
    if (world_.segment_intersects(surface, from_, to)) return true;
    if (radius_ == 0.0) return false;
    const double tolerance = kUsedSphereTolerance * sphere_tolerance(radius_, std::max(max_abs(from_), max_abs(to)));
    const double distance = world_.nearest(surface, to).distance;
    if (distance >= radius_ - tolerance) return false;
    return distance < kNearerStill * world_.nearest(surface, from_).distance;
}

/// Calls found(surface) for every blocking surface, in unspecified order, until it returns false.
template <class Found>
void Obstacles::for_each_blocker(const Vec3& to, Found&& found) const {
    for (const auto& plane : world_.planes()) {
        if (blocks(plane.surface, to) && !found(plane.surface)) return;
    }
    for (const auto& shape : world_.shapes()) {
        const SurfaceId surface = shape.nearest_to(to);
        if (blocks(surface, to) && !found(surface)) return;
    }
    if (world_.triangles().empty()) return;
    bvh_.query_segment(from_, to, [&](std::uint32_t triangle) {
        if (world_.is_degenerate(triangle)) return 1.0;
        const SurfaceId surface = world_.surface_of_triangle(triangle);
        return blocks(surface, to) && !found(surface) ? 0.0 : 1.0;
    });
}

bool Obstacles::block(const Vec3& to) const {
    bool any = false;
    for_each_blocker(to, [&](SurfaceId) {
        any = true;
        return false;
    });
    return any;
}

ContactSurface Obstacles::contact_at(SurfaceId surface, const Vec3& p, const Vec3& v) const {
    if (radius_ > 0.0) {
        const CollisionWorld::Nearest nearest = world_.nearest(surface, p);
        return {surface, nearest.normal, nearest.flat};
    }
    const double distance = world_.signed_distance_from(surface, p);
    const int side = distance > 0.0 ? 1 : distance < 0.0 ? -1 : world_.side_of_surface(surface, p);
    return {surface, facing_normal(world_.unit_normal_of(surface, p), side, v), world_.is_flat(surface)};
}

void Obstacles::gather(const Vec3& to, const Vec3& p, const Vec3& v, std::vector<ContactSurface>& out) const {
    out.clear();
    for_each_blocker(to, [&](SurfaceId surface) {
        out.push_back(contact_at(surface, p, v));
        return true;
    });
    drop_seams(out);
    std::ranges::sort(out, [](const auto& a, const auto& b) { return a.surface < b.surface; });
    out.erase(std::unique(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.surface == b.surface; }),
              out.end());
}

bool is_segment_free(const MovingColliders& bodies, const StoredPosition& from, const StoredPosition& to,
                     double radius) {
    return is_free_of_rigid(bodies, from, to, radius) && bodies.deforming().is_segment_free(from, to, radius);
}

bool is_late_segment_free(const MovingColliders& bodies, const StoredPosition& from, const StoredPosition& to,
                          double radius) {
    return is_free_of_rigid(bodies, from, to, radius) && bodies.deforming().is_late_segment_free(from, to, radius);
}

}  // namespace ricochet
