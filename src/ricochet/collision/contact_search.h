/// \file
/// First contact of a path with the world, and the certificate of the segments that are really travelled.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/collision/collision_world.h"
#include "ricochet/collision/contact_candidates.h"
#include "ricochet/collision/look_ahead.h"
#include "ricochet/collision/triangle_planes.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/sphere_sweep.h"

namespace ricochet {

/// A surface that takes part in an impact.
struct ContactSurface {
    SurfaceId surface = 0;
    Vec3 normal;       ///< unit, facing the side that the path comes from; for spheres from the surface to the centre
    bool flat = true;  ///< a plane or the inside of a triangle; false: a rim, a corner or a curved surface
};

/// The first contact of a path: all surfaces met at the same time (kSimultaneousUlps), the smallest number first.
struct Contact {
    static constexpr int kMostSurfaces = 8;

    double time = 0.0;  ///< s along the path
    std::array<ContactSurface, kMostSurfaces> surfaces;
    int count = 0;  ///< at least 1; of more than kMostSurfaces the smallest numbers are kept

    [[nodiscard]] std::span<const ContactSurface> all() const {
        return {surfaces.data(), static_cast<std::size_t>(count)};
    }
    [[nodiscard]] const ContactSurface& first() const { return surfaces[0]; }
};

/// Unit normal of a surface that a point at p comes to from `side` (+1, -1) with velocity v. A point that runs exactly
/// in the surface's plane (side 0) has met its rim head-on: the normal is then against the motion.
[[nodiscard]] Vec3 facing_normal(const CollisionWorld& world, SurfaceId surface, int side, const Vec3& p,
                                 const Vec3& v);

/// Scratch memory of one thread, kept between queries so that the loop over particles allocates nothing.
struct ContactScratch {
    struct Found {
        double time;
        SurfaceId surface;
        int side;  ///< of a point's path; unused for spheres
        bool flat;
        Vec3 normal;  ///< for spheres; that of points is worked out for the first contact only
    };
    std::vector<std::uint32_t> triangles;  ///< candidates that the path does not clear, up to the first contact found
    std::vector<std::uint32_t> planes;     ///< the same, indices into CollisionWorld::planes()
    std::vector<std::uint32_t> shapes;     ///< the same, indices into CollisionWorld::shapes()
    std::vector<SurfaceId> overlapped;     ///< surfaces that the sphere already overlaps at the path's start
    std::vector<Found> found;
    struct Ahead {
        std::uint32_t triangle;
        double enter;  ///< s along the look_ahead's path
    };
    std::vector<Ahead> ahead;  ///< triangles that come near after the path's end
    TrianglePlanes planes_of_triangles;
    std::vector<Vec3> chain;  ///< ends of the certified segments of the last travel, its start first
};

/// Answers for one path at a time: search() gathers the surfaces near the path and finds the first contact; the other
/// questions are then about places on or next to that path, up to that contact.
class ContactSearch {
public:
    ContactSearch(const CollisionWorld& world, ContactScratch& scratch) : world_(world), scratch_(scratch) {
        scratch_.planes_of_triangles.forget();
    }

    /// First contact of a point (radius 0) or a sphere whose centre follows `path`, under the order (time, collider,
    /// triangle). The path must be finite, the radius prepared (CollisionWorld::prepare_radius). With an look_ahead,
    /// whose path begins with this one, the same search also finds out free_until() and candidates(); the contact is
    /// the same. `candidates` may hold all triangles that an earlier search with an look_ahead has seen near this path.
    [[nodiscard]] std::optional<Contact> search(const Path& path, double radius, const LookAhead* look_ahead = nullptr,
                                                const ContactCandidates& candidates = {});

    /// s along the look_ahead's path: until then no surface is nearer to it than the radius plus its margin, but for
    /// those that a sphere leaves behind for good. Where the path meets something, or looking ahead is not worth the
    /// while: no more than the path's duration.
    [[nodiscard]] double free_until() const { return free_until_; }

    /// The triangles, other than those left behind, that come near the look_ahead's path between the searched path's
    /// end and candidates_until(), s along it: at most its `beyond` after free_until().
    [[nodiscard]] const ContactCandidates& candidates() const { return candidates_; }
    [[nodiscard]] double candidates_until() const { return candidates_until_; }

    /// The smallest numbered surface that stands in the way of the closed segment [p, q] of the centre: one that the
    /// segment itself meets (decided exactly for planes and triangles), or one that comes nearer to it than the radius
    /// less sphere_tolerance(). Surfaces overlapped from the start only block the segment itself. p and q lie on the
    /// searched path, or within the safe_position distance of it.
    [[nodiscard]] std::optional<SurfaceId> blocker(const Vec3& p, const Vec3& q) const;
    [[nodiscard]] bool is_free(const Vec3& p, const Vec3& q) const;
    /// The same for a segment that starts on surfaces: true when it leaves all of them and meets no other.
    [[nodiscard]] bool is_free_after(const Vec3& p, const Vec3& q) const;
    /// All gathered surfaces on which the point lies exactly.
    [[nodiscard]] std::vector<SurfaceId> surfaces_at(const Vec3& p) const;

    // The world's answers of the same names; those about triangles that were met last come faster here.
    [[nodiscard]] Vec3 unit_normal_of(SurfaceId surface, const Vec3& p) const;
    [[nodiscard]] double signed_distance_from(SurfaceId surface, const Vec3& p) const;
    [[nodiscard]] CollisionWorld::Nearest nearest(SurfaceId surface, const Vec3& p) const;

    /// True when the surfaces gathered include all that the path's chord from time `from` to `to` may meet. Longer
    /// chords of a curved path may pass through places that the search has not looked at.
    [[nodiscard]] bool covers_chord(const Path& path, double from, double to) const;

    /// True when the sphere overlaps a surface by more than the tolerance (a point: lies on one) at the path's start.
    [[nodiscard]] bool starts_in_overlap() const;

    /// The certified places of the last travel() or find_safe_position(), in order; kept here so that nothing is
    /// allocated on the way.
    [[nodiscard]] std::vector<Vec3>& chain() const { return scratch_.chain; }
    [[nodiscard]] const CollisionWorld& world() const { return world_; }
    [[nodiscard]] double radius() const { return radius_; }
    /// m, how far beside the searched path places may lie: what is gathered says nothing about places further off.
    [[nodiscard]] double slack() const { return slack_; }

private:
    void search_planes(const Path& path);
    void begin(const Path& path, double radius);
    void look_at_awaited(const Path& path, const ContactCandidates& candidates);
    void search_triangles_of(const Path& path, const LookAhead* look_ahead);
    void search_meshes(const Path& path);
    void look_past_planes_and_shapes(const LookAhead& look_ahead);
    [[nodiscard]] Box3 box_of_interest(const LookAhead& look_ahead) const;
    [[nodiscard]] bool boxes_hold(const Path& path, double duration) const;
    bool look_along_line(const Path& path, const LookAhead& look_ahead);
    bool look_along_parabola(const Path& path, const LookAhead& look_ahead);
    void look_along_stretch(const Path& path, const LookAhead& look_ahead, double from, double to);
    [[nodiscard]] double margin_of(const LookAhead& look_ahead, double until) const;
    [[nodiscard]] double margin_of(const Path& path) const;
    [[nodiscard]] double end_of_look(const LookAhead& look_ahead) const;
    [[nodiscard]] double end_of_interest(const Path& path, const LookAhead& look_ahead) const;
    void note_ahead(std::uint32_t triangle, const LookAhead& look_ahead, double enter, double last);
    [[nodiscard]] double time_of_approach(std::uint32_t triangle, const LookAhead& look_ahead, double enter,
                                          double last) const;
    void keep_candidates(double until);
    void search_shapes(const Path& path);
    void search_triangles(const Path& path, double from, double to, int depth);
    void search_all_triangles(const Path& path);
    [[nodiscard]] bool may_reach_triangles(const Path& path, double from, double to) const;
    [[nodiscard]] std::vector<SurfaceId> gathered() const;
    double look_at_triangle(const Path& path, std::uint32_t triangle);
    void look_with_point(const Path& path, std::uint32_t triangle);
    double look_with_sphere(std::uint32_t triangle);
    [[nodiscard]] bool leaves_for_good(double speed, const LookAhead& look_ahead) const;
    void note(const ContactScratch::Found& found);
    void note_overlap(SurfaceId surface, double distance);
    [[nodiscard]] bool is_overlapped(SurfaceId surface) const;
    [[nodiscard]] bool plane_blocks(const CollisionWorld::PlaneSurface& plane, const Vec3& p, const Vec3& q) const;
    [[nodiscard]] bool shape_blocks(const CollisionWorld::ShapeSurface& shape, const Vec3& p, const Vec3& q) const;
    [[nodiscard]] bool triangle_blocks(std::uint32_t triangle, const Vec3& p, const Vec3& q) const;
    [[nodiscard]] Contact first_of_found(const Path& path) const;
    [[nodiscard]] const TrianglePlane& plane_of(std::uint32_t triangle) const {
        return scratch_.planes_of_triangles.of(world_, triangle);
    }

    const CollisionWorld& world_;
    ContactScratch& scratch_;
    const TriangleBvh* bvh_ = nullptr;
    std::optional<SphereSweep> sphere_;  ///< nothing for points
    double radius_ = 0.0;
    double tolerance_ = 0.0;  ///< sphere_tolerance() of this path; 0 for points
    double slack_ = 0.0;
    double largest_ = 0.0;        ///< largest coordinate that the path reaches, m
    double bulge_ = 0.0;          ///< what the boxes leave for the path's curvature, m
    bool all_triangles_ = false;  ///< every triangle is a candidate
    double first_time_ = 0.0;
    double free_until_ = 0.0;        ///< s along the look_ahead's path
    double candidates_until_ = 0.0;  ///< the same
    ContactCandidates candidates_;
    Vec3 start_;
};

}  // namespace ricochet
