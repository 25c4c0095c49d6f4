/// \file
/// The first contact of a path with the world: planes and shapes, then triangles by broad and narrow phase, and in the
/// same query how long the path remains free beyond its end; and the certificate of segments beside the path.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/broad_phase.h"
#include "ricochet/collision/look_ahead.h"
#include "ricochet/collision/way_point.h"

namespace ricochet {

class ForeignSurfaces;

// The surfaces near a path, and the certificate of segments beside it.

/// The surfaces that a contact query has gathered near its path, up to the first contact. What it says about segments
/// holds for those on the path or within slack() of it. Valid until the next query with the same scratch memory.
class NearSurfaces {
public:
    NearSurfaces(const SurfaceGeometry& geometry, const ContactScratch& scratch, const QueryMargins& margins,
                 const Vec3& start, CandidateSet candidates)
        : geometry_(geometry), scratch_(&scratch), margins_(margins), start_(start), candidates_(candidates) {}

    /// The certificate: no surface blocks the closed segment [p, q] of the centre. A surface blocks a segment that
    /// intersects it (decided exactly for planes and triangles) or that comes nearer to it than the radius less
    /// sphere_tolerance(). Surfaces overlapped from the start only block what intersects them.
    [[nodiscard]] bool is_free(const Vec3& p, const Vec3& q) const;
    /// The surface of the smallest number that blocks the segment.
    [[nodiscard]] std::optional<SurfaceId> blocker(const Vec3& p, const Vec3& q) const;
    /// The same for a segment that starts on surfaces: true when it leaves all of them and intersects no other.
    [[nodiscard]] bool is_free_after(const Vec3& p, const Vec3& q) const;

    // The same of links from one stored position to the next, which have to be free in the frame of every collider
    // that is near. Where nothing moves, a link is the segment.

    /// From now on with the surfaces of other frames, which must outlive it.
    void join(const ForeignSurfaces& foreign) { foreign_ = &foreign; }
    [[nodiscard]] const ForeignSurfaces* foreign() const { return foreign_; }
    /// Where the path starts.
    [[nodiscard]] WayPoint start() const;
    /// The stored position nearest to a point at a time along the path.
    [[nodiscard]] WayPoint point_at(const Vec3& p, double time) const;
    [[nodiscard]] bool is_link_free(const WayPoint& p, const WayPoint& q) const;
    [[nodiscard]] std::optional<SurfaceId> link_blocker(const WayPoint& p, const WayPoint& q) const;
    /// CollisionWorld's functions of the same names for a surface of any frame, seen from this one.
    [[nodiscard]] CollisionWorld::Nearest nearest(SurfaceId surface, const WayPoint& p) const;
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const WayPoint& p) const;
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, const WayPoint& p) const;
    [[nodiscard]] int side_of_surface(SurfaceId surface, const WayPoint& p) const;
    [[nodiscard]] bool is_flat(SurfaceId surface) const;
    /// m, the contact offset for a position, by the largest of its coordinates in all frames.
    [[nodiscard]] double offset_at(const WayPoint& p) const;

    /// True when the surfaces include all that the path's chord between two times may intersect.
    [[nodiscard]] bool covers_chord(const Path& path, double from, double to) const;
    /// All of them on which the point lies exactly.
    [[nodiscard]] std::vector<SurfaceId> surfaces_at(const Vec3& p) const;
    /// True when the sphere overlaps a surface by more than the tolerance (a point: lies on one) at the path's start.
    [[nodiscard]] bool starts_in_overlap() const;

    [[nodiscard]] const SurfaceGeometry& geometry() const { return geometry_; }
    [[nodiscard]] const CollisionWorld& world() const { return geometry_.world(); }
    [[nodiscard]] double radius() const { return margins_.radius; }
    /// m, how far beside the path certified positions may lie: nothing is known of surfaces further off.
    [[nodiscard]] double slack() const { return margins_.slack; }

private:
    [[nodiscard]] std::vector<SurfaceId> surfaces(const Vec3& p) const;
    [[nodiscard]] bool is_overlapped(SurfaceId surface) const;
    [[nodiscard]] bool plane_blocks(const CollisionWorld::PlaneSurface& plane, const Vec3& p, const Vec3& q) const;
    [[nodiscard]] bool shape_blocks(const CollisionWorld::ShapeSurface& shape, const Vec3& p, const Vec3& q) const;
    [[nodiscard]] bool triangle_blocks(std::uint32_t triangle, const Vec3& p, const Vec3& q) const;

    SurfaceGeometry geometry_;
    const ContactScratch* scratch_;
    QueryMargins margins_;
    Vec3 start_;
    CandidateSet candidates_;
    const ForeignSurfaces* foreign_ = nullptr;  ///< null where there are none
};

/// A path, and what is already known about it.
struct ContactQuery {
    const Path& path;     ///< of the centre; finite
    double radius = 0.0;  ///< m, 0 for a point; prepared (CollisionWorld::prepare_radius)
    /// Where the particle goes after the path, with which it begins; null: do not look ahead. The contact is the same.
    const LookAhead* look_ahead = nullptr;
    /// All triangles near this path, where an earlier query has found them (LookAheadResult::candidates).
    ContactCandidates candidates = {};
    /// Surfaces that the particle touches and is held by, so that it follows them: they are no contacts, and block only
    /// what intersects them.
    std::span<const SurfaceId> held = {};
    /// m, by which positions along the path may lie further beside it than rounding puts them.
    double beside = 0.0;
};

/// The first contact, and what else the query has found on the way to it.
struct ContactQueryResult {
    std::optional<Contact> contact;  ///< the first under the order (time, collider, triangle)
    NearSurfaces near;               ///< for certificates of segments along the path, up to the contact
    LookAheadResult ahead;           ///< only without a contact
};

/// The first contact of a point or a sphere. geometry and scratch: of one thread; what `near` says is valid until the
/// next query with them.
[[nodiscard]] ContactQueryResult find_first_contact(const SurfaceGeometry& geometry, const ContactQuery& query,
                                                    ContactScratch& scratch);

}  // namespace ricochet
