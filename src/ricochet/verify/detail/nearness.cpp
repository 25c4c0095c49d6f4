#include "ricochet/verify/detail/nearness.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstddef>

namespace ricochet::verify {
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
