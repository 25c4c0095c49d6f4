/// \file
/// Exact geometric predicates: the sign returned is the sign of the real-number expression, always.
///
/// Method: J. R. Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates",
/// Discrete & Computational Geometry 18, 1997: a floating-point filter with a proven error bound, then expansions.
/// Exact as long as no intermediate product leaves the range of doubles: coordinates are multiples of 2^-340 and below
/// 2^300 in magnitude; flush_tiny() and the readers' extent check see to it.
#pragma once

#include "ricochet/core/double_double.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Largest coordinate magnitude for which the predicates are exact.
inline constexpr double kLargestExactCoordinate = 0x1p300;
/// Coordinates smaller than this are replaced by zero, which keeps every product inside the range of doubles.
inline constexpr double kSmallestExactCoordinate = 0x1p-287;

/// Replaces components smaller than kSmallestExactCoordinate by zero; other values are returned unchanged.
[[nodiscard]] Vec3 flush_tiny(const Vec3& p);

/// Sign of (b - a) x (c - a) . (d - a): +1 when d lies on the side that the triangle's normal (counter-clockwise rule)
/// points to, -1 on the other side, 0 in the plane (or when a, b, c are collinear).
[[nodiscard]] int orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// The value whose sign orient3d gives, six times the signed volume, with a relative error below 2^-90 (exactly 0 when
/// 0).
[[nodiscard]] DoubleDouble orient3d_value(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// True when a, b and c are exactly collinear (coincident points included).
[[nodiscard]] bool are_collinear(const Vec3& a, const Vec3& b, const Vec3& c);

/// True when the closed segment [p, q] and the closed triangle (a, b, c) have a point in common. Exact in every case:
/// coplanar segments, a segment that is a point, triangles that are a segment or a point.
[[nodiscard]] bool segment_meets_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// True when p lies on the closed triangle. Exact.
[[nodiscard]] bool point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Fraction t in [0, 1] at which p + t (q - p) crosses the plane of (a, b, c), for p and q whose exact orientations
/// differ (not both zero). The result is within 2 ulp of the exact rational, whatever the triangle's shape.
[[nodiscard]] double crossing_fraction(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c);

/// Unit normal of (a, b, c) by the counter-clockwise rule. Every component is within 2^-51 of the exact one, also for
/// slender triangles (the cross product is recomputed in higher precision when it cancels); an axis-aligned triangle
/// gives exactly an axis. The triangle must not be degenerate.
[[nodiscard]] Vec3 unit_normal(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace ricochet
