#include "ricochet/collision/foreign_surfaces.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Factor on the rounding error of one conversion between frames. Reason: a position may be converted repeatedly before
/// it reaches a surface.
constexpr double kCarries = 8.0;

}  // namespace

double offset_for_carrying(const MovingPose& pose, const Vec3& image) {
    return kCarries * max_abs(pose.image(pose.point(image)) - image);
}

/// Computes the tolerance from the coordinates of the segment, not of the path. The path may end far away, and its
/// rounding there must not let a sphere sink in here.
bool ForeignSurfaces::is_free(const Deforming& triangle, const WayPoint& p, const WayPoint& q) const {
    const double tolerance = sphere_tolerance(triangle.radius, std::max(max_abs(p.world), max_abs(q.world)));
    const double radius = std::max(0.0, triangle.radius - tolerance);
    return deforming().is_free(triangle.surface, {p.world, time_of(p)}, {q.world, time_of(q)}, radius);
}

bool ForeignSurfaces::are_free(const WayPoint& p, const WayPoint& q) const {
    return std::all_of(bodies_.begin(), bodies_.end(),
                       [&](const Body& body) { return body.near.is_free(image(body, p), image(body, q)); }) &&
           std::all_of(deforming_.begin(), deforming_.end(),
                       [&](const Deforming& triangle) { return is_free(triangle, p, q); });
}

std::optional<SurfaceId> ForeignSurfaces::blocker(const WayPoint& p, const WayPoint& q) const {
    for (const Body& body : bodies_) {
        if (const auto surface = body.near.blocker(image(body, p), image(body, q))) return surface;
    }
    for (const Deforming& triangle : deforming_) {
        if (!is_free(triangle, p, q)) return triangle.surface;
    }
    return std::nullopt;
}

bool ForeignSurfaces::cover_chord(double from, double to) const {
    return std::all_of(bodies_.begin(), bodies_.end(),
                       [&](const Body& body) { return body.near.covers_chord(body.path, from, to); });
}

bool ForeignSurfaces::is_flat(SurfaceId surface) const {
    return deforms(surface) || world_of(surface).is_flat(surface);
}

CollisionWorld::Nearest ForeignSurfaces::nearest(SurfaceId surface, const WayPoint& p) const {
    if (deforms(surface)) {
        CollisionWorld::Nearest nearest = deforming().nearest(surface, p.world, time_of(p));
        nearest.normal = view_.direction_from(kAtRest, nearest.normal, p.time);
        return nearest;
    }
    CollisionWorld::Nearest nearest = world_of(surface).nearest(surface, image_in(surface, p));
    nearest.normal = view_.direction_from(view_.bodies().body_of(surface), nearest.normal, p.time);
    return nearest;
}

double ForeignSurfaces::signed_distance_from(SurfaceId surface, const WayPoint& p) const {
    if (deforms(surface)) return deforming().signed_distance_from(surface, p.world, time_of(p));
    return world_of(surface).signed_distance_from(surface, image_in(surface, p));
}

Vec3 ForeignSurfaces::unit_normal_of(SurfaceId surface, const WayPoint& p) const {
    if (deforms(surface)) {
        return view_.direction_from(kAtRest, deforming().unit_normal_of(surface, time_of(p)), p.time);
    }
    const Vec3 normal = world_of(surface).unit_normal_of(surface, image_in(surface, p));
    return view_.direction_from(view_.bodies().body_of(surface), normal, p.time);
}

int ForeignSurfaces::side_of_surface(SurfaceId surface, const WayPoint& p) const {
    if (deforms(surface)) return deforming().side_of_surface(surface, p.world, time_of(p));
    return world_of(surface).side_of_surface(surface, image_in(surface, p));
}

double ForeignSurfaces::offset_at(const WayPoint& p) const {
    double offset = contact_offset(p.world);
    for (const Body& body : bodies_) {
        offset = std::max(offset, contact_offset(image(body, p)));
        if (body.id == kAtRest) continue;
        const double time = view_.clock().at(p.time);
        const MovingPose pose = view_.bodies().pose(body.id, time);
        offset = std::max(offset, contact_offset(pose.world_from_frame.translation));
        if (view_.bodies().yields(body.id)) offset = std::max(offset, offset_for_carrying(pose, image(body, p)));
    }
    for (const Deforming& triangle : deforming_) offset = std::max(offset, deforming().offset_of(triangle.surface));
    return offset;
}

}  // namespace ricochet
