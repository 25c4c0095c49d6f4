#include "support/shape_oracle.h"

#include <algorithm>
#include <vector>

namespace ricochet::testing {
namespace {

constexpr int kHalvings = 40;
constexpr int kMostSteps = 60;  // largest number of steps of Newton's method, which converges from below

Real square(const Real& x) { return x * x; }

RealVector scaled(const Real& s, const RealVector& v) { return {s * v[0], s * v[1], s * v[2]}; }

RealVector unit(const RealVector& v) { return scaled(1 / length(v), v); }

RealVector cross(const RealVector& u, const RealVector& v) {
    return {u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
}

RealVector column(const AffineMap& map, int i) { return real({map.row_x[i], map.row_y[i], map.row_z[i]}); }

void make_equal(std::array<double, 3>& half, std::size_t count) {
    std::vector<double> sorted(half.begin(), half.begin() + static_cast<std::ptrdiff_t>(count));
    std::sort(sorted.begin(), sorted.end());
    if (sorted.back() - sorted.front() <= 0x1p-49 * sorted.front()) std::fill_n(half.begin(), count, sorted[1]);
}

}  // namespace

RealVector real(const Vec3& v) { return {Real(v.x), Real(v.y), Real(v.z)}; }
Real dot(const RealVector& u, const RealVector& v) { return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]; }
Real length(const RealVector& v) { return sqrt(dot(v, v)); }
RealVector sum(const RealVector& u, const Real& s, const RealVector& v) {
    return {u[0] + s * v[0], u[1] + s * v[1], u[2] + s * v[2]};
}

RealVector position(const Path& path, const Real& s) {
    RealVector p = real(path.c[3]);
    for (std::size_t k = 3; k-- > 0;) p = sum(real(path.c[k]), s, p);
    return p;
}

ShapeOracle::ShapeOracle(const AffineMap& world_from_local, bool is_capped)
    : center_(real(world_from_local.translation)), round_axes_(is_capped ? 2 : 3) {
    for (int i = 0; i < 3; ++i)
        half_[static_cast<std::size_t>(i)] = static_cast<double>(length(column(world_from_local, i)));
    make_equal(half_, round_axes_);
    const RealVector second = column(world_from_local, 1);
    axes_[0] = unit(column(world_from_local, 0));
    axes_[1] = unit(sum(second, -dot(second, axes_[0]), axes_[0]));
    axes_[2] = cross(axes_[0], axes_[1]);
}

RealVector ShapeOracle::local(const RealVector& p) const {
    const RealVector w = sum(p, Real(-1), center_);
    return {dot(axes_[0], w), dot(axes_[1], w), dot(axes_[2], w)};
}

RealVector ShapeOracle::world(const RealVector& local) const {
    return sum(sum(sum(center_, local[0], axes_[0]), local[1], axes_[1]), local[2], axes_[2]);
}

Real ShapeOracle::form(const RealVector& y) const {
    Real value = -1;
    for (std::size_t i = 0; i < round_axes_; ++i) value += square(y[i] / half_[i]);
    return value;
}

Real ShapeOracle::value(const RealVector& p) const {
    const RealVector y = local(p);
    if (round_axes_ == 3) return form(y);
    const Real over_cap = abs(y[2]) / half_[2] - 1;
    return std::max(form(y), over_cap);
}

/// Let t be the largest root of sum (a y / (a^2 + t))^2 = 1, over the half axes a. The nearest point is then y a^2 /
/// (a^2 + t). If the sum is below 1 for all t down to -smallest^2, the given point is on the medial axis.
ShapeOracle::Nearest ShapeOracle::nearest_around(const RealVector& y) const {
    const auto end = half_.begin() + static_cast<std::ptrdiff_t>(round_axes_);
    const std::size_t smallest = static_cast<std::size_t>(std::min_element(half_.begin(), end) - half_.begin());
    const Real smallest_square = square(Real(half_[smallest]));
    Real reach = 0;
    for (std::size_t i = 0; i < round_axes_; ++i) reach += square(y[i] * half_[i]);
    // The variable is u = t + smallest^2 > 0, because u keeps its digits near 0.
    const auto point_at = [&](const Real& u) {
        RealVector point = y;
        for (std::size_t i = 0; i < round_axes_; ++i) {
            const Real a2 = square(Real(half_[i]));
            point[i] = y[i] == 0 ? Real(0) : Real(y[i] * a2 / (a2 - smallest_square + u));
        }
        return point;
    };
    Real low = 0;
    for (std::size_t i = 0; i < round_axes_; ++i) {
        low = std::max(low, Real(abs(y[i]) * half_[i] - (square(Real(half_[i])) - smallest_square)));
    }
    Real high = sqrt(reach) + smallest_square;
    for (int k = 0; k < kHalvings; ++k) {
        const Real middle = (low + high) / 2;
        (form(point_at(middle)) > 0 ? low : high) = middle;
    }
    for (int k = 0; k < kMostSteps; ++k) {
        const RealVector point = point_at(low);
        Real slope = 0;
        for (std::size_t i = 0; i < round_axes_; ++i) {
            const Real a2 = square(Real(half_[i]));
            if (y[i] != 0) slope += 2 * square(point[i]) / a2 / (a2 - smallest_square + low);
        }
        const Real next = slope == 0 ? low : Real(low + form(point) / slope);
        if (next <= low) break;
        low = next;
    }
    RealVector point = point_at(low);
    const Real rest = -form(point);
    if (rest > Real("1e-30"))
        point[smallest] = half_[smallest] * sqrt(rest + square(point[smallest] / half_[smallest]));
    RealVector gradient{0, 0, 0};
    for (std::size_t i = 0; i < round_axes_; ++i) gradient[i] = point[i] / square(Real(half_[i]));
    return {(low - smallest_square) * length(gradient), unit(gradient)};
}

ShapeOracle::Nearest ShapeOracle::nearest(const RealVector& p) const {
    const RealVector y = local(p);
    Nearest near = nearest_around(y);
    if (round_axes_ == 2) {
        const int up = y[2] < 0 ? -1 : 1;
        const Real height = abs(y[2]) - half_[2];
        if (near.distance > 0 && height > 0) {
            const Real distance = sqrt(square(near.distance) + square(height));
            near = {distance, sum(scaled(near.distance / distance, near.normal), up * height / distance, {0, 0, 1})};
        } else if (height > near.distance) {
            near = {height, {0, 0, Real(up)}};
        }
    }
    const RealVector& n = near.normal;
    return {near.distance, sum(sum(scaled(n[0], axes_[0]), n[1], axes_[1]), n[2], axes_[2])};
}

bool ShapeOracle::intersects(const RealVector& p, const RealVector& q) const {
    const Real at_p = value(p);
    const Real at_q = value(q);
    if (at_p == 0 || at_q == 0 || (at_p > 0) != (at_q > 0)) return true;
    if (at_p < 0) return false;
    const RealVector from = local(p);
    const RealVector step = sum(local(q), Real(-1), from);
    Real low = 0;
    Real high = 1;
    for (const int up : {1, -1}) {
        if (round_axes_ == 3) break;
        const Real before = up * from[2] - half_[2];
        const Real change = up * step[2];
        if (change == 0 && before > 0) return false;
        if (change > 0) high = std::min(high, Real(-before / change));
        if (change < 0) low = std::max(low, Real(-before / change));
    }
    if (low > high) return false;
    Real slope = 0;
    Real curvature = 0;
    for (std::size_t i = 0; i < round_axes_; ++i) {
        slope += from[i] * step[i] / square(Real(half_[i]));
        curvature += square(step[i] / half_[i]);
    }
    const Real lowest = curvature == 0 ? low : Real(std::clamp(Real(-slope / curvature), low, high));
    return form(sum(from, lowest, step)) <= 0;
}

}  // namespace ricochet::testing
