/// \file
/// Sweep of a sphere along a path against a triangle or a plane: first contact, closest point and normal. Pure
/// geometry.
///
/// The centre must stay outside the triangle thickened by the radius. This solid is a prism between two offset faces,
/// three cylinders around the edges and three balls around the vertices. The time of contact is the first root over all
/// of these parts (e.g. C. Ericson, "Real-Time Collision Detection", Morgan Kaufmann 2005, section 5.5). It is within
/// an ulp of the root for the exact path coefficients, triangle and radius. A grazing contact may be missed if its
/// depth is below 2^-76 d^2 / radius. d is the sum of the distance travelled and the distance from the triangle.
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
    double time = 0.0;  ///< in s, in [0, duration]
    Vec3 normal;        ///< unit vector from the surface to the centre
    Vec3 point;         ///< nearest point of the surface
    TriangleFeature feature = TriangleFeature::kFace;
};

/// A moving sphere, prepared for many tests.
///
/// The time of contact is the first time at which the distance between centre and surface decreases to the radius. A
/// sphere that starts in overlap has a contact only if it approaches: at the first time at which the distance is at
/// most the radius and decreases (faster than kMinApproach of the speed). Separation and motion along the surface cause
/// no contact. If the centre starts on the surface itself, no motion causes a contact until the centre returns.
class SphereSweep {
public:
    /// Prepares a sphere of the given radius (m, > 0). Certified segments can be up to `beside` (m, >= 0) beside the
    /// path, so triangles within this distance are not culled.
    SphereSweep(const Path& path, double radius, double beside = 0.0);

    /// Returns the first contact with the closed triangle (a, b, c) from either side. Culls the triangle first, and
    /// then runs the narrow phase. A degenerate triangle consists of its edges and vertices. If the face and another
    /// feature are hit within rounding (kSeamSlack), the face is reported with its own time. The normal then has the
    /// bits of unit_normal(a, b, c) or of its negative.
    [[nodiscard]] std::optional<SphereContact> first_contact(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// Returns the contact of first_contact() without culling.
    [[nodiscard]] std::optional<SphereContact> narrow_phase_contact(const TrianglePlane& triangle) const;
    /// Returns the first contact with a plane from either side. An axis-aligned plane has an exact normal, so the time
    /// has the same bits as for any triangle in the plane.
    [[nodiscard]] std::optional<SphereContact> first_contact(const Plane& plane) const;

    /// Restricts the sweep to times up to `latest`, in s. Culling then considers the path only up to that time, and
    /// later contacts with triangles may be missing. Earlier contacts keep their bits. The function never extends the
    /// sweep.
    void shorten_to(double latest);

    /// Returns true if the sphere on the path and its chords certainly keeps a distance of kCandidateSlack from the
    /// triangle. Tests only the bounding box and the plane, and returns false if undecided.
    [[nodiscard]] bool can_cull(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// Like can_cull(), but tests the separating direction at the path's end, where the path often comes closest. This
    /// takes more time.
    [[nodiscard]] bool can_cull_at_end(const Vec3& a, const Vec3& b, const Vec3& c) const;

    /// Returns true if the start is certainly further than the radius from the triangle. The test is cheap, and returns
    /// false if undecided.
    [[nodiscard]] bool starts_separated_from(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// Returns the speed along a separating direction, in m/s, if it proves that there is no contact. The proof needs a
    /// straight path that certainly leads away from the triangle, and a sphere without overlap. Returns 0 otherwise, in
    /// particular if the sphere touches the triangle.
    [[nodiscard]] double separating_speed(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// Returns true if the path is straight and certainly leads away from the triangle's closest point to its start.
    /// The distance from a convex set is convex along a line. It therefore never decreases, and there is no contact.
    [[nodiscard]] bool is_separating_from(const ClosestPointOnTriangle& closest_to_start, const Vec3& a, const Vec3& b,
                                          const Vec3& c) const;

    [[nodiscard]] const Path& path() const { return path_; }
    [[nodiscard]] double radius() const { return radius_; }

private:
    friend class SphereTriangleSweep;

    [[nodiscard]] const Vec3& hull(int i) const { return hull_[static_cast<std::size_t>(i)]; }
    void update_bounds();
    [[nodiscard]] bool misses_box(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// Returns true if the path until latest_ is short, compared with the whole path, and certainly does not touch the
    /// triangle. In this case the other tests cannot cull the triangle, because slack_ is too large.
    [[nodiscard]] bool stays_clear(const Vec3& a, const Vec3& b, const Vec3& c) const;
    [[nodiscard]] bool misses_plane(const detail::FilteredCross& normal, const Vec3& a) const;

    Path path_;
    double radius_;
    double latest_;               ///< in s; later contacts do not matter
    std::array<Vec3, 4> hull_{};  ///< Bezier control points until latest_: path and chords lie in their convex hull
    int hull_count_ = 0;
    Vec3 lower_;  ///< box of the control points
    Vec3 upper_;
    double max_distance_ = 0.0;  ///< bound on the distance from the start, in m
    double scale_ = 0.0;         ///< largest coordinate of the whole path's hull plus radius, in m
    double slack_ = 0.0;         ///< kCandidateSlack * scale_ plus the distance of segments from the path, in m
    Coefficients<double> squared_displacement_{};
    Coefficients<DoubleDouble> precise_squared_displacement_{};
};

/// Returns true if a sphere whose centre moves straight from p to q stays at least radius - tolerance away from the
/// triangle. `tolerance`: see sphere_tolerance().
[[nodiscard]] bool sphere_segment_is_clear(const Vec3& p, const Vec3& q, double radius, double tolerance, const Vec3& a,
                                           const Vec3& b, const Vec3& c);

}  // namespace ricochet
