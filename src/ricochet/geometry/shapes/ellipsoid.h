/// \file
/// Ellipsoids and endless elliptic cylinders in their own frame, about the origin and along the axes: side, nearest
/// point, and the function that is zero on them along a path. Pure geometry.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "ricochet/core/double_double.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/sweep/polynomial.h"

namespace ricochet {

/// A path in a shape's frame, with coefficients in double-double: exact to some 2^-98 of their size.
struct LocalPath {
    std::array<std::array<DoubleDouble, 4>, 3> component{};  ///< by axis, ascending; zero above the degree
    int degree = 1;
    double duration = 0.0;  ///< s

    [[nodiscard]] PreciseVec3 position(double s) const;
    [[nodiscard]] Vec3 velocity(double s) const;
    /// Second derivative, m/s^2: linear in s.
    [[nodiscard]] Vec3 acceleration(double s) const;
    /// Third derivative, m/s^3: constant.
    [[nodiscard]] Vec3 jerk() const;
};

/// The smooth parts of a shape's surface. A ball is all side.
enum class ShapePart : std::uint8_t { side, top, bottom };

/// The point of a surface closest to a given one, in the shape's frame.
struct LocalPoint {
    Vec3 point;             ///< on the surface
    Vec3 normal;            ///< unit, outward
    double distance = 0.0;  ///< signed, m: positive outside
    ShapePart part = ShapePart::side;
    bool on_rim = false;  ///< where a cap and the side meet
};

/// An ellipsoid about the origin along the coordinate axes, or with two axes an endless elliptic cylinder along z:
/// sum over the axes of (y_i / a_i)^2 <= 1. Equal half axes are a circle or sphere, with closed forms.
class Ellipsoid {
public:
    /// Half axes in m, > 0; the first `axes` (2 or 3) of them count. Those that agree to rounding are made equal.
    Ellipsoid(const std::array<double, 3>& half_axes, int axes);

    /// The function that is zero on the surface, negative inside: |y|^2 - R^2 when round, else sum (y_i / a_i)^2 - 1.
    /// Each term has an error of some 2^-100 (double-doubles) or 2^-51 (doubles) of itself.
    template <class Scalar>
    [[nodiscard]] Scalar value(const VectorOf<Scalar>& y) const;
    /// Bound of the error of value() when each coordinate is off by at most `coordinate_error` and arithmetic by `unit`
    /// relative to the terms.
    [[nodiscard]] double value_error(const Vec3& y, double coordinate_error, double unit) const;

    /// value() along a path, as a polynomial of twice its degree, times `sign`. Of a round one, with the radius changed
    /// to `radius`.
    [[nodiscard]] Polynomial value_along(const LocalPath& path, int sign) const;
    [[nodiscard]] Polynomial value_along(const LocalPath& path, int sign, const DoubleDouble& radius) const;

    /// Closest surface point; on the medial axis one of several. The distance is accurate to some 2^-50 of itself, also
    /// next to the surface; further from it than a quarter of the smallest radius of curvature add 2^-52 of |y| and of
    /// the size. Point and normal inside are ill-conditioned near the edge of the medial axis.
    /// Method: D. Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", Geometric Tools,
    /// 2013 (the equation in sigma below); J. More, D. Sorensen, "Computing a Trust Region Step", SIAM J. Sci. Stat.
    /// Comput. 4, 1983 (Newton's method on 1 / norm, which converges from below without overshooting).
    [[nodiscard]] LocalPoint closest_point(const PreciseVec3& y) const;
    /// Bound of the error of that distance, m.
    [[nodiscard]] double distance_error(double distance, const Vec3& y) const;

    [[nodiscard]] bool is_round() const { return is_round_; }
    [[nodiscard]] double half_axis(int i) const { return half_axes_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] double smallest() const { return smallest_; }
    [[nodiscard]] double largest() const { return largest_; }
    /// Number of axes that count, 2 or 3.
    [[nodiscard]] int axes() const { return static_cast<int>(axes_); }
    /// Outward unit normal at a surface point.
    [[nodiscard]] Vec3 normal_at(const Vec3& y) const;
    /// max over the ellipsoid of n . y for a vector n: the height of the tangent plane across n, times |n|.
    [[nodiscard]] double support(const Vec3& n) const;

private:
    [[nodiscard]] LocalPoint closest_point_of_round(const PreciseVec3& y) const;
    [[nodiscard]] double sigma_of(const std::array<double, 3>& y) const;
    [[nodiscard]] double polished(double tau, const std::array<double, 3>& y, double value) const;
    [[nodiscard]] Polynomial value_along(const LocalPath& path, int sign, const std::array<DoubleDouble, 3>& weights,
                                         const DoubleDouble& constant) const;

    std::size_t axes_;
    std::array<double, 3> half_axes_;
    bool is_round_ = false;
    double smallest_ = 0.0;
    double largest_ = 0.0;
    std::array<DoubleDouble, 3> weights_{};  ///< of y_i^2 in value()
    DoubleDouble constant_;                  ///< subtracted in value()
    std::array<double, 3> ratio_{};          ///< (a_i / smallest)^2
    std::array<double, 3> excess_{};         ///< ratio - 1, without cancellation
};

template <class Scalar>
Scalar Ellipsoid::value(const VectorOf<Scalar>& y) const {
    const std::array<Scalar, 3> coordinates{y.x, y.y, y.z};
    Scalar sum = -static_cast<Scalar>(constant_);
    for (std::size_t i = 0; i < axes_; ++i) {
        const Scalar square = coordinates[i] * coordinates[i];
        sum = sum + (is_round_ ? square : static_cast<Scalar>(weights_[i]) * square);
    }
    return sum;
}

}  // namespace ricochet
