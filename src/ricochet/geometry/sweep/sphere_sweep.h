/// \file
/// A sphere on a path against a triangle or a plane: when does its surface first touch, where, and in which direction
/// is it turned back? Pure geometry; no particle, no response.
///
/// The centre must stay out of the triangle thickened by the radius, which is the union of a prism between two offset
/// faces, three cylinders around the edges and three balls around the vertices. The first time at which the centre
/// enters the union is the smallest of the times at which it enters a part, so no case falls between two features.
/// Method: e.g. C. Ericson, "Real-Time Collision Detection", Morgan Kaufmann 2005, section 5.5; the roots are those of
/// polynomial.h, on coefficients in double-double.
///
/// Accuracy: the time is within an ulp of that of the exact path coefficients, triangle and radius. What can be missed
/// is a graze that dips below the surface by less than 2^-76 of (distance travelled and from the triangle)^2 / radius.
#pragma once

#include <array>
#include <optional>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/predicates/triangle_plane.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/point_sweep.h"
#include "ricochet/geometry/sweep/polynomial.h"

namespace ricochet {

/// The first contact of a sphere with a surface.
struct SphereContact {
    double time = 0.0;  ///< s, in [0, duration]
    Vec3 normal;        ///< unit vector from the surface to the centre
    Vec3 point;         ///< nearest point of the surface
    TriangleFeature feature = TriangleFeature::kFace;
};

/// A moving sphere, prepared for many tests.
///
/// Contact is the first time at which the distance between centre and surface shrinks to the radius. A sphere that
/// starts in overlap (distance < radius) is stopped only when approaching: contact is then the first time at which the
/// distance is shrinking (faster than kMinApproach of the speed) while it is at most the radius. Separating motion
/// and motion along the surface are free, and so is any motion of a centre on the surface itself until it returns.
class SphereSweep {
public:
    /// radius > 0, m.
    SphereSweep(const Path& path, double radius);

    /// First contact with the closed triangle (a, b, c), from either side. A degenerate triangle is its edges and
    /// vertices. Where face, edges and vertices tie to rounding (kSeamSlack) the face is reported, with the face's time
    /// and the bits of unit_normal(a, b, c) or their opposite.
    [[nodiscard]] std::optional<SphereContact> first_contact(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// The same for a triangle that can_cull() has not discarded.
    [[nodiscard]] std::optional<SphereContact> narrow_phase_contact(const TrianglePlane& triangle) const;
    /// First contact with a plane, from either side. Where the plane is axis-aligned, so that its normal is exact, the
    /// time has the same bits as that of any triangle in it.
    [[nodiscard]] std::optional<SphereContact> first_contact(const Plane& plane) const;

    /// What comes after `latest`, s, does not matter any more: can_cull() is about the path up to then only, and
    /// contacts with triangles after it need not be found. Those before it are the same. A pure narrowing.
    void shorten_to(double latest);

    /// True when the sphere and its chords certainly stay clear of the triangle by `kCandidateSlack`: the cheap test
    /// that decides most candidates. Errs on the side of false. first_contact makes this test itself.
    [[nodiscard]] bool can_cull(const Vec3& a, const Vec3& b, const Vec3& c) const;

    /// The same as can_cull() by a test that costs more, and serves where the path comes nearest to the triangle at its
    /// end.
    [[nodiscard]] bool can_cull_at_end(const Vec3& a, const Vec3& b, const Vec3& c) const;

    /// True when the start is certainly further than the radius from the triangle. Cheap; errs on the side of false.
    [[nodiscard]] bool starts_separated_from(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// Where the path is straight and certainly leads away from the triangle, which the sphere does not overlap, so
    /// that nothing is met: the speed, m/s, along a direction in which the triangle is behind. Else 0. Cheap; errs on
    /// the side of 0, always so where the sphere touches the triangle.
    [[nodiscard]] double separating_speed(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// Given the point of the triangle (a, b, c) nearest to the start: true when the path is straight and certainly
    /// leads away from there. The distance from a convex set is convex along a line, so it never shrinks then, and
    /// nothing is met.
    [[nodiscard]] bool is_separating_from(const ClosestPointOnTriangle& nearest_to_start, const Vec3& a, const Vec3& b,
                                          const Vec3& c) const;

    [[nodiscard]] const Path& path() const { return path_; }
    [[nodiscard]] double radius() const { return radius_; }

private:
    friend class SphereTriangleSweep;

    [[nodiscard]] const Vec3& hull(int i) const { return hull_[static_cast<std::size_t>(i)]; }
    void enclose();
    [[nodiscard]] bool misses_box(const Vec3& a, const Vec3& b, const Vec3& c) const;
    [[nodiscard]] bool misses_plane(const detail::FilteredCross& normal, const Vec3& a) const;

    Path path_;
    double radius_;
    double latest_;               ///< s, until which contacts matter
    std::array<Vec3, 4> hull_{};  ///< Bezier points: path and chords until then lie in their convex hull
    int hull_count_ = 0;
    Vec3 lower_;  ///< their box
    Vec3 upper_;
    double reach_ = 0.0;  ///< bound of the distance from the start, m
    double scale_ = 0.0;  ///< largest coordinate of the whole path's hull plus radius, m
    double slack_ = 0.0;  ///< kCandidateSlack of that, m
    Coefficients<double> squared_displacement_{};
    Coefficients<DoubleDouble> precise_squared_displacement_{};
};

/// Is the sphere whose centre travels straight from p to q at least radius - tolerance away from the triangle all the
/// way? `tolerance` is sphere_tolerance() of the case. The distance from a convex set is convex along a line, so an end
/// from which the segment recedes decides for the whole segment; otherwise the distance of the segment is computed.
[[nodiscard]] bool sphere_segment_is_clear(const Vec3& p, const Vec3& q, double radius, double tolerance, const Vec3& a,
                                           const Vec3& b, const Vec3& c);

}  // namespace ricochet
