/// \file
/// Two-sided analytic surfaces: ellipsoids (a ball under any affine map) and capped cylinders. Pure geometry in world
/// coordinates.
///
/// The axes of a shape are the directions of the map's columns, made exactly orthonormal. The half axes are the
/// columns' rounded lengths. Half axes that agree to rounding are made equal, and maps without rotation are exact.
/// Decisions and times are computed for this shape in double-double. The shape differs from the image under the rounded
/// map by a few 2^-53 of its size.
#pragma once

#include <array>
#include <cstddef>

#include "ricochet/core/box3.h"
#include "ricochet/core/transform.h"
#include "ricochet/geometry/shapes/ellipsoid.h"
#include "ricochet/geometry/shapes/local_shape.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Orthonormal frame of a shape: world = center + sum of local_i * axis_i.
class ShapeFrame {
public:
    /// Makes the frame of an affine map whose columns are nonzero and orthogonal up to rounding (rotation times scale).
    /// The axes are the columns' directions, made orthonormal in double-double. A mirrored axis may have either sign.
    explicit ShapeFrame(const AffineMap& world_from_local);

    /// Returns the rounded local coordinates of p, each with an error of at most 2^-50 |p - center|.
    [[nodiscard]] Vec3 local_point(const Vec3& p) const;
    /// Returns the local coordinates of p, each with an error of at most 2^-98 |p - center|.
    [[nodiscard]] PreciseVec3 precise_local_point(const Vec3& p) const;
    [[nodiscard]] LocalPath local_path(const Path& path) const;

    [[nodiscard]] Vec3 world_point(const Vec3& local) const { return center_ + rotated(local); }
    /// Rotates a normal into world coordinates. A unit vector stays a unit vector.
    [[nodiscard]] Vec3 world_normal(const Vec3& local) const {
        return is_aligned_ ? local : normalized(rotated(local));
    }
    [[nodiscard]] const Vec3& axis(int i) const { return rounded_axes_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const Vec3& center() const { return center_; }

private:
    [[nodiscard]] Vec3 rotated(const Vec3& local) const;

    Vec3 center_;
    std::array<PreciseVec3, 3> axes_{};
    std::array<Vec3, 3> rounded_axes_{};
    bool is_aligned_ = false;  ///< the axes are the world axes, so nothing is rotated
};

/// A two-sided surface around a convex body. Immutable, so any number of threads may use it.
class AnalyticShape {
public:
    /// Makes the image of the unit ball: a sphere, or an ellipsoid if the scale differs by axis. The map must be
    /// finite: a nonzero scale (mirroring is allowed), then a rotation, then a translation.
    static AnalyticShape ball(const AffineMap& world_from_local);
    /// Makes the image of the cylinder x^2 + y^2 <= 1, |z| <= 1 with its caps.
    static AnalyticShape cylinder(const AffineMap& world_from_local);

    /// Returns +1 outside and -1 inside. Returns 0 if p is so close to the surface that rounding would decide (about
    /// 2^-96 of the distances involved). The sign is never wrong, because the rounding error is bounded.
    [[nodiscard]] int side(const Vec3& p) const;

    /// Returns the closest point of the surface; on the medial axis it is one of several. The distance has a relative
    /// error of about 2^-50, also next to the surface and far from the origin (see Ellipsoid::closest_point). The point
    /// and its normal have that error plus the rounding of the coordinates.
    [[nodiscard]] ShapePoint closest_point(const Vec3& p) const;
    /// Return the closest point of one part. closest_point_of() includes the part's rim. closest_point_beyond() extends
    /// the part beyond its rim to an infinite cylinder or a plane. A sphere inside a cylinder touches these extended
    /// parts, and can touch several of them at a time.
    [[nodiscard]] ShapePoint closest_point_of(ShapePart part, const Vec3& p) const;
    [[nodiscard]] ShapePoint closest_point_beyond(ShapePart part, const Vec3& p) const;
    /// Returns the number of parts: 1 for a ball (the side), 3 for a cylinder (the side and two caps).
    [[nodiscard]] std::size_t part_count() const { return shape_.parts().size(); }
    /// Returns the time, in s, for which a path along a part stays within `slack` (m) of the part. For the side this is
    /// the whole duration.
    [[nodiscard]] double time_over(ShapePart part, const Path& path, double slack) const;

    /// Finds, for each part, the first time at which the distance from the path decreases to `radius` (m, >= 0), from
    /// either side. From outside, only the first contact over all parts is returned. Parts in `supports` are skipped.
    /// If there are any, contacts from outside are skipped too. A sphere that starts in overlap has a contact only if
    /// it approaches: at the first time at which the distance is at most the radius and decreases (faster than
    /// kMinApproach of the speed). A point that starts on the surface hits it at time 0, as if it came from the side
    /// opposite to its motion.
    ///
    /// Points, spheres against spheres, and spheres inside circular cylinders use roots of polynomials in
    /// double-double, with an error of about an ulp. Other cases use conservative advancement on the true distance. The
    /// error of their times is the error of the distance divided by the normal speed, plus an ulp. Only grazing
    /// contacts that are less deep than these errors can be missed.
    [[nodiscard]] ShapeContacts contacts(const Path& path, double radius, const SupportingParts& supports = {}) const;

    /// Returns true if the closed segment [p, q] certainly does not intersect the surface. Returns false if this is
    /// undecided, to about 2^-90.
    [[nodiscard]] bool segment_is_clear(const Vec3& p, const Vec3& q) const;

    /// Returns a lower bound on the distance between the closed segment [p, q] and the surface, in m. The bound is
    /// tight to 2^-47 (plus the error of closest_point). It is 0 if the segment is not clear.
    [[nodiscard]] double distance_to_segment(const Vec3& p, const Vec3& q) const;

    /// Returns true if the path, its chords and all points within `margin` metres of them certainly do not touch the
    /// surface. The test is cheap, and returns false if undecided.
    [[nodiscard]] bool can_cull(const Path& path, double margin) const;

    /// Returns a box around the shape. It exceeds the shape only by rounding.
    [[nodiscard]] const Box3& bounds() const { return bounds_; }

private:
    AnalyticShape(const AffineMap& world_from_local, const LocalShape& shape);

    [[nodiscard]] ShapePoint in_world(ShapePoint near, const Vec3& p) const;
    template <class Scalar>
    [[nodiscard]] LocalSegment<Scalar> segment(const Vec3& p, const Vec3& q) const;

    ShapeFrame frame_;
    LocalShape shape_;
    Box3 bounds_;
};

}  // namespace ricochet
