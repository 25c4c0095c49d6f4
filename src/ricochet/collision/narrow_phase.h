/// \file
/// The narrow phase tests one path exactly against planes, shapes and triangles, one after the other.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include "ricochet/collision/contact.h"
#include "ricochet/collision/contact_scratch.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/sphere_sweep.h"

namespace ricochet {

/// Returns a bound, in m, of the magnitudes of all coordinates on a path: the largest sum of the magnitudes of its
/// terms.
[[nodiscard]] double largest_coordinate(const Path& path);

/// Returns the distance, in m, from a path within which a query certifies positions. largest: largest coordinate of the
/// path, in m.
[[nodiscard]] double query_slack(double largest, double radius);

/// Margins of a query: the distances from a path within which it considers surfaces.
struct QueryMargins {
    QueryMargins(const CollisionWorld& world, const Path& path, double radius_in, double beside_in = 0.0);

    const TriangleBvh* bvh;  ///< broad phase for the radius
    double radius;           ///< in m, 0 for points
    double beside;           ///< in m, ContactQuery::beside
    double tolerance;        ///< in m, sphere_tolerance() of the path's start; 0 for points
    double largest;          ///< in m, largest_coordinate() of the path
    double slack;            ///< in m, largest distance of certified positions from the path
    double curvature;        ///< in m, margin that the boxes leave for the path's curvature; 0 if they leave none
    /// True if the boxes cover the path's rounding and `beside`. If false, and if the path may reach the box of all
    /// triangles, every triangle is a candidate.
    bool boxes_hold;
};

/// Tests the path of a point (radius 0) or a sphere against surfaces and keeps the first hits. It writes three lists
/// into the scratch memory: the hits, the surfaces that may touch the path, and the surfaces overlapped from its start.
class NarrowPhase {
public:
    /// All arguments must outlive the object. The path must be finite. supports: see ContactQuery.
    NarrowPhase(const SurfaceGeometry& geometry, const Path& path, const QueryMargins& margins,
                std::span<const SurfaceId> supports, ContactScratch& scratch);

    void test_planes();
    void test_shapes();
    /// Tests a triangle; ignores triangles without area. Returns the speed, in m/s, at which a sphere moves straight
    /// away from the triangle, or 0 if it does not.
    double test_triangle(std::uint32_t triangle);

    [[nodiscard]] bool has_hit() const { return !scratch_.hits.empty(); }
    /// Returns the time of the first hit so far, in s; infinite without a hit.
    [[nodiscard]] double first_time() const { return first_time_; }
    /// Returns the surfaces of the first hits. Requires has_hit(). Can be called only once, because it drops the other
    /// hits.
    [[nodiscard]] Contact take_first_contact();

private:
    void test_point(std::uint32_t triangle);
    double test_sphere(std::uint32_t triangle);
    [[nodiscard]] bool is_support(SurfaceId surface) const {
        return !supports_.empty() && std::find(supports_.begin(), supports_.end(), surface) != supports_.end();
    }
    void add_hit(const ContactScratch::Hit& hit);
    void add_overlap(SurfaceId surface, double distance);

    const SurfaceGeometry& geometry_;
    const CollisionWorld& world_;
    const Path& path_;
    const QueryMargins& margins_;
    std::span<const SurfaceId> supports_;  ///< supporting surfaces, see ContactQuery
    ContactScratch& scratch_;
    std::optional<SphereSweep> sphere_;  ///< nothing for points
    double first_time_ = std::numeric_limits<double>::infinity();
};

}  // namespace ricochet
