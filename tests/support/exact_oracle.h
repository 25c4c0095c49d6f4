/// \file
/// Slow, exact reference answers for the predicates: integers and rationals of any length, and for the intersection a
/// method that shares nothing with the library's (linear equations and inequalities instead of orientations).
#pragma once

#include <array>
#include <boost/multiprecision/cpp_int.hpp>

#include "ricochet/core/double_double.h"
#include "ricochet/core/vec3.h"

namespace ricochet::testing {

using Rational = boost::multiprecision::cpp_rational;

/// The double as a rational number.
[[nodiscard]] Rational exact(double x);
/// hi + lo as a rational number.
[[nodiscard]] Rational exact(const DoubleDouble& x);

/// (b - a) x (c - a) . (d - a), by the homogeneous 4 x 4 determinant.
[[nodiscard]] Rational exact_orient3d(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

/// Twice the area vector (b - a) x (c - a).
[[nodiscard]] std::array<Rational, 3> exact_area_vector(const Vec3& a, const Vec3& b, const Vec3& c);

/// Whether some t in [0, 1] and some barycentric coordinates in the triangle give the same point: the three linear
/// equations are eliminated, the inequalities that remain are decided by Fourier-Motzkin elimination. No case is
/// special.
[[nodiscard]] bool exact_segment_intersects_triangle(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                                     const Vec3& c);

/// Fraction of [p, q] at which the plane of (a, b, c) is crossed; the orientations of p and q must differ.
[[nodiscard]] Rational exact_crossing_fraction(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b,
                                               const Vec3& c);

/// Largest error of a component of `normal` as the unit normal of (a, b, c), against 100 decimal digits.
[[nodiscard]] double unit_normal_error(const Vec3& normal, const Vec3& a, const Vec3& b, const Vec3& c);

/// |value - reference| in units in the last place of the double nearest to the reference.
[[nodiscard]] double ulps_between(double value, const Rational& reference);

/// |value - reference| / |reference|; 0 when both are 0.
[[nodiscard]] double relative_error(const DoubleDouble& value, const Rational& reference);

/// -1, 0 or +1.
[[nodiscard]] int sign_of(const Rational& x);

}  // namespace ricochet::testing
