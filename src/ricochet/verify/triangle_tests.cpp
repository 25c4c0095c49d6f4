#include "ricochet/verify/triangle_tests.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "ricochet/verify/wide_vector.h"

namespace ricochet::verify {

namespace {

/// Error bound of a determinant, relative to the sum of the magnitudes of its terms. Each term undergoes at most 8
/// roundings of half an epsilon, and so does the sum of the magnitudes. The bound of 8 epsilon is therefore about twice
/// the largest possible error.
template <class Real>
constexpr Real kFilter = 8 * std::numeric_limits<Real>::epsilon();

/// Smallest error bound at which the filter decides. Below this value, products may have underflowed to zero. Local: a
/// limit from the range of doubles.
constexpr double kSmallestBound = 0x1p-950;

/// Returns the sign of the value, +1 or -1, if it is certain. Returns 0 if it is not certain, or after an overflow.
template <class Real>
int certain_sign(Real value, Real magnitude) {
    const Real bound = kFilter<Real> * magnitude;
    if (!(bound > static_cast<Real>(kSmallestBound)) || !(bound < std::numeric_limits<Real>::infinity())) return 0;
    return static_cast<int>(value > bound) - static_cast<int>(value < -bound);
}

template <class Real>
int filtered_spatial_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    const Vector<Real> u = difference<Real>(b, a), v = difference<Real>(c, a), w = difference<Real>(p, a);
    Real value = 0;
    Real magnitude = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        const Real plus = u[j] * v[k], minus = u[k] * v[j];
        value += (plus - minus) * w[i];
        magnitude += (std::fabs(plus) + std::fabs(minus)) * std::fabs(w[i]);
    }
    return certain_sign(value, magnitude);
}

// Small integers have a fixed size, so they need no heap memory. Larger values use integers of unlimited size.
using SmallInteger = boost::multiprecision::int512_t;
using LargeInteger = boost::multiprecision::cpp_int;
constexpr int kSmallBits = 500;

/// Range of exponents of some coordinates. Multiplication of all coordinates by one power of two turns them into
/// integers.
struct Scale {
    int lowest = std::numeric_limits<int>::max();      ///< exponent of the last bit of the smallest coordinate
    int highest = std::numeric_limits<int>::lowest();  ///< exponent of the largest coordinate

    template <class... Points>
    explicit Scale(const Points&... points) {
        (include(points), ...);
    }
    void include(const Vec3& p) {
        for (int axis = 0; axis < 3; ++axis) {
            if (p[axis] == 0.0) continue;
            const int exponent = std::ilogb(p[axis]) + 1;
            lowest = std::min(lowest, exponent - 53);
            highest = std::max(highest, exponent);
        }
    }
    /// Returns true if sums of products of `factors` coordinate differences fit into small integers.
    [[nodiscard]] bool is_small(int factors) const {
        return highest < lowest || factors * (highest - lowest + 2) + 4 <= kSmallBits;
    }
};

template <class Integer>
Integer whole(double x, const Scale& scale) {
    if (x == 0.0) return 0;
    int exponent = 0;
    const double fraction = std::frexp(x, &exponent);
    const Integer mantissa = static_cast<std::int64_t>(std::ldexp(fraction, 53));
    return Integer(mantissa << static_cast<unsigned>(exponent - 53 - scale.lowest));
}

template <class Integer>
Vector<Integer> whole_between(const Vec3& from, const Vec3& to, const Scale& scale) {
    Vector<Integer> difference;
    for (int axis = 0; axis < 3; ++axis) {
        difference[static_cast<std::size_t>(axis)] =
            whole<Integer>(to[axis], scale) - whole<Integer>(from[axis], scale);
    }
    return difference;
}

template <class Integer>
int exact_spatial_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p, const Scale& scale) {
    const auto u = whole_between<Integer>(a, b, scale);
    const auto v = whole_between<Integer>(a, c, scale);
    const auto w = whole_between<Integer>(a, p, scale);
    return product(across(u, v), w).sign();
}

template <class Integer>
int exact_planar_sign(std::size_t u, std::size_t v, const Vec3& a, const Vec3& b, const Vec3& p, const Scale& scale) {
    const auto ab = whole_between<Integer>(a, b, scale);
    const auto ap = whole_between<Integer>(a, p, scale);
    return Integer(ab[u] * ap[v] - ab[v] * ap[u]).sign();
}

/// Returns the sign of n . (p - point) in exact arithmetic. The normal has its own scale, because its exponents are
/// unrelated to those of positions.
int exact_height_sign(const Vec3& n, const Vec3& point, const Vec3& p) {
    const Scale of_normal(n), of_places(point, p);
    const auto difference = whole_between<LargeInteger>(point, p, of_places);
    LargeInteger sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        sum += whole<LargeInteger>(n[axis], of_normal) * difference[static_cast<std::size_t>(axis)];
    }
    return sum.sign();
}

}  // namespace

int spatial_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    if (const int sign = filtered_spatial_sign<double>(a, b, c, p); sign != 0) return sign;
    if (const int sign = filtered_spatial_sign<long double>(a, b, c, p); sign != 0) return sign;
    const Scale scale(a, b, c, p);
    return scale.is_small(3) ? exact_spatial_sign<SmallInteger>(a, b, c, p, scale)
                             : exact_spatial_sign<LargeInteger>(a, b, c, p, scale);
}

int planar_sign(int u, int v, const Vec3& a, const Vec3& b, const Vec3& p) {
    const double first = (b[u] - a[u]) * (p[v] - a[v]);
    const double second = (b[v] - a[v]) * (p[u] - a[u]);
    if (const int sign = certain_sign(first - second, std::fabs(first) + std::fabs(second)); sign != 0) return sign;
    // The difference of two different doubles is never rounded to zero. Axis-parallel edges therefore need no integers.
    if ((b[u] == a[u] || p[v] == a[v]) && (b[v] == a[v] || p[u] == a[u])) return 0;
    const Scale scale(a, b, p);
    const auto i = static_cast<std::size_t>(u), j = static_cast<std::size_t>(v);
    return scale.is_small(2) ? exact_planar_sign<SmallInteger>(i, j, a, b, p, scale)
                             : exact_planar_sign<LargeInteger>(i, j, a, b, p, scale);
}

int height_sign(const Vec3& n, const Vec3& point, const Vec3& p) {
    const Vec3 w = p - point;
    const int sign = certain_sign(dot(n, w), dot(abs(n), abs(w)));
    return sign != 0 ? sign : exact_height_sign(n, point, p);
}

bool on_one_line(const Vec3& a, const Vec3& b, const Vec3& c) {
    return planar_sign(0, 1, a, b, c) == 0 && planar_sign(1, 2, a, b, c) == 0 && planar_sign(2, 0, a, b, c) == 0;
}

namespace {

/// Returns true if a segment and a triangle in the same plane intersect. Both are projected onto the first coordinate
/// plane in which the triangle has an area. Two convex figures are apart if the line through a side of one figure
/// strictly separates them.
bool meets_in_plane(const Vec3& p, const Vec3& q, const Corners& t) {
    constexpr std::array<std::array<int, 2>, 3> kViews{{{0, 1}, {1, 2}, {2, 0}}};
    for (const auto& [u, v] : kViews) {
        const int area = planar_sign(u, v, t.a, t.b, t.c);
        if (area == 0) continue;
        const auto is_beyond = [&, u = u, v = v](const Vec3& from, const Vec3& to) {
            return planar_sign(u, v, from, to, p) * area < 0 && planar_sign(u, v, from, to, q) * area < 0;
        };
        if (is_beyond(t.a, t.b) || is_beyond(t.b, t.c) || is_beyond(t.c, t.a)) return false;
        const int of_a = planar_sign(u, v, p, q, t.a);
        const bool is_beside =
            of_a != 0 && planar_sign(u, v, p, q, t.b) == of_a && planar_sign(u, v, p, q, t.c) == of_a;
        return !is_beside;
    }
    return false;  // the triangle has no area
}

/// Returns true if the line through p and q has the same orientation relative to all three sides, so that it passes
/// through the triangle. The line must cross the triangle's plane in one point.
bool passes_through(const Vec3& p, const Vec3& q, const Corners& t) {
    const int ab = spatial_sign(p, q, t.a, t.b);
    const int bc = spatial_sign(p, q, t.b, t.c);
    if (ab * bc < 0) return false;
    const int ca = spatial_sign(p, q, t.c, t.a);
    return ab * ca >= 0 && bc * ca >= 0;
}

}  // namespace

bool intersects(const Vec3& p, const Vec3& q, const Corners& t) {
    const int of_p = spatial_sign(t.a, t.b, t.c, p);
    const int of_q = spatial_sign(t.a, t.b, t.c, q);
    if (of_p * of_q > 0) return false;
    return of_p == 0 && of_q == 0 ? meets_in_plane(p, q, t) : passes_through(p, q, t);
}

bool intersects_after_start(const Vec3& p, const Vec3& q, const Corners& t) {
    const bool leaves_plane = spatial_sign(t.a, t.b, t.c, p) == 0 && spatial_sign(t.a, t.b, t.c, q) != 0;
    return !leaves_plane && intersects(p, q, t);
}

Vec3 crossing_point(const Vec3& p, const Vec3& q, const Corners& t) {
    const Vec3 normal = cross(t.b - t.a, t.c - t.a);
    const double from = std::fabs(dot(normal, p - t.a));
    const double to = std::fabs(dot(normal, q - t.a));
    const double part = from / (from + to);
    return std::isfinite(part) ? p + std::clamp(part, 0.0, 1.0) * (q - p) : p;
}

namespace {

/// Error bound of a scalar product of rounded differences, relative to the product of both lengths. It covers about 5
/// roundings of 2^-53. Local: an error bound of the formulas in this file.
constexpr double kProductError = 0x1p-49;

/// Returns the offset to p from the nearest point of the triangle. This is the shortest of the offsets from the three
/// sides and from the plane. The plane is used only if its point nearest to p lies on the triangle.
template <class Real>
Vector<Real> offset_from(const Vec3& p, const Corners& t) {
    Vector<Real> best = difference<Real>(p, t.a);
    Real least = product(best, best);
    const auto consider = [&](const Vector<Real>& offset) {
        const Real square = product(offset, offset);
        if (!(square < least)) return;
        least = square;
        best = offset;
    };
    const auto consider_side = [&](const Vec3& from, const Vec3& to) {
        const Vector<Real> side = difference<Real>(to, from);
        const Vector<Real> offset = difference<Real>(p, from);
        const Real part = product(offset, side) / product(side, side);
        consider(less(offset, times(std::clamp<Real>(part, Real(0), Real(1)), side)));
    };
    consider_side(t.a, t.b);
    consider_side(t.b, t.c);
    consider_side(t.c, t.a);
    const Vector<Real> u = difference<Real>(t.b, t.a), v = difference<Real>(t.c, t.a), w = difference<Real>(p, t.a);
    const Real uu = product(u, u), uv = product(u, v), vv = product(v, v), wu = product(w, u), wv = product(w, v);
    const Real determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return best;
    const Real x = (wu * vv - wv * uv) / determinant;
    const Real y = (wv * uu - wu * uv) / determinant;
    if (x >= 0 && y >= 0 && x + y <= 1) consider(less(less(w, times(x, u)), times(y, v)));
    return best;
}

/// Returns true if doubles prove that the distance of p from the triangle is at least `least`. If the whole triangle is
/// behind a plane, the distance of p from the triangle is at least its distance from the plane. This is true for any
/// direction of the plane's normal. The direction used here may therefore differ slightly from the direction of the
/// nearest point.
bool is_certainly_clear(const Vec3& p, const Corners& t, double least) {
    const Vector<double> offset = offset_from<double>(p, t);
    const Vec3 direction{offset[0], offset[1], offset[2]};
    const double size = length(direction);
    if (!(size > 0.0)) return false;
    const auto height = [&](const Vec3& corner) {
        const Vec3 w = p - corner;
        return dot(direction, w) - kProductError * size * length(w);
    };
    return std::min({height(t.a), height(t.b), height(t.c)}) >= (1.0 + kProductError) * size * least;
}

using Digits = boost::multiprecision::cpp_bin_float_100;

}  // namespace

bool is_nearer(const Vec3& p, const Corners& t, double least) {
    if (is_certainly_clear(p, t, least)) return false;
    const Vector<Digits> offset = offset_from<Digits>(p, t);
    return product(offset, offset) < Digits(least) * least;
}

bool is_nearer(const Vec3& p, const Vec3& point, const Vec3& normal, double least) {
    const Vec3 w = p - point;
    const double size = length(normal);
    if (std::fabs(dot(normal, w)) - kProductError * size * length(w) >= (1.0 + kProductError) * size * least) {
        return false;
    }
    const Vector<Digits> n = difference<Digits>(normal, Vec3{});
    const Digits height = product(n, difference<Digits>(p, point));
    return height * height < product(n, n) * Digits(least) * least;
}

}  // namespace ricochet::verify
