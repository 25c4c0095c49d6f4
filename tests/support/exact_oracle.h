/// \file
/// Slow, exact oracles for the predicates, in arbitrary-precision integers and rationals. The intersection test uses
/// another method than the library. It solves linear equations and inequalities, whereas the library uses orientations.
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>

#include "ricochet/core/double_double.h"
#include "ricochet/core/vec3.h"

namespace ricochet::testing {

using Rational = boost::multiprecision::cpp_rational;

/// Returns the double as a rational number.
[[nodiscard]] Rational exact(double x);
/// Returns hi + lo as a rational number.
[[nodiscard]] Rational exact(const DoubleDouble& x);

/// Returns (b - a) x (c - a) . (d - a), computed as the homogeneous 4 x 4 determinant.
[[nodiscard]] Rational exact_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Returns twice the area vector: (b - a) x (c - a).
[[nodiscard]] std::array<Rational, 3> exact_area_vector(const Vec3& a, const Vec3& b, const Vec3& c);

/// Returns true if the segment and the triangle have a common point. The unknowns are the position on the segment and
/// the barycentric coordinates. Three linear equations are eliminated, and Fourier-Motzkin elimination decides the
/// remaining inequalities. No case needs special treatment.
[[nodiscard]] bool exact_segment_intersects_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                                     const Vec3& c);

/// Returns the fraction of the segment [p, q] at which the segment crosses the plane of (a, b, c). The orientations of
/// p and q must differ.
[[nodiscard]] Rational exact_crossing_fraction(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                               const Vec3& c);

/// Returns the largest difference of a component of `normal` from the unit normal of (a, b, c). The reference has 100
/// decimal digits.
[[nodiscard]] double unit_normal_error(const Vec3& normal, const Vec3& a, const Vec3& b, const Vec3& c);

/// Returns |value - reference| in units in the last place of the double nearest to the reference.
[[nodiscard]] double ulps_between(double value, const Rational& reference);

/// Returns |value - reference| / |reference|, or 0 if both are 0.
[[nodiscard]] double relative_error(const DoubleDouble& value, const Rational& reference);

/// Returns -1, 0 or +1.
[[nodiscard]] int sign_of(const Rational& x);

}  // namespace ricochet::testing
