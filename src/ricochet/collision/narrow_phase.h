/// \file
/// The narrow phase: exact tests of one path against one plane, shape or triangle after the other.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include "ricochet/collision/contact.h"
#include "ricochet/collision/contact_scratch.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/sphere_sweep.h"

namespace ricochet {

/// Largest magnitude of a coordinate that the terms of a path reach, m.
[[nodiscard]] double largest_coordinate(const Path& path);

/// How far beside a path a query takes surfaces into account.
struct QueryMargins {
    QueryMargins(const CollisionWorld& world, const Path& path, double radius_in, double beside_in = 0.0);

    const TriangleBvh* bvh;  ///< the broad phase for the radius
    double radius;           ///< m, 0 for points
    double beside;           ///< m, ContactQuery::beside
    double tolerance;        ///< m, sphere_tolerance() of the path; 0 for points
    double largest;          ///< m, largest coordinate that the path reaches
    double slack;            ///< m: positions that are certified lie at most that far beside the path
    double curvature;        ///< m, what the boxes leave for the path's curvature; 0 where they do not hold
    bool boxes_hold;         ///< false: the boxes leave less than the path's rounding and `beside` need, so that every
                             ///< triangle near the path's own box is a candidate
};

/// Tests a point's (radius 0) or a sphere's path against surfaces and keeps the first hits. What it gathers goes into
/// the scratch memory: the hits, the surfaces that the path does not clear, those overlapped from its start.
class NarrowPhase {
public:
    /// All must outlive it. The path must be finite. held: see ContactQuery.
    NarrowPhase(const SurfaceGeometry& geometry, const Path& path, const QueryMargins& margins,
                std::span<const SurfaceId> held, ContactScratch& scratch);

    void test_planes();
    void test_shapes();
    /// Triangles of no area are left out. Where a sphere moves straight away from the triangle: the speed of that, m/s;
    /// else 0.
    double test_triangle(std::uint32_t triangle);

    [[nodiscard]] bool has_hit() const { return !scratch_.hits.empty(); }
    /// s, that of the first hit so far; infinite without one.
    [[nodiscard]] double first_time() const { return first_time_; }
    /// The surfaces of the first hits. Only when has_hit(), and only once: it drops the other hits.
    [[nodiscard]] Contact take_first_contact();

private:
    void test_point(std::uint32_t triangle);
    double test_sphere(std::uint32_t triangle);
    void add_hit(const ContactScratch::Hit& hit);
    void add_overlap(SurfaceId surface, double distance);

    const SurfaceGeometry& geometry_;
    const CollisionWorld& world_;
    const Path& path_;
    const QueryMargins& margins_;
    std::span<const SurfaceId> held_;  ///< followed, see ContactQuery
    ContactScratch& scratch_;
    std::optional<SphereSweep> sphere_;  ///< nothing for points
    double first_time_ = std::numeric_limits<double>::infinity();
};

}  // namespace ricochet
