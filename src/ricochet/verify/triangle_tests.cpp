#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstddef>

#include "ricochet/verify/signs.h"
#include "ricochet/verify/triangle_tests.h"

namespace ricochet::verify {

namespace {

/// Segment and triangle in one plane, seen along an axis along which the triangle has an area. Two convex figures are
/// apart when the line of a side of one of them has them strictly on different sides.
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
    return false;  // no area at all
}

/// The line through p and q, which crosses the triangle's plane in one point, passes the three sides alike.
bool passes_through(const Vec3& p, const Vec3& q, const Corners& t) {
    const int ab = spatial_sign(p, q, t.a, t.b);
    const int bc = spatial_sign(p, q, t.b, t.c);
    if (ab * bc < 0) return false;
    const int ca = spatial_sign(p, q, t.c, t.a);
    return ab * ca >= 0 && bc * ca >= 0;
}

}  // namespace

bool meets(const Vec3& p, const Vec3& q, const Corners& t) {
    const int of_p = spatial_sign(t.a, t.b, t.c, p);
    const int of_q = spatial_sign(t.a, t.b, t.c, q);
    if (of_p * of_q > 0) return false;
    return of_p == 0 && of_q == 0 ? meets_in_plane(p, q, t) : passes_through(p, q, t);
}

bool meets_after_start(const Vec3& p, const Vec3& q, const Corners& t) {
    const bool leaves_plane = spatial_sign(t.a, t.b, t.c, p) == 0 && spatial_sign(t.a, t.b, t.c, q) != 0;
    return !leaves_plane && meets(p, q, t);
}

Vec3 place_of_meeting(const Vec3& p, const Vec3& q, const Corners& t) {
    const Vec3 normal = cross(t.b - t.a, t.c - t.a);
    const double from = std::fabs(dot(normal, p - t.a));
    const double to = std::fabs(dot(normal, q - t.a));
    const double part = from / (from + to);
    return std::isfinite(part) ? p + std::clamp(part, 0.0, 1.0) * (q - p) : p;
}

namespace {

/// Error of a scalar product of rounded differences, relative to the lengths of both: some 5 roundings of 2^-53.
constexpr double kProductError = 0x1p-49;

template <class Real>
using VectorOf = std::array<Real, 3>;

template <class Real>
VectorOf<Real> difference(const Vec3& u, const Vec3& v) {
    return {Real(Real(u.x) - v.x), Real(Real(u.y) - v.y), Real(Real(u.z) - v.z)};
}

template <class Real>
VectorOf<Real> less(const VectorOf<Real>& u, const Real& part, const VectorOf<Real>& v) {
    return {Real(u[0] - part * v[0]), Real(u[1] - part * v[1]), Real(u[2] - part * v[2])};
}

template <class Real>
Real product(const VectorOf<Real>& u, const VectorOf<Real>& v) {
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

/// The way from the nearest point of the triangle to p: the shortest of those from the three sides and, when its foot
/// lies on the triangle, from the plane.
template <class Real>
VectorOf<Real> way_from(const Vec3& p, const Corners& t) {
    VectorOf<Real> best = difference<Real>(p, t.a);
    Real least = product(best, best);
    const auto consider = [&](const VectorOf<Real>& way) {
        const Real square = product(way, way);
        if (!(square < least)) return;
        least = square;
        best = way;
    };
    const auto consider_side = [&](const Vec3& from, const Vec3& to) {
        const VectorOf<Real> side = difference<Real>(to, from);
        const VectorOf<Real> way = difference<Real>(p, from);
        const Real part = product(way, side) / product(side, side);
        consider(less<Real>(way, std::clamp<Real>(part, Real(0), Real(1)), side));
    };
    consider_side(t.a, t.b);
    consider_side(t.b, t.c);
    consider_side(t.c, t.a);
    const VectorOf<Real> u = difference<Real>(t.b, t.a), v = difference<Real>(t.c, t.a), w = difference<Real>(p, t.a);
    const Real uu = product(u, u), uv = product(u, v), vv = product(v, v), wu = product(w, u), wv = product(w, v);
    const Real determinant = uu * vv - uv * uv;
    if (!(determinant > 0)) return best;
    const Real x = (wu * vv - wv * uv) / determinant;
    const Real y = (wv * uu - wu * uv) / determinant;
    if (x >= 0 && y >= 0 && x + y <= 1) consider(less<Real>(less<Real>(w, x, u), y, v));
    return best;
}

/// A plane across any direction with the whole triangle behind it separates: p is at least as far away as from the
/// plane. That holds for a direction that is only about that of the nearest point.
bool is_certainly_clear(const Vec3& p, const Corners& t, double least) {
    const VectorOf<double> way = way_from<double>(p, t);
    const Vec3 direction{way[0], way[1], way[2]};
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
    const VectorOf<Digits> way = way_from<Digits>(p, t);
    return product(way, way) < Digits(least) * least;
}

bool is_nearer(const Vec3& p, const Vec3& point, const Vec3& normal, double least) {
    const Vec3 w = p - point;
    const double size = length(normal);
    if (std::fabs(dot(normal, w)) - kProductError * size * length(w) >= (1.0 + kProductError) * size * least) {
        return false;
    }
    const VectorOf<Digits> n = difference<Digits>(normal, Vec3{});
    const Digits height = product(n, difference<Digits>(p, point));
    return height * height < product(n, n) * Digits(least) * least;
}

}  // namespace ricochet::verify
