#include "ricochet/collision/foreign_surfaces.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {

bool ForeignSurfaces::are_free(const WayPoint& p, const WayPoint& q) const {
    return std::all_of(bodies_.begin(), bodies_.end(),
                       [&](const Body& body) { return body.near.is_free(image(body, p), image(body, q)); });
}

std::optional<SurfaceId> ForeignSurfaces::blocker(const WayPoint& p, const WayPoint& q) const {
    for (const Body& body : bodies_) {
        if (const auto surface = body.near.blocker(image(body, p), image(body, q))) return surface;
    }
    return std::nullopt;
}

bool ForeignSurfaces::cover_chord(double from, double to) const {
    return std::all_of(bodies_.begin(), bodies_.end(),
                       [&](const Body& body) { return body.near.covers_chord(body.path, from, to); });
}

CollisionWorld::Nearest ForeignSurfaces::nearest(SurfaceId surface, const WayPoint& p) const {
    CollisionWorld::Nearest nearest = world_of(surface).nearest(surface, image_in(surface, p));
    nearest.normal = view_.direction_from(view_.bodies().body_of(surface), nearest.normal, p.time);
    return nearest;
}

double ForeignSurfaces::signed_distance_from(SurfaceId surface, const WayPoint& p) const {
    return world_of(surface).signed_distance_from(surface, image_in(surface, p));
}

Vec3 ForeignSurfaces::unit_normal_of(SurfaceId surface, const WayPoint& p) const {
    const Vec3 normal = world_of(surface).unit_normal_of(surface, image_in(surface, p));
    return view_.direction_from(view_.bodies().body_of(surface), normal, p.time);
}

int ForeignSurfaces::side_of_surface(SurfaceId surface, const WayPoint& p) const {
    return world_of(surface).side_of_surface(surface, image_in(surface, p));
}

double ForeignSurfaces::offset_at(const WayPoint& p) const {
    double offset = contact_offset(p.world);
    for (const Body& body : bodies_) {
        offset = std::max(offset, contact_offset(image(body, p)));
        if (body.id == kAtRest) continue;
        const double time = view_.clock().at(p.time);
        offset = std::max(offset, contact_offset(view_.bodies().pose(body.id, time).world_from_frame.translation));
    }
    return offset;
}

}  // namespace ricochet
