#include "ricochet/verify/checked_shape.h"

#include <algorithm>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstddef>

#include "ricochet/core/box3.h"
#include "ricochet/verify/wide_vector.h"

namespace ricochet::verify {
namespace {

using Digits = boost::multiprecision::cpp_bin_float_50;

/// Largest relative difference of half axes that are treated as equal. If a map is a rotation with a uniform scale,
/// rounding changes the lengths of its columns by about 2^-52. Local: a tolerance for the rounding of input values.
constexpr double kEqualAxes = 0x1p-49;

/// Error bound of a computation in doubles. For a local coordinate it is relative to the distance from the centre, for
/// a sum it is relative to the terms. The bound covers about 6 roundings of 2^-53. Local: an error bound of the
/// formulas in this file.
constexpr double kRoughError = 0x1p-49;

/// Margin for rounding around the box of a shape, relative to the size and position of the box. Local: an error bound
/// of the formulas in this file.
constexpr double kShapeBoxMargin = 1e-12;

/// Number of bisection steps for the Lagrange multiplier. Further steps would not change a double.
constexpr int kHalvings = 120;

/// Magnitude of round_value() below which a point is on the surface. 1 corresponds to the size of the shape. The limit
/// is far above the errors of numbers with fifty digits. It is far below 2^-96, the distance that the sweep keeps
/// between a particle and a surface. With a limit above 2^-96, free segments would be reported. With a limit below
/// 1e-45, rounding would decide.
const Digits kOnSurface("1e-36");

Vector<Digits> digits(const Vec3& v) { return {Digits(v.x), Digits(v.y), Digits(v.z)}; }
Vector<Digits> unit(const Vector<Digits>& v) { return times<Digits>(1 / sqrt(product(v, v)), v); }
Digits square(const Digits& x) { return x * x; }
double square(double x) { return x * x; }

int sign_of(const Digits& x, const Digits& bound) { return (x > bound ? 1 : 0) - (x < -bound ? 1 : 0); }

}  // namespace

struct CheckedShape::Impl {
    Impl(const AffineMap& map, bool is_cylinder);

    [[nodiscard]] Vector<double> rough_local(const Vec3& p) const;
    [[nodiscard]] Vector<Digits> local(const Vec3& p) const;
    [[nodiscard]] int rough_side(const Vec3& p) const;
    [[nodiscard]] int exact_side(const Vector<Digits>& y) const;
    [[nodiscard]] Digits round_value(const Vector<Digits>& y) const;
    [[nodiscard]] bool box_misses(const Vec3& p, const Vec3& q) const;
    [[nodiscard]] bool is_roughly_apart(const Vec3& p, const Vec3& q) const;
    [[nodiscard]] bool is_apart(const Vector<Digits>& from, const Vector<Digits>& to) const;
    [[nodiscard]] bool is_certainly_clear(const Vec3& p, double least) const;
    [[nodiscard]] Digits square_distance_from_round(const Vector<Digits>& y) const;
    [[nodiscard]] Digits square_distance(const Vector<Digits>& y) const;

    Vec3 center;
    std::size_t round_axes;       ///< number of round axes: 3, or 2 for a cylinder with caps
    Vector<double> half{};        ///< lengths of the half axes, in m
    Vector<Vector<Digits>> axes;  ///< unit vectors
    Vector<Vec3> rough_axes;
    double smallest = 0.0;  ///< smallest half axis of the round axes, in m
    Box3 box;
};

CheckedShape::Impl::Impl(const AffineMap& map, bool is_cylinder)
    : center(map.translation), round_axes(is_cylinder ? 2 : 3) {
    Vector<Vector<Digits>> columns;
    for (int i = 0; i < 3; ++i) {
        const auto k = static_cast<std::size_t>(i);
        columns[k] = digits({map.row_x[i], map.row_y[i], map.row_z[i]});
        half[k] = static_cast<double>(Digits(sqrt(product(columns[k], columns[k]))));
    }
    const auto [low, high] = std::minmax(half[0], half[1]);
    const double third = round_axes == 3 ? half[2] : high;
    const double middle = std::max(low, std::min(high, third));
    smallest = std::min(low, third);
    if (std::max(high, third) - smallest <= kEqualAxes * smallest) {
        std::fill_n(half.begin(), round_axes, middle);
        smallest = middle;
    }
    axes[0] = unit(columns[0]);
    axes[1] = unit(less(columns[1], times(product(columns[1], axes[0]), axes[0])));
    axes[2] = across(axes[0], axes[1]);
    Vec3 reach;
    for (std::size_t i = 0; i < 3; ++i) {
        rough_axes[i] = {static_cast<double>(axes[i][0]), static_cast<double>(axes[i][1]),
                         static_cast<double>(axes[i][2])};
        reach += half[i] * abs(rough_axes[i]);
    }
    reach += kShapeBoxMargin * (reach + abs(center));
    box = {center - reach, center + reach};
}

Vector<double> CheckedShape::Impl::rough_local(const Vec3& p) const {
    const Vec3 w = p - center;
    return {dot(rough_axes[0], w), dot(rough_axes[1], w), dot(rough_axes[2], w)};
}

Vector<Digits> CheckedShape::Impl::local(const Vec3& p) const {
    const Vector<Digits> w = difference<Digits>(p, center);
    return {product(axes[0], w), product(axes[1], w), product(axes[2], w)};
}

/// Returns a value that is zero on the round part of the surface, negative inside and positive outside.
Digits CheckedShape::Impl::round_value(const Vector<Digits>& y) const {
    Digits value = -1;
    for (std::size_t i = 0; i < round_axes; ++i) value += square(Digits(y[i] / half[i]));
    return value;
}

/// Returns the side computed in doubles, or 0 if the error bound leaves doubt.
int CheckedShape::Impl::rough_side(const Vec3& p) const {
    const Vector<double> y = rough_local(p);
    const double error = kRoughError * length(p - center);
    double value = -1.0;
    double bound = kRoughError;
    for (std::size_t i = 0; i < round_axes; ++i) {
        value += square(y[i] / half[i]);
        bound += (kRoughError * square(y[i]) + (2.0 * std::fabs(y[i]) + error) * error) / square(half[i]);
    }
    if (value > 2.0 * bound) return 1;
    const bool is_within = value < -2.0 * bound;
    if (round_axes == 3) return is_within ? -1 : 0;
    const double height = std::fabs(y[2]) - half[2];
    const double cap_bound = 2.0 * (error + kRoughError * half[2]);
    if (height > cap_bound) return 1;
    return is_within && height < -cap_bound ? -1 : 0;
}

int CheckedShape::Impl::exact_side(const Vector<Digits>& y) const {
    const int around = sign_of(round_value(y), kOnSurface);
    if (round_axes == 3) return around;
    return std::max(around, sign_of(Digits(abs(y[2]) / half[2] - 1), kOnSurface));
}

bool CheckedShape::Impl::box_misses(const Vec3& p, const Vec3& q) const {
    const Vec3 lower = min(p, q), upper = max(p, q);
    return lower.x > box.upper.x || upper.x < box.lower.x || lower.y > box.upper.y || upper.y < box.lower.y ||
           lower.z > box.upper.z || upper.z < box.lower.z;
}

/// Returns true if doubles prove that the whole segment is outside. Along the segment, the value is a quadratic
/// polynomial of t. The error bound of its terms covers a few roundings and the errors of the coordinates.
bool CheckedShape::Impl::is_roughly_apart(const Vec3& p, const Vec3& q) const {
    const Vector<double> from = rough_local(p);
    const Vector<double> to = rough_local(q);
    const double error = kRoughError * std::max(length(p - center), length(q - center));
    if (round_axes == 2) {
        const double above = half[2] + 2.0 * (error + kRoughError * half[2]);
        if (std::min(from[2], to[2]) > above || std::max(from[2], to[2]) < -above) return true;
    }
    double value = -1.0;
    double slope = 0.0;
    double curvature = 0.0;
    double bound = kRoughError;
    for (std::size_t i = 0; i < round_axes; ++i) {
        const double step = to[i] - from[i];
        const double reach = std::fabs(from[i]) + std::fabs(to[i]);
        value += square(from[i] / half[i]);
        slope += from[i] * step / square(half[i]);
        curvature += square(step / half[i]);
        bound += (kRoughError * square(reach) + (reach + error) * error) / square(half[i]);
    }
    const double lowest = curvature == 0.0 ? 0.0 : std::clamp(-slope / curvature, 0.0, 1.0);
    return value + lowest * (2.0 * slope + lowest * curvature) > 8.0 * bound;
}

/// Returns true if the whole segment is outside. Both ends must be outside. Between the planes of the caps, the value
/// along the segment has one minimum.
bool CheckedShape::Impl::is_apart(const Vector<Digits>& from, const Vector<Digits>& to) const {
    const Vector<Digits> step = less(to, from);
    Digits first = 0;
    Digits last = 1;
    for (const int up : {1, -1}) {
        if (round_axes == 3) break;
        const Digits above = up * from[2] - half[2];
        const Digits change = up * step[2];
        if (change == 0 && above > 0) return true;
        if (change > 0) last = std::min(last, Digits(-above / change));
        if (change < 0) first = std::max(first, Digits(-above / change));
    }
    if (first > last) return true;
    Digits slope = 0;
    Digits curvature = 0;
    for (std::size_t i = 0; i < round_axes; ++i) {
        slope += from[i] * step[i] / square(Digits(half[i]));
        curvature += square(Digits(step[i] / half[i]));
    }
    const Digits lowest = curvature == 0 ? first : std::clamp(Digits(-slope / curvature), first, last);
    Vector<Digits> nearest = from;
    for (std::size_t i = 0; i < 3; ++i) nearest[i] += lowest * step[i];
    return round_value(nearest) > kOnSurface;
}

/// Returns true if doubles prove that the distance of p from the surface is above `least`. The map to the unit ball (or
/// cylinder) multiplies lengths by at most 1 / smallest half axis.
bool CheckedShape::Impl::is_certainly_clear(const Vec3& p, double least) const {
    const Vector<double> y = rough_local(p);
    double from_axis = 0.0;
    for (std::size_t i = 0; i < round_axes; ++i) from_axis += square(y[i] / half[i]);
    const double beside = smallest * (std::sqrt(from_axis) - 1.0);
    const double above = round_axes == 2 ? std::fabs(y[2]) - half[2] : beside;
    const double room = 1e-9 * (least + length(p - center) + half[0] + half[1] + half[2]);
    return std::max(beside, above) > least + room || std::max(beside, above) < -least - room;
}

/// Returns the squared distance from the ellipsoid, or from the cylinder's side. For every multiplier m > -smallest^2,
/// sum y_i^2 m / (a_i^2 + m) - m is a lower bound of the squared distance. The best multiplier gives equality, because
/// Lagrange duality with one quadratic constraint has no gap. The multiplier is found in doubles. The error of the
/// result is proportional to the square of the multiplier's error.
Digits CheckedShape::Impl::square_distance_from_round(const Vector<Digits>& y) const {
    Vector<double> rough{};
    double sum = 0.0;
    for (std::size_t i = 0; i < round_axes; ++i) {
        rough[i] = static_cast<double>(y[i]);
        sum += square(rough[i] * half[i]);
    }
    // u = m + smallest^2. The bound increases with u while sum (y_i a_i / (a_i^2 - smallest^2 + u))^2 > 1.
    double low = 0.0;
    double high = std::sqrt(sum);
    const auto rises = [&](double u) {
        double squares = 0.0;
        for (std::size_t i = 0; i < round_axes; ++i) {
            const double excess = (half[i] - smallest) * (half[i] + smallest);
            squares += square(rough[i] * half[i] / (excess + u));
        }
        return squares > 1.0;
    };
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        if (!(middle > low && middle < high)) break;
        (rises(middle) ? low : high) = middle;
    }
    const Digits u(high);
    const Digits m = u - square(Digits(smallest));
    Digits bound = -m;
    for (std::size_t i = 0; i < round_axes; ++i) {
        const Digits below = square(Digits(half[i])) + m;
        if (below > 0) bound += square(y[i]) * m / below;
    }
    return bound;
}

/// Returns the squared distance from the surface. Outside a cylinder, the squared distances from side and cap are
/// combined. Inside, the smaller of the two is returned.
Digits CheckedShape::Impl::square_distance(const Vector<Digits>& y) const {
    Digits around = square_distance_from_round(y);
    if (round_axes == 3) return around;
    const Digits height = abs(y[2]) - half[2];
    const bool is_beside = round_value(y) > 0;
    if (height > 0) return is_beside ? Digits(around + square(height)) : square(height);
    return is_beside ? around : std::min(around, square(height));
}

CheckedShape::CheckedShape(const AffineMap& world_from_unit, bool is_cylinder)
    : impl_(std::make_unique<Impl>(world_from_unit, is_cylinder)) {}
CheckedShape::~CheckedShape() = default;
CheckedShape::CheckedShape(CheckedShape&&) noexcept = default;
CheckedShape& CheckedShape::operator=(CheckedShape&&) noexcept = default;

int CheckedShape::side(const Vec3& p) const {
    if (impl_->box_misses(p, p)) return 1;
    const int rough = impl_->rough_side(p);
    return rough != 0 ? rough : impl_->exact_side(impl_->local(p));
}

bool CheckedShape::intersects(const Vec3& p, const Vec3& q) const {
    if (impl_->box_misses(p, q)) return false;
    const int of_p = side(p);
    if (of_p == 0 || side(q) != of_p) return true;
    if (of_p < 0 || impl_->is_roughly_apart(p, q)) return false;
    return !impl_->is_apart(impl_->local(p), impl_->local(q));
}

/// The body is convex, so a segment from its surface to an inner point is inside. A segment to an outer point is
/// outside unless it enters the body. If the segment enters the body, its point at the fraction 2^-40 of its length is
/// inside. A shorter part inside is ignored.
bool CheckedShape::intersects_after_start(const Vec3& p, const Vec3& q) const {
    const int of_q = side(q);
    if (of_q <= 0) return of_q == 0;
    const Vector<Digits> from = impl_->local(p);
    const Vector<Digits> to = impl_->local(q);
    Vector<Digits> next = from;
    for (std::size_t i = 0; i < 3; ++i) next[i] += (to[i] - from[i]) * Digits(0x1p-40);
    return impl_->exact_side(next) <= 0 || !impl_->is_apart(next, to);
}

bool CheckedShape::is_nearer(const Vec3& p, double least) const {
    if (impl_->is_certainly_clear(p, least)) return false;
    return impl_->square_distance(impl_->local(p)) < square(Digits(least));
}

}  // namespace ricochet::verify
