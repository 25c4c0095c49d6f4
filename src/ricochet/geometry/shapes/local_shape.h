/// \file
/// A ball-like or cylinder-like convex body in its own frame: side, nearest point, segments. Pure geometry.
#pragma once

#include <optional>

#include "ricochet/geometry/shapes/centred_ellipsoid.h"

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

    /// +1 outside, -1 inside, 0 when the errors given with the segment do not let its `from` be told.
    template <class Scalar>
    [[nodiscard]] int side_of_start(const LocalSegment<Scalar>& segment) const;
    /// True when both ends of the segment are certainly on the same side and all that is between them with them.
    template <class Scalar>
    [[nodiscard]] bool is_free(const LocalSegment<Scalar>& segment) const;

    [[nodiscard]] LocalNearest nearest(const PreciseVec3& y) const;
    /// A lower bound, tight to rounding, of the distance of a segment that is_free() from the surface.
    [[nodiscard]] double distance_of(const PreciseVec3& from, const PreciseVec3& to) const;

    [[nodiscard]] const CentredEllipsoid& around() const { return around_; }
    [[nodiscard]] bool is_capped() const { return is_capped_; }
    [[nodiscard]] bool is_sphere() const { return !is_capped_ && around_.is_round(); }
    [[nodiscard]] double half_height() const { return half_height_; }
    /// Radius of a ball about the origin that holds the shape, m.
    [[nodiscard]] double extent() const { return around_.largest() + half_height_; }
    /// max over the shape of n . y.
    [[nodiscard]] double support(const Vec3& n) const {
        return around_.support(n) + (is_capped_ ? half_height_ * std::fabs(n.z) : 0.0);
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

    CentredEllipsoid around_;
    bool is_capped_;
    double half_height_;  ///< m; 0 for balls
};

}  // namespace ricochet
