/// \file
/// Polynomials in time and their real roots. The polynomials describe distances of a moving point from points, lines
/// and planes.
///
/// A squared distance along a cubic path has degree 6. Coefficients are double-doubles, so that a difference of squares
/// (distance^2 - radius^2) stays accurate near zero. Roots are isolated by the sign variations of the Bernstein
/// coefficients. If these are inconclusive, the interval is cut at the roots of the derivative. Newton's method refines
/// each root inside its bracket. Degrees 1 and 2 have closed forms. Sources and error bounds: docs/exactness.md.
///
/// A pair of roots may be missed if the polynomial stays below B = 2^-76 * sum |c_k| duration^k between them. The
/// computing time is bounded, and no heap memory is used.
#pragma once

#include <array>

#include "ricochet/core/double_double.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// A polynomial p(s) = sum of coefficients[k] s^k on [0, duration]. s and duration are in seconds.
struct Polynomial {
    static constexpr int kLargestDegree = 6;

    std::array<DoubleDouble, kLargestDegree + 1> coefficients{};  ///< ascending; zero above the degree
    int degree = 0;                                               ///< 0 to 6; the leading coefficient may be zero
    double duration = 0.0;                                        ///< in s, >= 0

    /// Returns the value with an error below 2^-99 * sum |c_k| s^k.
    [[nodiscard]] DoubleDouble value(double s) const;
    /// Returns dp/ds in plain doubles.
    [[nodiscard]] double slope(double s) const;
    [[nodiscard]] Polynomial derivative() const;
};

/// Times in ascending order: roots, or the ends of pieces between them.
struct Times {
    std::array<double, Polynomial::kLargestDegree + 2> time{};
    int count = 0;

    void append(double s) { time[static_cast<std::size_t>(count++)] = s; }
    [[nodiscard]] const double* begin() const { return time.data(); }
    [[nodiscard]] const double* end() const { return time.data() + count; }
    double operator[](int i) const { return time[static_cast<std::size_t>(i)]; }
};

/// Returns every time inside (0, duration) at which p changes sign. Each time is within two ulp of a root of the given
/// coefficients. For a multiple root, |p| at the time is below 2^-97 sum |c_k| duration^k instead. Times at which p
/// only touches zero are not included, and a zero polynomial has none.
[[nodiscard]] Times sign_changes(const Polynomial& p);

/// Returns every time in (from, to] at which p falls from positive values to zero or touches zero, for the rounded
/// coefficients. Requires 0 <= from <= to <= duration. The bits of a time do not depend on `from` and `to`.
[[nodiscard]] Times down_crossings(const Polynomial& p, double from, double to);

/// Returns true if p is certainly positive on [0, to], by Bernstein coefficients in plain doubles. False is
/// inconclusive.
[[nodiscard]] bool is_certainly_positive(const Polynomial& p, double to);

/// A vector of doubles, for culling, or of double-doubles, for decisions. With double-doubles, |w|^2 - r^2 has an error
/// of about 2^-100 |w|^2.
template <class Scalar>
struct VectorOf {
    Scalar x{};
    Scalar y{};
    Scalar z{};
};
using PreciseVec3 = VectorOf<DoubleDouble>;

/// Returns p - q. Exact for double-doubles.
template <class Scalar>
[[nodiscard]] VectorOf<Scalar> difference(const Vec3& p, const Vec3& q) {
    return {difference_as<Scalar>(p.x, q.x), difference_as<Scalar>(p.y, q.y), difference_as<Scalar>(p.z, q.z)};
}

template <class Scalar>
[[nodiscard]] Scalar dot_of(const Vec3& u, const Vec3& v) {
    return product_as<Scalar>(u.x, v.x) + product_as<Scalar>(u.y, v.y) + product_as<Scalar>(u.z, v.z);
}
template <class Scalar, class Other>
[[nodiscard]] Scalar dot_of(const VectorOf<Scalar>& u, const Other& v) {
    return u.x * v.x + u.y * v.y + u.z * v.z;
}

template <class Scalar>
[[nodiscard]] VectorOf<Scalar> operator+(const VectorOf<Scalar>& u, const VectorOf<Scalar>& v) {
    return {u.x + v.x, u.y + v.y, u.z + v.z};
}
template <class Scalar>
[[nodiscard]] VectorOf<Scalar> operator-(const VectorOf<Scalar>& u, const VectorOf<Scalar>& v) {
    return {u.x - v.x, u.y - v.y, u.z - v.z};
}
template <class Factor, class Scalar>
[[nodiscard]] VectorOf<Scalar> operator*(const Factor& s, const VectorOf<Scalar>& u) {
    return {u.x * s, u.y * s, u.z * s};
}
[[nodiscard]] inline PreciseVec3 cross_of(const PreciseVec3& u, const PreciseVec3& v) {
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}
template <class Scalar>
[[nodiscard]] Vec3 rounded(const VectorOf<Scalar>& u) {
    return {high(u.x), high(u.y), high(u.z)};
}

/// Coefficients of ascending powers. Coefficients above the degree are zero.
template <class Scalar>
using Coefficients = std::array<Scalar, Polynomial::kLargestDegree + 1>;

/// Returns the part of |w(s)|^2 that does not depend on the point a, for a path p and w(s) = p(s) - a.
template <class Scalar>
[[nodiscard]] Coefficients<Scalar> squared_displacement(const Path& path) {
    Coefficients<Scalar> q{};
    q[2] = dot_of<Scalar>(path.c[1], path.c[1]);
    if (path.degree < 2) return q;
    q[3] = dot_of<Scalar>(path.c[1], path.c[2]) * 2.0;
    q[4] = dot_of<Scalar>(path.c[2], path.c[2]);
    if (path.degree < 3) return q;
    q[4] = q[4] + dot_of<Scalar>(path.c[1], path.c[3]) * 2.0;
    q[5] = dot_of<Scalar>(path.c[2], path.c[3]) * 2.0;
    q[6] = dot_of<Scalar>(path.c[3], path.c[3]);
    return q;
}

/// Returns |w|^2 - radius^2. q: from squared_displacement(). start: w(0).
template <class Scalar>
[[nodiscard]] Coefficients<Scalar> point_clearance(const Path& path, Coefficients<Scalar> q,
                                                   const VectorOf<Scalar>& start, double radius) {
    q[0] = dot_of(start, start) - product_as<Scalar>(radius, radius);
    for (int k = 1; k <= path.degree; ++k) {
        const auto i = static_cast<std::size_t>(k);
        q[i] = q[i] + dot_of(start, path.c[i]) * 2.0;
    }
    return q;
}

/// Returns the scalar product of w with a fixed vector: the height above a plane or the position along a line.
template <class Scalar, class Direction>
[[nodiscard]] std::array<Scalar, 4> component_along(const Path& path, const VectorOf<Scalar>& start,
                                                    const Direction& direction) {
    std::array<Scalar, 4> m{};
    m[0] = dot_of(start, direction);
    for (std::size_t k = 1; k <= static_cast<std::size_t>(path.degree); ++k) {
        if constexpr (std::is_same_v<Direction, Vec3>) {
            m[k] = dot_of<Scalar>(direction, path.c[k]);
        } else {
            m[k] = dot_of(direction, path.c[k]);
        }
    }
    return m;
}

/// Returns q - m^2: the squared distance from a line. q: squared distance from a point of the line. m: component along
/// the line.
template <class Scalar>
[[nodiscard]] Coefficients<Scalar> line_clearance(Coefficients<Scalar> q, const std::array<Scalar, 4>& m, int degree) {
    for (std::size_t i = 0; i <= static_cast<std::size_t>(degree); ++i) {
        q[2 * i] = q[2 * i] - m[i] * m[i];
        for (std::size_t j = i + 1; j <= static_cast<std::size_t>(degree); ++j) {
            q[i + j] = q[i + j] - m[i] * m[j] * 2.0;
        }
    }
    return q;
}

}  // namespace ricochet
