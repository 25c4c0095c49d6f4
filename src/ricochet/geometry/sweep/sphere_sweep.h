/// \file
/// Sweep of a sphere along a path against a triangle or a plane: first contact, closest point and normal. Pure
/// geometry.
///
/// The centre must stay out of the triangle thickened by the radius: a prism between two offset faces, three cylinders
/// around the edges, three balls around the vertices. Contact is the first root over all of them (e.g. C. Ericson,
/// "Real-Time Collision Detection", Morgan Kaufmann 2005, section 5.5), within an ulp of that of the exact path
/// coefficients, triangle and radius. Grazes that dip below the surface by less than 2^-76 of (distance travelled and
/// from the triangle)^2 / radius may be missed.
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
/// starts in overlap is stopped only when approaching: at the first time at which the distance shrinks (faster than
/// kMinApproach of the speed) while it is at most the radius. Separating motion and motion along the surface are free,
/// and so is any motion of a centre on the surface itself until it returns.
class SphereSweep {
public:
    /// radius > 0, m. beside >= 0, m, by which what is certified may lie beside the path: nothing nearer is culled.
    SphereSweep(const Path& path, double radius, double beside = 0.0);

    /// First contact with the closed triangle (a, b, c), from either side: culling, then the narrow phase. A degenerate
    /// triangle is its edges and vertices. Where features tie to rounding (kSeamSlack) the face is reported, with the
    /// face's time and the bits of unit_normal(a, b, c) or their opposite.
    [[nodiscard]] std::optional<SphereContact> first_contact(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// The same without culling.
    [[nodiscard]] std::optional<SphereContact> narrow_phase_contact(const TrianglePlane& triangle) const;
    /// First contact with a plane, from either side. Where the plane is axis-aligned, so that its normal is exact, the
    /// time has the same bits as that of any triangle in it.
    [[nodiscard]] std::optional<SphereContact> first_contact(const Plane& plane) const;

    /// Restricts the sweep to times up to `latest`, s: culling considers the path until then only, and later contacts
    /// with triangles need not be found. Earlier ones keep their bits. Never lengthens the sweep.
    void shorten_to(double latest);

    /// True when the sphere and its chords certainly stay kCandidateSlack away from the triangle, by bounding box and
    /// plane. Cheap; errs on the side of false.
    [[nodiscard]] bool can_cull(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// The same by the separating direction at the path's end, where the path often comes closest. Costs more.
    [[nodiscard]] bool can_cull_at_end(const Vec3& a, const Vec3& b, const Vec3& c) const;

    /// True when the start is certainly further than the radius from the triangle. Cheap; errs on the side of false.
    [[nodiscard]] bool starts_separated_from(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// Speed, m/s, along a separating direction, where the path is straight, certainly leads away from the triangle and
    /// the sphere does not overlap it, so that there is no contact. Else 0, always so where the sphere touches it.
    [[nodiscard]] double separating_speed(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// True when the path is straight and certainly leads away from the triangle's closest point to its start: the
    /// distance from a convex set is convex along a line, so it never shrinks and there is no contact.
    [[nodiscard]] bool is_separating_from(const ClosestPointOnTriangle& closest_to_start, const Vec3& a, const Vec3& b,
                                          const Vec3& c) const;

    [[nodiscard]] const Path& path() const { return path_; }
    [[nodiscard]] double radius() const { return radius_; }

private:
    friend class SphereTriangleSweep;

    [[nodiscard]] const Vec3& hull(int i) const { return hull_[static_cast<std::size_t>(i)]; }
    void update_bounds();
    [[nodiscard]] bool misses_box(const Vec3& a, const Vec3& b, const Vec3& c) const;
    /// True where the path until latest_ is tiny beside all of it and certainly meets nothing of the triangle: what
    /// slack_ does not let cull is no contact.
    [[nodiscard]] bool stays_clear(const Vec3& a, const Vec3& b, const Vec3& c) const;
    [[nodiscard]] bool misses_plane(const detail::FilteredCross& normal, const Vec3& a) const;

    Path path_;
    double radius_;
    double latest_;               ///< s, until which contacts matter
    std::array<Vec3, 4> hull_{};  ///< Bezier control points until then: path and chords lie in their convex hull
    int hull_count_ = 0;
    Vec3 lower_;  ///< their box
    Vec3 upper_;
    double max_distance_ = 0.0;  ///< bound of the distance from the start, m
    double scale_ = 0.0;         ///< largest coordinate of the whole path's hull plus radius, m
    double slack_ = 0.0;         ///< kCandidateSlack of that and what may lie beside the path, m
    Coefficients<double> squared_displacement_{};
    Coefficients<DoubleDouble> precise_squared_displacement_{};
};

/// True when the sphere whose centre travels straight from p to q stays at least radius - tolerance away from the
/// triangle. `tolerance`: see sphere_tolerance().
[[nodiscard]] bool sphere_segment_is_clear(const Vec3& p, const Vec3& q, double radius, double tolerance, const Vec3& a,
                                           const Vec3& b, const Vec3& c);

}  // namespace ricochet
