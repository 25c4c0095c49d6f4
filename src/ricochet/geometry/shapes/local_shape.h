/// \file
/// Ellipsoids and capped cylinders in their own frame, centred at the origin and aligned with the axes. The class
/// computes the side of a point, the nearest point and tests of segments. Pure geometry.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <span>

#include "ricochet/core/double_double.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/shapes/ellipsoid.h"

namespace ricochet {

/// A segment, or the start of a path, with the error of its coordinates.
template <class Scalar>
struct LocalSegment {
    VectorOf<Scalar> from;
    VectorOf<Scalar> to;
    double coordinate_error = 0.0;  ///< in m, bound on the error of every coordinate
    double unit = 0.0;              ///< bound on the rounding error of a term, relative to its magnitude
};

/// An ellipsoid centred at the origin, or an elliptic cylinder around z between two caps.
class LocalShape {
public:
    /// Makes a cylinder, or a ball if it is not capped. half_axes: in m.
    LocalShape(const std::array<double, 3>& half_axes, bool is_capped);

    /// Returns +1 outside and -1 inside. Returns 0 if the segment's errors leave the side of `from` undecided.
    template <class Scalar>
    [[nodiscard]] int side_of_start(const LocalSegment<Scalar>& segment) const;
    /// Returns true if the whole segment is certainly on one side of the surface.
    template <class Scalar>
    [[nodiscard]] bool is_clear(const LocalSegment<Scalar>& segment) const;

    [[nodiscard]] ShapePoint closest_point(const PreciseVec3& y) const;
    /// Returns the closest point of one part, with its rim.
    [[nodiscard]] ShapePoint closest_point_of(ShapePart part, const PreciseVec3& y) const;
    /// Returns the closest point of one part that is extended beyond its rim to an infinite cylinder or a plane.
    [[nodiscard]] ShapePoint closest_point_beyond(ShapePart part, const PreciseVec3& y) const;
    /// Returns the time, in s, for which a path stays above a cap, or beside the cap by at most `slack` (m).
    [[nodiscard]] double time_over_cap(const LocalPath& path, double slack) const;
    /// Returns the side and, for a capped shape, the top and the bottom.
    [[nodiscard]] std::span<const ShapePart> parts() const;
    /// Returns a lower bound on the distance of a segment from the surface, tight to rounding. Requires is_clear().
    [[nodiscard]] double distance_of(const PreciseVec3& from, const PreciseVec3& to) const;

    [[nodiscard]] const Ellipsoid& ellipsoid() const { return ellipsoid_; }
    [[nodiscard]] bool is_capped() const { return is_capped_; }
    [[nodiscard]] double half_height() const { return half_height_; }
    /// Returns the radius of a ball around the origin that contains the shape, in m.
    [[nodiscard]] double extent() const { return ellipsoid_.largest() + half_height_; }
    /// Returns the maximum of n . y over the shape.
    [[nodiscard]] double support(const Vec3& n) const {
        return ellipsoid_.support(n) + (is_capped_ ? half_height_ * std::fabs(n.z) : 0.0);
    }

private:
    template <class Scalar>
    struct Interval {
        Scalar from{};
        Scalar to{1.0};
    };
    template <class Scalar>
    [[nodiscard]] std::optional<Interval<Scalar>> between_caps(const LocalSegment<Scalar>& segment) const;
    [[nodiscard]] double distance_from_outside(const PreciseVec3& from, const PreciseVec3& to) const;

    Ellipsoid ellipsoid_;
    bool is_capped_;
    double half_height_;  ///< in m; 0 for balls
};

/// First contact of a moving sphere (or point, radius 0) with a shape.
struct ShapeContact {
    double time = 0.0;  ///< in s, along the path
    Vec3 normal;        ///< unit vector from the surface to the centre's side
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

/// Parts of a shape that are excluded from contacts because they support the particle.
struct SupportingParts {
    std::array<bool, 3> is_supporting{};
    [[nodiscard]] bool any() const { return is_supporting[0] || is_supporting[1] || is_supporting[2]; }
    [[nodiscard]] bool operator[](ShapePart part) const { return is_supporting[static_cast<std::size_t>(part)]; }
    void add(ShapePart part) { is_supporting[static_cast<std::size_t>(part)] = true; }
};

/// Returns the contacts of AnalyticShape::contacts() in the shape's frame.
[[nodiscard]] ShapeContacts contacts_of(const LocalShape& shape, const LocalPath& path, double radius,
                                        const SupportingParts& supports);

}  // namespace ricochet
