#include "support/sphere_oracle.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace ricochet::testing {
namespace {

template <class T>
using VecOf = std::array<T, 3>;

template <class T>
VecOf<T> minus(const VecOf<T>& u, const VecOf<T>& v) {
    return {T(u[0] - v[0]), T(u[1] - v[1]), T(u[2] - v[2])};
}

template <class T>
T inner(const VecOf<T>& u, const VecOf<T>& v) {
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
}

template <class T>
VecOf<T> along(const VecOf<T>& a, const VecOf<T>& d, const T& fraction) {
    return {T(a[0] + fraction * d[0]), T(a[1] + fraction * d[1]), T(a[2] + fraction * d[2])};
}

template <class T>
VecOf<T> nearest_on_segment(const VecOf<T>& p, const VecOf<T>& a, const VecOf<T>& b) {
    const VecOf<T> d = minus(b, a);
    const T squared = inner(d, d);
    if (squared == 0) return a;
    T fraction = inner(minus(p, a), d) / squared;
    if (fraction < 0) fraction = 0;
    if (fraction > 1) fraction = 1;
    return along(a, d, fraction);
}

template <class T>
VecOf<T> nearest_on_triangle(const VecOf<T>& p, const std::array<VecOf<T>, 3>& t) {
    VecOf<T> best = t[0];
    const auto squared_to = [&](const VecOf<T>& q) {
        const VecOf<T> offset = minus(p, q);
        return inner(offset, offset);
    };
    const auto consider = [&](const VecOf<T>& q) {
        if (squared_to(q) < squared_to(best)) best = q;
    };
    for (std::size_t i = 0; i < 3; ++i) consider(nearest_on_segment(p, t[i], t[(i + 1) % 3]));
    const VecOf<T> u = minus(t[1], t[0]);
    const VecOf<T> v = minus(t[2], t[0]);
    const VecOf<T> w = minus(p, t[0]);
    const T uu = inner(u, u), uv = inner(u, v), vv = inner(v, v);
    const T determinant = uu * vv - uv * uv;
    if (determinant <= 0) return best;
    const T wu = inner(w, u), wv = inner(w, v);
    const T x = (wu * vv - wv * uv) / determinant;
    const T y = (wv * uu - wu * uv) / determinant;
    if (x >= 0 && y >= 0 && x + y <= 1) consider(along(along(t[0], u, x), v, y));
    return best;
}

template <class T>
VecOf<T> converted(const Vec3& v) {
    return {T(v.x), T(v.y), T(v.z)};
}

template <class T>
VecOf<T> position_at(const Path& path, const T& s) {
    VecOf<T> p = converted<T>(path.c[3]);
    for (std::size_t k = 3; k-- > 0;) {
        const VecOf<T> c = converted<T>(path.c[k]);
        for (std::size_t i = 0; i < 3; ++i) p[i] = p[i] * s + c[i];
    }
    return p;
}

/// Distance of the path from the triangle minus the radius, as a function of s, in any number type.
template <class T>
class Clearance {
public:
    Clearance(const Path& path, double radius, const Triangle& triangle)
        : path_(path),
          radius_(radius),
          triangle_{converted<T>(triangle[0]), converted<T>(triangle[1]), converted<T>(triangle[2])} {}

    T operator()(const T& s) const {
        using std::sqrt;
        const VecOf<T> p = position_at(path_, s);
        const VecOf<T> offset = minus(p, nearest_on_triangle(p, triangle_));
        return T(sqrt(inner(offset, offset))) - radius_;
    }

private:
    const Path& path_;
    T radius_;
    std::array<VecOf<T>, 3> triangle_;
};

using Interval = std::array<double, 2>;

/// Appends the parts of [from, to] in which the bound on the speed does not exclude contact. Adjacent parts are joined.
void collect_doubtful(const Clearance<long double>& clearance, double speed, double slack, double smallest, double from,
                      double to, std::vector<Interval>& doubtful) {
    const double middle = 0.5 * (from + to);
    if (static_cast<double>(clearance(middle)) > speed * 0.5 * (to - from) + slack) return;
    if (to - from <= smallest) {
        if (!doubtful.empty() && doubtful.back()[1] == from) {
            doubtful.back()[1] = to;
        } else {
            doubtful.push_back({from, to});
        }
        return;
    }
    collect_doubtful(clearance, speed, slack, smallest, from, middle, doubtful);
    // Later intervals do not matter if the sphere certainly overlaps at the end of the last interval.
    if (!doubtful.empty() && static_cast<double>(clearance(doubtful.back()[1])) < -slack) return;
    collect_doubtful(clearance, speed, slack, smallest, middle, to, doubtful);
}

/// Returns the time of the only minimum in [low, high], by ternary search.
Digits time_of_minimum(const Clearance<Digits>& clearance, Digits low, Digits high) {
    const Digits enough = (high - low) * 1e-14;  // the error of the minimum's value is of second order in this length
    while (high - low > enough) {
        const Digits third = (high - low) / 3;
        if (clearance(low + third) <= clearance(high - third)) {
            high -= third;
        } else {
            low += third;
        }
    }
    return (low + high) / 2;
}

/// Returns the root between a time without overlap and a time with overlap, by the Illinois variant of false position.
Digits crossing(const Clearance<Digits>& clearance, Digits clear, Digits hit) {
    Digits at_clear = clearance(clear);
    Digits at_hit = clearance(hit);
    int side = 0;
    for (int i = 0; i < 200 && abs(hit - clear) > Digits(1e-30) * abs(hit) && at_hit != 0; ++i) {
        const Digits s = (clear * at_hit - hit * at_clear) / (at_hit - at_clear);
        const Digits value = clearance(s);
        if (value > 0) {
            clear = s;
            at_clear = value;
            if (side == 1) at_hit /= 2;
            side = 1;
        } else {
            hit = s;
            at_hit = value;
            if (side == -1) at_clear /= 2;
            side = -1;
            if (value == 0) break;
        }
    }
    return hit;
}

}  // namespace

DigitsVec3 digits(const Vec3& v) { return converted<Digits>(v); }
DigitsVec3 difference(const DigitsVec3& u, const DigitsVec3& v) { return minus(u, v); }
Digits length(const DigitsVec3& v) { return sqrt(inner(v, v)); }
DigitsVec3 position(const Path& path, const Digits& s) { return position_at(path, s); }

DigitsVec3 nearest_point(const DigitsVec3& p, const Triangle& triangle) {
    return nearest_on_triangle<Digits>(p, {digits(triangle[0]), digits(triangle[1]), digits(triangle[2])});
}

Digits distance(const DigitsVec3& p, const Triangle& triangle) { return length(minus(p, nearest_point(p, triangle))); }

OracleContact first_contact(const Path& path, double radius, const Triangle& triangle) {
    const double h = path.duration;
    const double speed =
        ricochet::length(path.c[1]) + h * (2.0 * ricochet::length(path.c[2]) + 3.0 * h * ricochet::length(path.c[3]));
    const Clearance<long double> rough(path, radius, triangle);
    const Clearance<Digits> clearance(path, radius, triangle);
    std::vector<Interval> doubtful;
    double coordinates = max_abs(path.c[0]) + speed * h + radius;
    for (const Vec3& corner : triangle) coordinates = std::max(coordinates, max_abs(corner));
    collect_doubtful(rough, speed, 1e-13 * coordinates, h * 0x1p-20, 0.0, h, doubtful);
    OracleContact result;
    result.margin = coordinates;
    for (const Interval& interval : doubtful) {
        const Digits low = interval[0];
        const Digits high = interval[1];
        const bool ends_in_overlap = clearance(high) <= 0;
        const Digits deepest = ends_in_overlap ? high : time_of_minimum(clearance, low, high);
        const Digits least = clearance(deepest);
        result.margin = std::min(result.margin, Digits(abs(least)));
        if (least <= 0) {
            result.time = crossing(clearance, low, deepest);
            return result;
        }
    }
    return result;
}

}  // namespace ricochet::testing
