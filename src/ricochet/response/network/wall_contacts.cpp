#include "ricochet/response/network/wall_contacts.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// A surface that is near.
struct Near {
    SurfaceId surface;
    CollisionWorld::Nearest nearest;
};

/// Calls visit(surface) for all whose distance from a point is at most `within`, and perhaps others.
template <class Visit>
void visit_near(const CollisionWorld& world, const Vec3& p, double within, const Visit& visit) {
    for (const CollisionWorld::PlaneSurface& plane : world.planes()) visit(plane.surface);
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

}  // namespace

void find_wall_contacts(const SurfaceGeometry& geometry, const Vec3& center, double radius, double reach,
                        std::vector<WallContact>& found) {
    std::vector<Near> near;
    const double within = radius + reach;
    visit_near(geometry.world(), center, within, [&](SurfaceId surface) {
        const CollisionWorld::Nearest nearest = geometry.nearest(surface, center);
        if (nearest.distance <= within) near.push_back({surface, nearest});
    });
    std::sort(near.begin(), near.end(), [](const Near& a, const Near& b) { return a.surface < b.surface; });
    const double same = kSameDirection * radius + 2.0 * geometry.contact_offset(center);
    for (std::size_t i = 0; i < near.size(); ++i) {
        const CollisionWorld::Nearest& nearest = near[i].nearest;
        const Vec3 foot = center - nearest.distance * nearest.normal;
        bool is_smallest = true;
        for (std::size_t k = 0; k < near.size() && is_smallest; ++k) {
            if (k == i) continue;
            const double difference = nearest.distance - near[k].nearest.distance;
            const bool comes_first = difference > same || (difference >= -same && k < i);
            if (!comes_first) continue;
            is_smallest = geometry.nearest(near[k].surface, foot).distance > same;
        }
        if (is_smallest) found.push_back({near[i].surface, nearest.normal, nearest.distance - radius});
    }
}

}  // namespace ricochet
