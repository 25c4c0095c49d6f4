/// \file
/// Shapes with a formula: ellipsoids (a ball under any placement) and capped cylinders, as two-sided surfaces. Pure
/// geometry in world coordinates.
///
/// The axes are the directions of the placement's columns, made exactly orthonormal, the half axes their lengths,
/// rounded; half axes that agree to rounding are equal, unrotated placements exact. Decisions and times are those of
/// this shape, in double-double; it differs from the image under the rounded map by a few 2^-53 of its size.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "ricochet/core/box3.h"
#include "ricochet/core/transform.h"
#include "ricochet/geometry/shapes/ellipsoid.h"
#include "ricochet/geometry/shapes/local_shape.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Orthonormal frame of a shape: world = center + sum of local_i * axis_i.
class ShapeFrame {
public:
    /// Frame of an affine map whose columns are orthogonal up to rounding (rotation times scale) and not zero. The
    /// columns' directions, made orthonormal in double-double, are the axes; a mirrored axis may point either way.
    explicit ShapeFrame(const AffineMap& world_from_local);

    /// Coordinates of p, rounded: each within 2^-50 |p - center|.
    [[nodiscard]] Vec3 local_point(const Vec3& p) const;
    /// Coordinates of p, each within 2^-98 |p - center|.
    [[nodiscard]] PreciseVec3 precise_local_point(const Vec3& p) const;
    [[nodiscard]] LocalPath local_path(const Path& path) const;

    [[nodiscard]] Vec3 world_point(const Vec3& local) const { return center_ + rotated(local); }
    /// A unit vector stays one.
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
    bool is_aligned_ = false;  ///< the axes are those of the world: nothing is rotated
};

/// First contact of a moving sphere (or point, radius 0) with a shape.
struct ShapeContact {
    double time = 0.0;  ///< s along the path
    Vec3 normal;        ///< unit, from the surface to the centre's side
    Vec3 point;         ///< on the surface
    ShapePart part = ShapePart::side;
    bool on_rim = false;
};

/// The first contact with each part of a shape.
struct ShapeContacts {
    std::array<ShapeContact, 3> contacts{};
    std::size_t count = 0;
    [[nodiscard]] std::span<const ShapeContact> all() const { return {contacts.data(), count}; }
};

/// The closest point of a shape's surface.
struct ShapePoint {
    Vec3 point;
    Vec3 normal;            ///< unit, outward
    double distance = 0.0;  ///< signed, m: positive outside
    ShapePart part = ShapePart::side;
    bool on_rim = false;  ///< where a cap and the side meet
};

/// A two-sided surface around a convex body. Immutable; safe from any number of threads.
class AnalyticShape {
public:
    /// The image of the unit ball: a sphere, or an ellipsoid when the scale differs by axis. The map is a scale (no
    /// zeros; mirrored ones too), then a rotation, then a translation; finite.
    static AnalyticShape ball(const AffineMap& world_from_local);
    /// The image of the cylinder x^2 + y^2 <= 1, |z| <= 1 with its caps.
    static AnalyticShape cylinder(const AffineMap& world_from_local);

    /// +1 outside, -1 inside, 0 when p is so close to the surface (some 2^-96 of the distances involved) that rounding
    /// decides. Never wrong: the rounding error is bounded.
    [[nodiscard]] int side(const Vec3& p) const;

    /// Closest point of the surface; on the medial axis one of several. The distance has an error of some 2^-50 of
    /// itself, also next to the surface and far from the origin (see Ellipsoid::closest_point); the point and its
    /// normal have that error and the rounding of the coordinates.
    [[nodiscard]] ShapePoint closest_point(const Vec3& p) const;
    /// The same of one part, with its rim; and of one that goes on beyond it: an endless cylinder, a plane. From inside
    /// a cylinder touches as these do: several at a time.
    [[nodiscard]] ShapePoint closest_point_of(ShapePart part, const Vec3& p) const;
    [[nodiscard]] ShapePoint closest_point_beyond(ShapePart part, const Vec3& p) const;
    /// How many parts it has: the side, and two caps.
    [[nodiscard]] std::size_t part_count() const { return shape_.parts().size(); }
    /// Time that a path along a part stays within `slack` m of it; the whole duration for sides.
    [[nodiscard]] double time_over(ShapePart part, const Path& path, double slack) const;

    /// For each part the first time at which the distance between the path and it shrinks to `radius` (m, >= 0), from
    /// either side; from outside, where only one can be met, the first of all. Held parts are left out; from outside
    /// nothing else can be met either then. A sphere that starts in overlap is stopped only when approaching: at the
    /// first time at which the distance shrinks (faster than kMinApproach of the speed) while it is at most the radius.
    /// A point that starts on the surface is turned back from the side it heads for, at time 0.
    ///
    /// Points, spheres against spheres, and spheres inside circular cylinders: roots of polynomials in double-double,
    /// right to about an ulp. Other cases: conservative advancement on the true distance, right to that distance's
    /// error over the normal speed, and to an ulp. Only grazes that dip in by less than those errors can be missed.
    [[nodiscard]] ShapeContacts contacts(const Path& path, double radius, const HeldParts& held = {}) const;
    /// The first of them.
    [[nodiscard]] std::optional<ShapeContact> first_contact(const Path& path, double radius) const;

    /// True when the closed segment [p, q] certainly does not intersect the surface. Errs on the side of false, by some
    /// 2^-90.
    [[nodiscard]] bool segment_is_clear(const Vec3& p, const Vec3& q) const;

    /// A lower bound of the distance between the closed segment [p, q] and the surface, m, tight to 2^-47 (and the
    /// error of closest_point). 0 unless the segment is clear.
    [[nodiscard]] double distance_to_segment(const Vec3& p, const Vec3& q) const;

    /// True when path, chords and everything within `margin` metres of them certainly stay off the surface. Cheap; errs
    /// on the side of false.
    [[nodiscard]] bool can_cull(const Path& path, double margin) const;

    /// A box around the shape, larger by rounding at most.
    [[nodiscard]] const Box3& bounds() const { return bounds_; }

private:
    AnalyticShape(const AffineMap& world_from_local, const LocalShape& shape);

    [[nodiscard]] ShapePoint in_world(const LocalPoint& near, const Vec3& p) const;
    template <class Scalar>
    [[nodiscard]] LocalSegment<Scalar> segment(const Vec3& p, const Vec3& q) const;

    ShapeFrame frame_;
    LocalShape shape_;
    Box3 bounds_;
};

}  // namespace ricochet
