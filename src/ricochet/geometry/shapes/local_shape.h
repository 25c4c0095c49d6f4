/// \file
/// Ellipsoids and capped cylinders in their own frame, about the origin and along the axes: side, nearest point,
/// segments. Pure geometry.
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

/// A segment, or the start of a path, given with the error of its coordinates.
template <class Scalar>
struct LocalSegment {
    VectorOf<Scalar> from;
    VectorOf<Scalar> to;
    double coordinate_error = 0.0;  ///< m, bound of the error of every coordinate
    double unit = 0.0;              ///< error of a term of the arithmetic, relative to the term
};

/// An ellipsoid about the origin, or an elliptic cylinder about z between two caps.
class LocalShape {
public:
    static LocalShape ball(const std::array<double, 3>& half_axes);
    static LocalShape cylinder(const std::array<double, 3>& half_axes);

    /// +1 outside, -1 inside, 0 when the errors given with the segment leave the side of `from` open.
    template <class Scalar>
    [[nodiscard]] int side_of_start(const LocalSegment<Scalar>& segment) const;
    /// True when both ends of the segment are certainly on the same side and all that is between them with them.
    template <class Scalar>
    [[nodiscard]] bool is_clear(const LocalSegment<Scalar>& segment) const;

    [[nodiscard]] LocalPoint closest_point(const PreciseVec3& y) const;
    /// The same of one part, with its rim.
    [[nodiscard]] LocalPoint closest_point_of(ShapePart part, const PreciseVec3& y) const;
    /// The same of one part that goes on beyond its rim: an endless cylinder, a plane.
    [[nodiscard]] LocalPoint closest_point_beyond(ShapePart part, const PreciseVec3& y) const;
    /// Time that a path stays over a cap, or beside it by at most `slack` m, s.
    [[nodiscard]] double time_over_cap(const LocalPath& path, double slack) const;
    /// side, and top and bottom where there are caps.
    [[nodiscard]] std::span<const ShapePart> parts() const;
    /// A lower bound, tight to rounding, of the distance of a segment that is_clear() from the surface.
    [[nodiscard]] double distance_of(const PreciseVec3& from, const PreciseVec3& to) const;

    [[nodiscard]] const Ellipsoid& ellipsoid() const { return ellipsoid_; }
    [[nodiscard]] bool is_capped() const { return is_capped_; }
    [[nodiscard]] double half_height() const { return half_height_; }
    /// Radius of a ball about the origin that holds the shape, m.
    [[nodiscard]] double extent() const { return ellipsoid_.largest() + half_height_; }
    /// max over the shape of n . y.
    [[nodiscard]] double support(const Vec3& n) const {
        return ellipsoid_.support(n) + (is_capped_ ? half_height_ * std::fabs(n.z) : 0.0);
    }

private:
    LocalShape(const std::array<double, 3>& half_axes, bool is_capped);

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
    double half_height_;  ///< m; 0 for balls
};

/// The first contact with a shape, in its frame.
struct LocalContact {
    double time = 0.0;  ///< s
    Vec3 normal;        ///< unit, from the surface to the side the path comes from
    Vec3 point;         ///< on the surface
    ShapePart part = ShapePart::side;
    bool on_rim = false;
};

/// The first contact with each part of a shape.
struct LocalContacts {
    std::array<LocalContact, 3> contacts{};
    std::size_t count = 0;
    [[nodiscard]] std::span<const LocalContact> all() const { return {contacts.data(), count}; }
};

/// Parts of a shape that take no part in contacts, since they hold the particle.
struct HeldParts {
    std::array<bool, 3> is_held{};
    [[nodiscard]] bool any() const { return is_held[0] || is_held[1] || is_held[2]; }
    [[nodiscard]] bool operator[](ShapePart part) const { return is_held[static_cast<std::size_t>(part)]; }
    void add(ShapePart part) { is_held[static_cast<std::size_t>(part)] = true; }
};

/// See AnalyticShape::contacts.
[[nodiscard]] LocalContacts contacts_of(const LocalShape& shape, const LocalPath& path, double radius,
                                        const HeldParts& held);

}  // namespace ricochet
