#include "ricochet/collision/obstacles.h"

#include <algorithm>
#include <cmath>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

bool same_normal(const Vec3& a, const Vec3& b) { return length_squared(a - b) < 2.0 * kSeamTurn; }

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
    return {surface, facing_normal(world_, surface, side, p, v), world_.is_flat(surface)};
}

void Obstacles::gather(const Vec3& to, const Vec3& p, const Vec3& v, std::vector<ContactSurface>& out) const {
    out.clear();
    for_each_blocker(to, [&](SurfaceId surface) {
        out.push_back(contact_at(surface, p, v));
        return true;
    });
    std::sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.surface < b.surface; });
    out.erase(std::unique(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.surface == b.surface; }),
              out.end());
    const std::vector<ContactSurface>& all = out;
    const auto is_seam = [&](const ContactSurface& edge) {
        return !edge.flat && std::any_of(all.begin(), all.end(), [&](const ContactSurface& face) {
            return face.flat && same_normal(face.normal, edge.normal);
        });
    };
    // A separate list is needed: erasing in place would compare with elements that have already moved.
    std::vector<ContactSurface> kept;
    for (const ContactSurface& surface : all) {
        if (!is_seam(surface)) kept.push_back(surface);
    }
    out.swap(kept);
}

}  // namespace ricochet
