/// \file
/// Finds the first contact of a path with the world: planes and shapes, then triangles by broad and narrow phase. The
/// same query finds how long the path remains free beyond its end. It also certifies segments beside the path.
#pragma once

#include <algorithm>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/broad_phase.h"
#include "ricochet/collision/look_ahead.h"
#include "ricochet/collision/surfaces_in_time.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {

class SurfacesInOtherFrames;

// The surfaces near a path, and the certificate of segments beside it.

/// The surfaces that a contact query has gathered near its path, up to the first contact. Results about segments are
/// valid for segments on the path or within slack() of it. The object is valid until the next query with the same
/// scratch memory.
class NearSurfaces {
public:
    NearSurfaces(const SurfaceGeometry& geometry, const ContactScratch& scratch, const QueryMargins& margins,
                 const Vec3& start, CandidateSet candidates)
        : geometry_(geometry), scratch_(&scratch), margins_(margins), start_(start), candidates_(candidates) {}

    /// Returns true if no surface blocks the closed segment [p, q] of the centre. This is the certificate. A surface
    /// blocks a segment that intersects it; this is decided exactly for planes and triangles. A surface also blocks a
    /// segment if their distance is smaller than the radius minus sphere_tolerance() of the segment. Supports and
    /// surfaces that are overlapped from the start block only segments that intersect them.
    [[nodiscard]] bool is_free(const Vec3& p, const Vec3& q) const;
    /// Returns the surface with the smallest number that blocks the segment, or nothing.
    [[nodiscard]] std::optional<SurfaceId> blocker(const Vec3& p, const Vec3& q) const;
    /// Returns a surface that a sphere at q overlaps by more than the tolerance, and by more than a sphere at p. It
    /// tests the supports and the surfaces that are overlapped from the start, because is_free() ignores their overlap.
    [[nodiscard]] std::optional<SurfaceId> deepened_overlap(const Vec3& p, const Vec3& q) const;
    /// Returns true if a segment that starts on surfaces leaves all of them and intersects no other.
    [[nodiscard]] bool is_free_after(const Vec3& p, const Vec3& q) const;

    // Functions for space-time segments between two stored positions. Such a segment is free if it is free in the frame
    // of every collider near it. If no collider moves, the space-time segment is simply the straight segment.

    /// Adds the surfaces of other frames, which must outlive this object.
    void join(const SurfacesInOtherFrames& other_frames) { other_frames_ = &other_frames; }
    [[nodiscard]] const SurfacesInOtherFrames* other_frames() const { return other_frames_; }
    /// Returns the start of the path.
    [[nodiscard]] PathPoint start() const;
    /// Returns the stored position nearest to point p at the given time along the path.
    [[nodiscard]] PathPoint point_at(const Vec3& p, double time) const;
    [[nodiscard]] bool is_segment_free(const PathPoint& p, const PathPoint& q) const;
    [[nodiscard]] std::optional<SurfaceId> segment_blocker(const PathPoint& p, const PathPoint& q) const;
    [[nodiscard]] std::optional<SurfaceId> overlap_deepened_by(const PathPoint& p, const PathPoint& q) const;
    /// Equivalents of CollisionWorld's functions with the same names. They accept a surface of any frame and return
    /// values in this frame.
    [[nodiscard]] CollisionWorld::Nearest nearest(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const PathPoint& p) const;
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, const PathPoint& p) const;
    /// Returns a surface with its normal at p, which points towards p. For a point p in the plane of the surface, the
    /// normal is zero.
    [[nodiscard]] ContactSurface facing_surface(SurfaceId surface, const PathPoint& p) const;
    /// Returns the contact offset, in m, for the largest coordinate that a position has in any frame.
    [[nodiscard]] double offset_at(const PathPoint& p) const;

    /// Returns true if the surfaces include all surfaces that the path's chord between two times may intersect.
    [[nodiscard]] bool covers_chord(const Path& path, double from, double to) const;
    /// Returns the surfaces on which the point lies exactly.
    [[nodiscard]] std::vector<SurfaceId> surfaces_at(const Vec3& p) const;
    /// Returns true if the particle starts in overlap: a sphere that has supports or overlaps a surface by more than
    /// the tolerance, or a point on a surface.
    [[nodiscard]] bool starts_in_overlap() const;

    [[nodiscard]] const SurfaceGeometry& geometry() const { return geometry_; }
    [[nodiscard]] const CollisionWorld& world() const { return geometry_.world(); }
    [[nodiscard]] double radius() const { return margins_.radius; }
    /// Returns the distance from the path, in m, within which positions can be certified. Surfaces farther away are
    /// unknown.
    [[nodiscard]] double slack() const { return margins_.slack; }

private:
    [[nodiscard]] std::vector<SurfaceId> surfaces(const Vec3& p) const;
    [[nodiscard]] bool is_own(SurfaceId surface) const;
    [[nodiscard]] bool is_overlapped(SurfaceId surface) const;
    /// Returns sphere_tolerance() of a segment, in m; 0 for a point. It depends on the segment, because the larger
    /// rounding error at a distant end of the path must not allow an overlap here.
    [[nodiscard]] double tolerance_of(const Vec3& p, const Vec3& q) const {
        if (margins_.radius == 0.0) return 0.0;
        return sphere_tolerance(margins_.radius, std::max(max_abs(p), max_abs(q)));
    }
    // `tolerance` is tolerance_of() of the segment.
    [[nodiscard]] bool plane_blocks(const CollisionWorld::PlaneSurface& plane, const Vec3& p, const Vec3& q,
                                    double tolerance) const;
    [[nodiscard]] bool shape_blocks(const CollisionWorld::ShapeSurface& shape, const Vec3& p, const Vec3& q,
                                    double tolerance) const;
    [[nodiscard]] bool triangle_blocks(std::uint32_t triangle, const Vec3& p, const Vec3& q, double tolerance) const;

    SurfaceGeometry geometry_;
    const ContactScratch* scratch_;
    QueryMargins margins_;
    Vec3 start_;
    CandidateSet candidates_;
    const SurfacesInOtherFrames* other_frames_ = nullptr;  ///< null if no other frame has surfaces near
};

/// A path, and the facts already known about it.
struct ContactQuery {
    const Path& path;     ///< path of the centre; finite
    double radius = 0.0;  ///< in m, 0 for a point; prepared (CollisionWorld::prepare_radius)
    /// Longer path that begins with `path`, for the look-ahead; null: no look-ahead. The contact does not depend on it.
    const LookAhead* look_ahead = nullptr;
    /// All triangles near this path, if an earlier query has found them (LookAheadResult::candidates).
    ContactCandidates candidates = {};
    /// Surfaces that support the particle, which moves along them. They are not reported as contacts, and block only
    /// segments that intersect them.
    std::span<const SurfaceId> supports = {};
    /// Distance, in m, by which positions may deviate from the path in addition to rounding.
    double beside = 0.0;
};

/// The first contact, and the other results of the same query.
struct ContactQueryResult {
    std::optional<Contact> contact;  ///< the first in the order (time, collider, triangle)
    NearSurfaces near;               ///< certifies segments along the path, up to the contact
    LookAheadResult ahead;           ///< set only without a contact
};

/// Returns the first contact of a point or a sphere. `geometry` and `scratch` must belong to the calling thread. The
/// member `near` is valid until the next query with either of them.
[[nodiscard]] ContactQueryResult find_first_contact(const SurfaceGeometry& geometry, const ContactQuery& query,
                                                    ContactScratch& scratch);

}  // namespace ricochet
