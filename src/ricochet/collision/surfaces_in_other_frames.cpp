#include "ricochet/collision/surfaces_in_other_frames.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {

double offset_for_carrying(const MovingPose& pose, const Vec3& local_position) {
    return kCarryingOffsets * max_abs(pose.local_position(pose.point(local_position)) - local_position);
}

/// Computes the tolerance from the coordinates of the segment, not of the path. The path may end far away, and its
/// rounding there must not let a sphere sink in here.
bool SurfacesInOtherFrames::is_free(const Deforming& triangle, const PathPoint& p, const PathPoint& q) const {
    const double tolerance = sphere_tolerance(triangle.radius, std::max(max_abs(p.world), max_abs(q.world)));
    const double radius = std::max(0.0, triangle.radius - tolerance);
    return deforming().is_free(triangle.surface, {p.world, time_of(p)}, {q.world, time_of(q)}, radius);
}

bool SurfacesInOtherFrames::are_free(const PathPoint& p, const PathPoint& q) const {
    return std::all_of(
               bodies_.begin(), bodies_.end(),
               [&](const Body& body) { return body.near.is_free(local_position(body, p), local_position(body, q)); }) &&
           std::all_of(deforming_.begin(), deforming_.end(),
                       [&](const Deforming& triangle) { return is_free(triangle, p, q); });
}

std::optional<SurfaceId> SurfacesInOtherFrames::blocker(const PathPoint& p, const PathPoint& q) const {
    for (const Body& body : bodies_) {
        if (const auto surface = body.near.blocker(local_position(body, p), local_position(body, q))) return surface;
    }
    for (const Deforming& triangle : deforming_) {
        if (!is_free(triangle, p, q)) return triangle.surface;
    }
    return std::nullopt;
}

/// Considers only rigid bodies. For deforming triangles see DeformingSweep::certified_radius().
std::optional<SurfaceId> SurfacesInOtherFrames::overlap_deepened_by(const PathPoint& p, const PathPoint& q) const {
    for (const Body& body : bodies_) {
        const auto surface = body.near.deepened_overlap(local_position(body, p), local_position(body, q));
        if (surface) return surface;
    }
    return std::nullopt;
}

bool SurfacesInOtherFrames::cover_chord(double from, double to) const {
    return std::all_of(bodies_.begin(), bodies_.end(),
                       [&](const Body& body) { return body.near.covers_chord(body.path, from, to); });
}

bool SurfacesInOtherFrames::is_flat(SurfaceId surface) const {
    return deforms(surface) || world_of(surface).is_flat(surface);
}

CollisionWorld::Nearest SurfacesInOtherFrames::nearest(SurfaceId surface, const PathPoint& p) const {
    if (deforms(surface)) {
        CollisionWorld::Nearest nearest = deforming().nearest(surface, p.world, time_of(p));
        nearest.normal = view_.direction_from(kWorldBody, nearest.normal, p.time);
        return nearest;
    }
    CollisionWorld::Nearest nearest = world_of(surface).nearest(surface, local_position_in(surface, p));
    nearest.normal = view_.direction_from(view_.bodies().body_of(surface), nearest.normal, p.time);
    return nearest;
}

double SurfacesInOtherFrames::signed_distance_from(SurfaceId surface, const PathPoint& p) const {
    if (deforms(surface)) return deforming().signed_distance_from(surface, p.world, time_of(p));
    return world_of(surface).signed_distance_from(surface, local_position_in(surface, p));
}

Vec3 SurfacesInOtherFrames::unit_normal_of(SurfaceId surface, const PathPoint& p) const {
    if (deforms(surface)) {
        return view_.direction_from(kWorldBody, deforming().unit_normal_of(surface, time_of(p)), p.time);
    }
    const Vec3 normal = world_of(surface).unit_normal_of(surface, local_position_in(surface, p));
    return view_.direction_from(view_.bodies().body_of(surface), normal, p.time);
}

int SurfacesInOtherFrames::side_of_surface(SurfaceId surface, const PathPoint& p) const {
    if (deforms(surface)) return deforming().side_of_surface(surface, p.world, time_of(p));
    return world_of(surface).side_of_surface(surface, local_position_in(surface, p));
}

double SurfacesInOtherFrames::offset_at(const PathPoint& p) const {
    double offset = contact_offset(p.world);
    for (const Body& body : bodies_) {
        offset = std::max(offset, contact_offset(local_position(body, p)));
        if (body.id == kWorldBody) continue;
        const double time = view_.clock().at(p.time);
        const MovingPose pose = view_.bodies().pose(body.id, time);
        offset = std::max(offset, contact_offset(pose.world_from_frame.translation));
        if (view_.bodies().is_dynamic(body.id))
            offset = std::max(offset, offset_for_carrying(pose, local_position(body, p)));
    }
    for (const Deforming& triangle : deforming_) offset = std::max(offset, deforming().offset_of(triangle.surface));
    return offset;
}

}  // namespace ricochet
