/// \file
/// Exact geometric predicates: the sign returned is the sign of the real-number expression, always.
///
/// Method: J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates",
/// Discrete & Computational Geometry 18, 1997: a floating-point filter with a proven error bound, then double-double
/// with its own bound, then expansions (docs/exactness.md). Exact while no product leaves the range of doubles:
/// coordinates are multiples of 2^-340 and below 2^300, which flush_tiny() and the mesh readers ensure.
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

/// Largest coordinate magnitude for which the predicates are exact.
inline constexpr double kLargestExactCoordinate = 0x1p300;
/// Coordinates smaller than this are replaced by zero, which keeps every product inside the range of doubles.
inline constexpr double kSmallestExactCoordinate = 0x1p-287;

/// Replaces components smaller than kSmallestExactCoordinate by zero; other values are returned unchanged.
[[nodiscard]] inline Vec3 flush_tiny(const Vec3& p) {
    const auto flushed = [](double x) { return std::fabs(x) < kSmallestExactCoordinate ? 0.0 : x; };
    return {flushed(p.x), flushed(p.y), flushed(p.z)};
}

/// Sign of (b - a) x (c - a) . (d - a): +1 when d lies on the side that the triangle's normal (counter-clockwise rule)
/// points to, -1 on the other side, 0 in the plane (or when a, b, c are collinear).
[[nodiscard]] int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// True when a, b and c are exactly collinear (coincident points included).
[[nodiscard]] bool are_collinear(const Vec3& a, const Vec3& b, const Vec3& c);

/// True when the closed segment [p, q] and the closed triangle (a, b, c) have a point in common. Exact in every case:
/// coplanar and degenerate segments, degenerate triangles.
[[nodiscard]] bool segment_intersects_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                               const Vec3& c);

/// True when p lies on the closed triangle, which may be degenerate. Exact.
[[nodiscard]] bool point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Fraction t in [0, 1] at which p + t (q - p) crosses the plane of (a, b, c), for p and q whose exact orientations
/// differ in sign (one may be zero). Within 2 ulp of the exact rational, whatever the triangle's shape.
[[nodiscard]] double crossing_fraction(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// Unit normal of (a, b, c) by the counter-clockwise rule. Every component is within 2^-51 of the exact one, also for
/// slender triangles; an axis-aligned triangle gives exactly an axis, its zeros positive. The triangle must not be
/// degenerate.
[[nodiscard]] Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c);

// The filters are inline because they decide nearly every call of the innermost loop.
namespace detail {

/// A cross product u x v in plain doubles with, for its error bound, the sums of the magnitudes of its terms.
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

/// Error of filtered_sign's determinant relative to its magnitude. Each of the six terms passes at most 8 roundings
/// u = 2^-53 (3 differences, 2 products, 1 subtraction, 2 additions): 8 u and a little, so 8.5 u. Underflow is
/// harmless: terms are multiples of 2^-1020, so sums below 2^-967 are exact.
inline constexpr double kDeterminantFilter = 0x1.1p-50;

/// Sign of (u x v) . w when the error bound decides it, else 0. All of u, v, w are rounded differences of
/// points.
[[nodiscard]] inline int filtered_sign(const FilteredCross& cross, const Vec3& w) {
    const double determinant = cross.value.x * w.x + cross.value.y * w.y + cross.value.z * w.z;
    const double magnitude =
        cross.magnitude.x * std::fabs(w.x) + cross.magnitude.y * std::fabs(w.y) + cross.magnitude.z * std::fabs(w.z);
    const double bound = kDeterminantFilter * magnitude;
    return static_cast<int>(determinant > bound) - static_cast<int>(determinant < -bound);
}

/// orient2d when the filter does not decide.
[[nodiscard]] int orient2d_beyond_filter(const Point2& a, const Point2& b, const Point2& c);

/// orient3d when the filter does not decide.
[[nodiscard]] int orient3d_beyond_filter(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// segment_intersects_triangle when the filter has not put both ends on the same side; p_side and q_side are what it
/// found (0: not decided).
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

/// +1 when a, b, c turn counter-clockwise, -1 when clockwise, 0 when they are collinear; exact.
[[nodiscard]] inline int orient2d(const Point2& a, const Point2& b, const Point2& c) {
    // Two differences, a product and the subtraction: 4 roundings of u = 2^-53 on either term, and a little.
    constexpr double kFilter = 4.5 * 0x1p-53;
    const double left = (b.u - a.u) * (c.v - a.v);
    const double right = (b.v - a.v) * (c.u - a.u);
    const double value = left - right;
    const double bound = kFilter * (std::fabs(left) + std::fabs(right));
    if (value > bound) return 1;
    if (value < -bound) return -1;
    return detail::orient2d_beyond_filter(a, b, c);
}

}  // namespace ricochet
