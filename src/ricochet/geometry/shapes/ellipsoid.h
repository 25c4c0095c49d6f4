/// \file
/// Ellipsoids and infinite elliptic cylinders in their own frame, centred at the origin and aligned with the axes. The
/// class computes the side of a point, the nearest point, and a function along a path that is zero on the surface. Pure
/// geometry.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "ricochet/core/double_double.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/sweep/polynomial.h"

namespace ricochet {

/// A path in a shape's frame. Its coefficients are double-doubles, accurate to about 2^-98 of their size.
struct LocalPath {
    std::array<std::array<DoubleDouble, 4>, 3> component{};  ///< by axis, ascending; zero above the degree
    int degree = 1;
    double duration = 0.0;  ///< in s

    [[nodiscard]] PreciseVec3 position(double s) const;
    [[nodiscard]] Vec3 velocity(double s) const;
    /// Returns the second derivative, in m/s^2. It is linear in s.
    [[nodiscard]] Vec3 acceleration(double s) const;
    /// Returns the third derivative, in m/s^3. It is constant.
    [[nodiscard]] Vec3 jerk() const;
};

/// The smooth parts of a shape's surface. A ball has only the side.
enum class ShapePart : std::uint8_t { side, top, bottom };

/// The closest point of a shape's surface.
struct ShapePoint {
    Vec3 point;             ///< on the surface
    Vec3 normal;            ///< unit vector, outward
    double distance = 0.0;  ///< signed, in m: positive outside
    ShapePart part = ShapePart::side;
    bool on_rim = false;  ///< on the edge between a cap and the side
};

/// An ellipsoid at the origin along the coordinate axes. With two axes it is an infinite elliptic cylinder along z. The
/// body is the set with sum over the axes of (y_i / a_i)^2 <= 1. Equal half axes give a circle or sphere, with closed
/// forms.
class Ellipsoid {
public:
    /// Sets the half axes in m, > 0. Only the first `axes` (2 or 3) of them count. Half axes that agree to rounding are
    /// made equal.
    Ellipsoid(const std::array<double, 3>& half_axes, int axes);

    /// Returns a function that is zero on the surface and negative inside. It is |y|^2 - R^2 for a round shape, else
    /// sum (y_i / a_i)^2 - 1. Each term has a relative error of about 2^-100 (double-doubles) or 2^-51 (doubles).
    template <class Scalar>
    [[nodiscard]] Scalar value(const VectorOf<Scalar>& y) const;
    /// Returns a bound on the error of value(). Each coordinate has an error of at most `coordinate_error`, and the
    /// arithmetic has an error of `unit` relative to the terms.
    [[nodiscard]] double value_error(const Vec3& y, double coordinate_error, double unit) const;

    /// Returns value() along a path times `sign`, as a polynomial of twice the path's degree. `radius` replaces the
    /// radius of a round shape.
    [[nodiscard]] Polynomial value_along(const LocalPath& path, int sign,
                                         const std::optional<DoubleDouble>& radius = {}) const;

    /// Returns the closest surface point; on the medial axis it is one of several. The distance has a relative error of
    /// about 2^-50, also next to the surface. At distances above a quarter of the smallest radius of curvature, an
    /// error of 2^-52 of |y| and of the size is added. Inside, the point and the normal are ill-conditioned near the
    /// edge of the medial axis.
    /// Method: D. Eberly, "Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid", Geometric Tools,
    /// 2013 (the equation in sigma). J. More, D. Sorensen, "Computing a Trust Region Step", SIAM J. Sci. Stat. Comput.
    /// 4, 1983 (Newton's method on 1 / norm, which converges from below without overshooting).
    [[nodiscard]] ShapePoint closest_point(const PreciseVec3& y) const;
    /// Returns a bound on the error of the distance from closest_point(), in m.
    [[nodiscard]] double distance_error(double distance, const Vec3& y) const;

    [[nodiscard]] bool is_round() const { return is_round_; }
    [[nodiscard]] double half_axis(int i) const { return half_axes_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] double smallest() const { return smallest_; }
    [[nodiscard]] double largest() const { return largest_; }
    /// Returns the number of axes that count, 2 or 3.
    [[nodiscard]] int axes() const { return static_cast<int>(axes_); }
    /// Returns the outward unit normal at a surface point.
    [[nodiscard]] Vec3 normal_at(const Vec3& y) const;
    /// Returns the maximum of n . y over the ellipsoid for a vector n. This is the height of the tangent plane
    /// perpendicular to n, times |n|.
    [[nodiscard]] double support(const Vec3& n) const;

private:
    [[nodiscard]] ShapePoint closest_point_of_round(const PreciseVec3& y) const;
    [[nodiscard]] double sigma_of(const std::array<double, 3>& y) const;
    [[nodiscard]] double polished(double tau, const std::array<double, 3>& y, double value) const;

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
