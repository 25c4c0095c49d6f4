#include "ricochet/collision/surfaces_in_other_frames.h"

#include <algorithm>

#include "ricochet/core/tolerances.h"

namespace ricochet {

double offset_for_carrying(const MovingPose& pose, const Vec3& local_position) {
    return kCarryingOffsets * max_abs(pose.local_position(pose.point(local_position)) - local_position);
}

/// The tolerance follows from the segment, so that a distant end of the path with more rounding allows no overlap here.
bool SurfacesInOtherFrames::is_free(const Deforming& triangle, const PathPoint& p, const PathPoint& q) const {
    const double tolerance = sphere_tolerance(triangle.radius, std::max(max_abs(p.world), max_abs(q.world)));
    const double radius = std::max(0.0, triangle.radius - tolerance);
    const DeformingMesh& mesh = surfaces_.bodies().deforming().mesh_with(triangle.surface);
    return mesh.is_free(triangle.surface, surfaces_.stored_position(p), surfaces_.stored_position(q), radius);
}

bool SurfacesInOtherFrames::are_free(const PathPoint& p, const PathPoint& q) const {
    return std::ranges::all_of(
               bodies_,
               [&](const Body& body) { return body.near.is_free(local_position(body, p), local_position(body, q)); }) &&
           std::ranges::all_of(deforming_, [&](const Deforming& triangle) { return is_free(triangle, p, q); });
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
    return std::ranges::all_of(bodies_, [&](const Body& body) { return body.near.covers_chord(body.path, from, to); });
}

double SurfacesInOtherFrames::offset_at(const PathPoint& p) const {
    const MovingColliders& bodies = surfaces_.bodies();
    double offset = contact_offset(p.world);
    for (const Body& body : bodies_) {
        offset = std::max(offset, contact_offset(local_position(body, p)));
        if (!bodies.has_frame(body.id)) continue;
        const MovingPose pose = bodies.pose(body.id, surfaces_.clock().at(p.time));
        offset = std::max(offset, contact_offset(pose.world_from_frame.translation));
        if (bodies.is_dynamic(body.id)) {
            offset = std::max(offset, offset_for_carrying(pose, local_position(body, p)));
        }
    }
    for (const Deforming& triangle : deforming_) {
        offset = std::max(offset, bodies.deforming().mesh_with(triangle.surface).offset());
    }
    return offset;
}

}  // namespace ricochet
