/// \file
/// Exact geometric predicates. The returned sign is always the sign of the real-number expression.
///
/// Method: J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates",
/// Discrete & Computational Geometry 18, 1997. Each predicate first uses a floating-point filter with a proven error
/// bound. If undecided, it uses double-double arithmetic with its own bound, and finally expansions
/// (docs/exactness.md). The predicates are exact as long as no product leaves the range of doubles. This requires
/// coordinates that are multiples of 2^-340 and below 2^300, which flush_tiny() and the mesh readers ensure.
#pragma once

#include <cmath>

#include "ricochet/core/double_double.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// A point of a projection plane.
struct Point2 {
    double u = 0.0;
    double v = 0.0;
    friend constexpr bool operator==(const Point2&, const Point2&) = default;
};

/// Smallest coordinate magnitude. Smaller coordinates are replaced by zero, which keeps every product inside the range
/// of doubles. Local: a bound that the proof of exactness needs.
inline constexpr double kSmallestExactCoordinate = 0x1p-287;

/// Returns p with components of magnitudes below kSmallestExactCoordinate replaced by zero.
[[nodiscard]] inline Vec3 flush_tiny(const Vec3& p) {
    const auto flushed = [](double x) { return std::fabs(x) < kSmallestExactCoordinate ? 0.0 : x; };
    return {flushed(p.x), flushed(p.y), flushed(p.z)};
}

/// Returns the sign of a value with the given error bound, or 0 if the bound leaves it undecided.
[[nodiscard]] constexpr int sign_beyond(double value, double error) {
    return static_cast<int>(value > error) - static_cast<int>(value < -error);
}

/// Returns the sign of (b - a) x (c - a) . (d - a). It is +1 if d is on the side that the triangle's normal
/// (counter-clockwise rule) points to, and -1 if d is on the other side. It is 0 if d is in the plane or if a, b and c
/// are collinear.
[[nodiscard]] int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Returns true if a, b and c are exactly collinear. Coincident points count as collinear.
[[nodiscard]] bool are_collinear(const Vec3& a, const Vec3& b, const Vec3& c);

/// Returns true if the closed segment [p, q] and the closed triangle (a, b, c) have a point in common. The result is
/// exact in every case, including coplanar and degenerate segments and degenerate triangles.
[[nodiscard]] bool segment_intersects_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                               const Vec3& c);

/// Returns true if p lies on the closed triangle, which can be degenerate. Exact.
[[nodiscard]] bool point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Returns the fraction t in [0, 1] at which p + t (q - p) crosses the plane of (a, b, c). The exact orientations of p
/// and q must differ in sign (one can be zero). The result is within 2 ulp of the exact value for every shape of
/// triangle.
[[nodiscard]] double crossing_fraction(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// Returns the unit normal of (a, b, c) by the counter-clockwise rule. Every component is within 2^-51 of the exact
/// component, also for slender triangles. The normal of an axis-aligned triangle is exactly an axis, with positive
/// zeros. The triangle must not be degenerate.
[[nodiscard]] Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c);

// The filters are inline because they decide nearly every call of the innermost loop.
namespace detail {

/// A cross product u x v in plain doubles. `magnitude` is the sum of the magnitudes of each component's terms, for the
/// error bound.
struct FilteredCross {
    Vec3 value;
    Vec3 magnitude;
};

[[nodiscard]] inline FilteredCross filtered_cross(const Vec3& u, const Vec3& v) {
    const double yz = u.y * v.z, zy = u.z * v.y;
    const double zx = u.z * v.x, xz = u.x * v.z;
    const double xy = u.x * v.y, yx = u.y * v.x;
    return {{yz - zy, zx - xz, xy - yx},
            {std::fabs(yz) + std::fabs(zy), std::fabs(zx) + std::fabs(xz), std::fabs(xy) + std::fabs(yx)}};
}

/// Error of filtered_sign's determinant relative to its magnitude. Each of the six terms has at most 8 roundings u =
/// 2^-53 (3 differences, 2 products, 1 subtraction, 2 additions). The bound is slightly above 8 u, so 8.5 u is used.
/// Underflow is harmless, because terms are multiples of 2^-1020, so sums below 2^-967 are exact. Local: an error bound
/// of this arithmetic.
inline constexpr double kDeterminantFilter = 0x1.1p-50;

/// Returns the sign of (u x v) . w if the error bound decides it, else 0. u, v and w are rounded differences of points.
[[nodiscard]] inline int filtered_sign(const FilteredCross& cross, const Vec3& w) {
    const double determinant = cross.value.x * w.x + cross.value.y * w.y + cross.value.z * w.z;
    const double magnitude =
        cross.magnitude.x * std::fabs(w.x) + cross.magnitude.y * std::fabs(w.y) + cross.magnitude.z * std::fabs(w.z);
    return sign_beyond(determinant, kDeterminantFilter * magnitude);
}

/// Computes orient2d for points that the filter does not decide.
[[nodiscard]] int orient2d_beyond_filter(const Point2& a, const Point2& b, const Point2& c);

/// Computes orient3d for points that the filter does not decide.
[[nodiscard]] int orient3d_beyond_filter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Computes segment_intersects_triangle for a segment whose ends the filter has not found on the same side. p_side and
/// q_side are the filter's results (0: not decided).
[[nodiscard]] bool segment_intersects_triangle_beyond_filter(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                                             const Vec3& c, int p_side, int q_side);

}  // namespace detail

inline int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const int filtered = detail::filtered_sign(detail::filtered_cross(b - a, c - a), d - a);
    return filtered != 0 ? filtered : detail::orient3d_beyond_filter(a, b, c, d);
}

inline bool segment_intersects_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
    const detail::FilteredCross normal = detail::filtered_cross(b - a, c - a);
    const int p_side = detail::filtered_sign(normal, p - a);
    const int q_side = detail::filtered_sign(normal, q - a);
    if (p_side * q_side > 0) return false;
    return detail::segment_intersects_triangle_beyond_filter(p, q, a, b, c, p_side, q_side);
}

/// Returns +1 if a, b and c turn counter-clockwise, -1 if clockwise and 0 if they are collinear. Exact.
[[nodiscard]] inline int orient2d(const Point2& a, const Point2& b, const Point2& c) {
    // Each term has 4 roundings of u = 2^-53: two differences, a product and the subtraction. The bound is slightly
    // above 4 u. Local: an error bound of this arithmetic.
    constexpr double kFilter = 4.5 * 0x1p-53;
    const double left = (b.u - a.u) * (c.v - a.v);
    const double right = (b.v - a.v) * (c.u - a.u);
    const int filtered = sign_beyond(left - right, kFilter * (std::fabs(left) + std::fabs(right)));
    return filtered != 0 ? filtered : detail::orient2d_beyond_filter(a, b, c);
}

}  // namespace ricochet
