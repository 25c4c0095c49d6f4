#include "ricochet/geometry/shapes/local_shape.h"

#include <algorithm>
#include <cmath>

namespace ricochet {
namespace {

using std::size_t;

/// Half axes closer than this, relative, are made equal: a rotation rounds the columns of a uniform scale by about
/// 2^-52.
constexpr double kEqualAxes = 0x1p-49;

/// Newton's steps for sigma. It converges from below, at first cubically in the distance from a pole, in the end
/// quadratically; a dozen steps have been seen at the most.
constexpr int kMaxSteps = 60;

/// Error of a distance relative to itself, and, away from the surface, to the size of shape and position: four times
/// what has been seen in 40 000 random cases.
constexpr double kRelativeError = 0x1p-48;
constexpr double kErrorOfSize = 0x1p-50;

double square(double x) { return x * x; }

std::array<double, 3> as_array(const Vec3& v) { return {v.x, v.y, v.z}; }

/// Halvings and secants for the nearest point of a segment; the bound returned is valid after any number of them.
constexpr int kMaxSegmentSteps = 100;

/// Difference between a segment's least distance and its bound, relative, at which the search for the closest point
/// ends.
constexpr double kSegmentError = 0x1p-50;

/// Error of a squared length at the rounded point of a perpendicular, relative to the square of the start: the point
/// errs by some 8 u, the square by the square of that.
constexpr double kMinimumError = 0x1p-98;

double rounded_value(double x) { return x; }
double rounded_value(const DoubleDouble& x) { return x.hi; }

template <class Scalar>
Vec3 rounded_vector(const VectorOf<Scalar>& v) {
    return {rounded_value(v.x), rounded_value(v.y), rounded_value(v.z)};
}

template <class Scalar>
VectorOf<Scalar> on_segment(const VectorOf<Scalar>& from, const VectorOf<Scalar>& step, const Scalar& t) {
    return {from.x + t * step.x, from.y + t * step.y, from.z + t * step.z};
}

template <class Scalar>
VectorOf<Scalar> step_of(const LocalSegment<Scalar>& s) {
    return {s.to.x - s.from.x, s.to.y - s.from.y, s.to.z - s.from.z};
}

/// Fraction at which a height changes from `before` > 0 through zero to `after` < before.
template <class Scalar>
Scalar crossing(const Scalar& before, const Scalar& after) {
    return before / (before - after);
}

int sign_beyond(double value, double bound) {
    return static_cast<int>(value > bound) - static_cast<int>(value < -bound);
}

}  // namespace

PreciseVec3 LocalPath::position(double s) const {
    const auto horner = [&](const std::array<DoubleDouble, 4>& m) {
        DoubleDouble sum = m[static_cast<size_t>(degree)];
        for (int k = degree - 1; k >= 0; --k) sum = sum * s + m[static_cast<size_t>(k)];
        return sum;
    };
    return {horner(component[0]), horner(component[1]), horner(component[2])};
}

Vec3 LocalPath::velocity(double s) const {
    const auto slope = [&](const std::array<DoubleDouble, 4>& m) {
        return m[1].hi + s * (2.0 * m[2].hi + s * (3.0 * m[3].hi));
    };
    return {slope(component[0]), slope(component[1]), slope(component[2])};
}

Vec3 LocalPath::acceleration(double s) const {
    const auto second = [&](const std::array<DoubleDouble, 4>& m) { return 2.0 * m[2].hi + s * (6.0 * m[3].hi); };
    return {second(component[0]), second(component[1]), second(component[2])};
}

Vec3 LocalPath::jerk() const { return {6.0 * component[0][3].hi, 6.0 * component[1][3].hi, 6.0 * component[2][3].hi}; }

Ellipsoid::Ellipsoid(const std::array<double, 3>& half_axes, int axes)
    : axes_(static_cast<size_t>(axes)), half_axes_(half_axes) {
    const double a = half_axes[0];
    const double b = half_axes[1];
    const double c = axes == 3 ? half_axes[2] : std::max(a, b);
    smallest_ = std::min({a, b, c});
    largest_ = std::max({a, b, c});
    is_round_ = largest_ - smallest_ <= kEqualAxes * smallest_;
    if (is_round_) {
        const double middle = std::max(std::min(a, b), std::min(std::max(a, b), c));
        std::fill_n(half_axes_.begin(), axes_, middle);
        smallest_ = middle;
        largest_ = middle;
    }
    for (size_t i = 0; i < axes_; ++i) {
        const double half = half_axes_[i];
        weights_[i] = is_round_ ? DoubleDouble(1.0) : DoubleDouble(1.0) / two_product(half, half);
        ratio_[i] = square(half / smallest_);
        excess_[i] = (half - smallest_) / smallest_ * ((half + smallest_) / smallest_);
    }
    constant_ = is_round_ ? two_product(smallest_, smallest_) : DoubleDouble(1.0);
}

double Ellipsoid::value_error(const Vec3& y, double coordinate_error, double unit) const {
    const std::array<double, 3> magnitude = as_array(abs(y));
    double of_coordinates = 0.0;
    double terms = constant_.hi;
    for (size_t i = 0; i < axes_; ++i) {
        of_coordinates += weights_[i].hi * (2.0 * magnitude[i] + coordinate_error) * coordinate_error;
        terms += weights_[i].hi * square(magnitude[i]);
    }
    return (1.0 + 0x1p-40) * (of_coordinates + unit * terms);
}

Polynomial Ellipsoid::value_along(const LocalPath& path, int sign) const {
    return value_along(path, sign, weights_, constant_);
}

Polynomial Ellipsoid::value_along(const LocalPath& path, int sign, const DoubleDouble& radius) const {
    return value_along(path, sign, weights_, radius * radius);
}

Polynomial Ellipsoid::value_along(const LocalPath& path, int sign, const std::array<DoubleDouble, 3>& weights,
                                  const DoubleDouble& constant) const {
    Polynomial p;
    p.degree = 2 * path.degree;
    p.duration = path.duration;
    const auto degree = static_cast<size_t>(path.degree);
    for (size_t axis = 0; axis < axes_; ++axis) {
        const auto& m = path.component[axis];
        for (size_t i = 0; i <= degree; ++i) {
            const DoubleDouble weighted = is_round_ ? m[i] : weights[axis] * m[i];
            p.coefficients[2 * i] = p.coefficients[2 * i] + weighted * m[i];
            for (size_t j = i + 1; j <= degree; ++j) {
                p.coefficients[i + j] = p.coefficients[i + j] + 2.0 * (weighted * m[j]);
            }
        }
    }
    p.coefficients[0] = p.coefficients[0] - constant;
    if (sign < 0) {
        for (DoubleDouble& c : p.coefficients) c = -c;
    }
    return p;
}

Vec3 Ellipsoid::normal_at(const Vec3& y) const {
    const Vec3 gradient{weights_[0].hi * y.x, weights_[1].hi * y.y, axes_ == 3 ? weights_[2].hi * y.z : 0.0};
    return normalized(gradient);
}

double Ellipsoid::support(const Vec3& n) const {
    const double sum = square(half_axes_[0] * n.x) + square(half_axes_[1] * n.y);
    return std::sqrt(axes_ == 3 ? sum + square(half_axes_[2] * n.z) : sum);
}

LocalPoint Ellipsoid::closest_point_of_round(const PreciseVec3& y) const {
    Vec3 radial = rounded(y);
    if (axes_ == 2) radial.z = 0.0;
    const double from_axis = length(radial);
    const double distance = value(y).hi / (from_axis + smallest_);
    const Vec3 normal = from_axis > 0.0 ? radial / from_axis : Vec3{1.0, 0.0, 0.0};
    Vec3 point = smallest_ * normal;
    if (axes_ == 2) point.z = y.z.hi;
    return {point, normal, distance};
}

double Ellipsoid::distance_error(double distance, const Vec3& y) const {
    const double relative = kRelativeError * std::fabs(distance);
    const bool is_near = std::fabs(distance) < 0.25 * square(smallest_) / largest_;
    return is_round_ || is_near ? relative : relative + kErrorOfSize * (length(y) + largest_);
}

/// With t = distance / |gradient at the point| the point is x_i = y_i a_i^2 / (a_i^2 + t). For sigma = 1 + t /
/// smallest^2 and b_i = |y_i| a_i / smallest^2 it lies on the surface when sum (b_i / (excess_i + sigma))^2 = 1. The
/// largest root is sought; it is >= 0, and 0 means the medial axis (unless b vanishes along the smallest axes
/// there is no root at 0).
double Ellipsoid::sigma_of(const std::array<double, 3>& y) const {
    std::array<double, 3> b{};
    double sum = 0.0;
    double largest_excess = 0.0;
    double sigma = 0.0;
    for (size_t i = 0; i < axes_; ++i) {
        b[i] = std::fabs(y[i]) / smallest_ * (half_axes_[i] / smallest_);
        sum += square(b[i]);
        largest_excess = std::max(largest_excess, excess_[i]);
        sigma = std::max(sigma, b[i] - excess_[i]);
    }
    sigma = std::max(sigma, std::sqrt(sum) - largest_excess);
    for (int step = 0; step < kMaxSteps; ++step) {
        double squares = 0.0;
        double cubes = 0.0;
        for (size_t i = 0; i < axes_; ++i) {
            if (b[i] == 0.0) continue;
            const double term = square(b[i] / (excess_[i] + sigma));
            squares += term;
            cubes += term / (excess_[i] + sigma);
        }
        if (sigma == 0.0 && squares <= 1.0) return 0.0;
        const double change = (std::sqrt(squares) - 1.0) * squares / cubes;
        const double next = std::max(sigma + change, 0.5 * sigma);
        if (std::fabs(next - sigma) <= 0x1p-51 * sigma) return next;
        sigma = next;
    }
    return sigma;
}

/// Two steps of Newton's method on value - sum (y_i / a_i)^2 (1 - (1 + tau_i)^-2) = 0 with tau_i = tau / ratio_i,
/// written so that nothing cancels when tau is small: tau becomes accurate relative to itself.
double Ellipsoid::polished(double tau, const std::array<double, 3>& y, double value) const {
    for (int step = 0; step < 2; ++step) {
        double residual = value;
        double slope = 0.0;
        for (size_t i = 0; i < axes_; ++i) {
            const double q = square(y[i] / half_axes_[i]);
            const double tau_i = tau / ratio_[i];
            const double grown = 1.0 + tau_i;
            residual -= q * tau_i * (2.0 + tau_i) / square(grown);
            slope += 2.0 * q / (ratio_[i] * square(grown) * grown);
        }
        tau += residual / slope;
    }
    return tau;
}

LocalPoint Ellipsoid::closest_point(const PreciseVec3& y) const {
    if (is_round_) return closest_point_of_round(y);
    const std::array<double, 3> coordinates{y.x.hi, y.y.hi, y.z.hi};
    const double sigma = sigma_of(coordinates);
    double tau = sigma - 1.0;
    const double height = value(y).hi;
    if (sigma > 0.5 && height < 1.0) tau = polished(tau, coordinates, height);
    std::array<double, 3> point = coordinates;
    double rest = 1.0;  // of sum (x_i / a_i)^2, for the smallest axis when y has nothing along it
    for (size_t i = 0; i < axes_; ++i) {
        if (sigma == 0.0 && excess_[i] == 0.0) continue;
        // In terms of sigma deep inside and of tau near the surface: either has no cancellation there.
        point[i] =
            sigma > 0.5 ? coordinates[i] / (1.0 + tau / ratio_[i]) : coordinates[i] * ratio_[i] / (excess_[i] + sigma);
        rest -= square(point[i] / half_axes_[i]);
    }
    if (sigma == 0.0) {
        const auto smallest = std::find(half_axes_.begin(), half_axes_.end(), smallest_) - half_axes_.begin();
        point[static_cast<size_t>(smallest)] = smallest_ * std::sqrt(std::max(0.0, rest));
    }
    Vec3 gradient;  // times smallest^2
    for (size_t i = 0; i < axes_; ++i) gradient[static_cast<int>(i)] = point[i] / ratio_[i];
    const double steepness = length(gradient);
    return {{point[0], point[1], point[2]}, gradient / steepness, tau * steepness};
}

LocalShape::LocalShape(const std::array<double, 3>& half_axes, bool is_capped)
    : ellipsoid_(half_axes, is_capped ? 2 : 3), is_capped_(is_capped), half_height_(is_capped ? half_axes[2] : 0.0) {}

LocalShape LocalShape::ball(const std::array<double, 3>& half_axes) { return {half_axes, false}; }
LocalShape LocalShape::cylinder(const std::array<double, 3>& half_axes) { return {half_axes, true}; }

template <class Scalar>
int LocalShape::side_of_start(const LocalSegment<Scalar>& segment) const {
    const Vec3 y = rounded_vector(segment.from);
    const int lateral = sign_beyond(rounded_value(ellipsoid_.value(segment.from)),
                                    ellipsoid_.value_error(y, segment.coordinate_error, segment.unit));
    if (!is_capped_ || lateral > 0) return lateral;
    const double magnitude = std::fabs(y.z) + half_height_;
    const Scalar height = (y.z < 0.0 ? -segment.from.z : segment.from.z) + Scalar(-half_height_);
    const int beyond_cap = sign_beyond(rounded_value(height), segment.coordinate_error + segment.unit * magnitude);
    if (beyond_cap > 0) return 1;
    return lateral < 0 && beyond_cap < 0 ? -1 : 0;
}

/// The part of the segment between the caps' planes, a little more by rounding; nothing when it is all beyond one.
template <class Scalar>
std::optional<LocalShape::Interval<Scalar>> LocalShape::between_caps(const LocalSegment<Scalar>& segment) const {
    Interval<Scalar> part;
    for (const double sign : {1.0, -1.0}) {
        const Scalar before = sign * segment.from.z + Scalar(-half_height_);
        const Scalar after = sign * segment.to.z + Scalar(-half_height_);
        const double largest =
            std::max(std::fabs(rounded_value(segment.from.z)), std::fabs(rounded_value(segment.to.z)));
        const double error = segment.coordinate_error + segment.unit * (largest + half_height_);
        if (rounded_value(before) > error && rounded_value(after) > error) return std::nullopt;
        const double slack = 4.0 * segment.unit + 4.0 * error / std::fabs(rounded_value(before - after));
        if (rounded_value(before) > error) {
            part.from = std::max(part.from, crossing(before, after) + Scalar(-slack));
        } else if (rounded_value(after) > error) {
            part.to = std::min(part.to, Scalar(1.0) - crossing(after, before) + Scalar(slack));
        }
    }
    if (part.from > part.to) return std::nullopt;
    return part;
}

/// Outside, the smallest value() between the caps decides: it is convex along the segment, and an error of the
/// minimum's position counts by its square.
template <class Scalar>
bool LocalShape::is_clear(const LocalSegment<Scalar>& segment) const {
    const int side = side_of_start(segment);
    const LocalSegment<Scalar> reversed{segment.to, segment.from, segment.coordinate_error, segment.unit};
    if (side == 0 || side_of_start(reversed) != side) return false;
    if (side < 0) return true;
    const auto part = is_capped_ ? between_caps(segment) : std::optional(Interval<Scalar>{});
    if (!part) return true;
    const VectorOf<Scalar> step = step_of(segment);
    const Vec3 y = rounded_vector(segment.from);
    const Vec3 d = rounded_vector(step);
    double slope = 0.0;
    double curvature = 0.0;
    for (int i = 0; i < ellipsoid_.axes(); ++i) {
        slope += y[i] / ellipsoid_.half_axis(i) * (d[i] / ellipsoid_.half_axis(i));
        curvature += d[i] / ellipsoid_.half_axis(i) * (d[i] / ellipsoid_.half_axis(i));
    }
    const Scalar lowest(curvature > 0.0 ? -slope / curvature : 0.0);
    const VectorOf<Scalar> nearest = on_segment(segment.from, step, std::clamp(lowest, part->from, part->to));
    const Vec3 magnitude = abs(y) + abs(d);
    const double error =
        ellipsoid_.value_error(magnitude, 4.0 * segment.coordinate_error, 4.0 * segment.unit + kMinimumError);
    return rounded_value(ellipsoid_.value(nearest)) > error;
}

template int LocalShape::side_of_start(const LocalSegment<double>&) const;
template int LocalShape::side_of_start(const LocalSegment<DoubleDouble>&) const;
template bool LocalShape::is_clear(const LocalSegment<double>&) const;
template bool LocalShape::is_clear(const LocalSegment<DoubleDouble>&) const;

namespace {

/// Which way a cap faces along z.
double up_of(ShapePart cap) { return cap == ShapePart::top ? 1.0 : -1.0; }

ShapePart cap_on(double up) { return up > 0.0 ? ShapePart::top : ShapePart::bottom; }

/// The rim of a cap, seen from a point that is so far beyond the side and over the cap.
LocalPoint rim_point(const LocalPoint& lateral, ShapePart part, double up, double height, double half_height) {
    const double distance = std::sqrt(lateral.distance * lateral.distance + height * height);
    const Vec3 normal = (lateral.distance / distance) * lateral.normal + Vec3{0.0, 0.0, up * (height / distance)};
    return {{lateral.point.x, lateral.point.y, up * half_height}, normal, distance, part, true};
}

}  // namespace

LocalPoint LocalShape::closest_point(const PreciseVec3& y) const {
    LocalPoint lateral = ellipsoid_.closest_point(y);
    if (!is_capped_) return lateral;
    const double up = y.z.hi < 0.0 ? -1.0 : 1.0;
    const double height = (up * y.z + -half_height_).hi;
    const bool is_outside_side = lateral.distance > 0.0;
    if (height <= 0.0 && (is_outside_side || lateral.distance >= height)) return lateral;
    if (!is_outside_side) return closest_point_beyond(cap_on(up), y);
    return rim_point(lateral, ShapePart::side, up, height, half_height_);
}

LocalPoint LocalShape::closest_point_of(ShapePart part, const PreciseVec3& y) const {
    const LocalPoint lateral = ellipsoid_.closest_point(y);
    if (!is_capped_) return lateral;
    if (part == ShapePart::side) {
        const double up = y.z.hi < 0.0 ? -1.0 : 1.0;
        const double height = (up * y.z + -half_height_).hi;
        return height <= 0.0 ? lateral : rim_point(lateral, part, up, height, half_height_);
    }
    const LocalPoint over_cap = closest_point_beyond(part, y);
    if (lateral.distance <= 0.0) return over_cap;
    return rim_point(lateral, part, up_of(part), over_cap.distance, half_height_);
}

LocalPoint LocalShape::closest_point_beyond(ShapePart part, const PreciseVec3& y) const {
    if (part == ShapePart::side) return ellipsoid_.closest_point(y);
    const double up = up_of(part);
    return {{y.x.hi, y.y.hi, up * half_height_}, {0.0, 0.0, up}, (up * y.z + -half_height_).hi, part, false};
}

std::span<const ShapePart> LocalShape::parts() const {
    static constexpr std::array kAll{ShapePart::side, ShapePart::top, ShapePart::bottom};
    return std::span(kAll).first(is_capped_ ? 3 : 1);
}

double LocalShape::distance_of(const PreciseVec3& from, const PreciseVec3& to) const {
    const LocalPoint at_from = closest_point(from);
    const LocalPoint at_to = closest_point(to);
    double least = std::min(std::fabs(at_from.distance), std::fabs(at_to.distance));
    const Vec3 size = abs(rounded(from)) + abs(rounded(to));
    // The depth inside a convex body is concave along the segment: its least value is at an end.
    if (at_from.distance > 0.0 && at_to.distance > 0.0) least = std::min(least, distance_from_outside(from, to));
    return std::max(0.0, least - ellipsoid_.distance_error(least, size));
}

/// The distance from a convex body is convex along the segment, so that it lies above its tangents. The root of its
/// slope is bracketed by secants (with the Illinois rule) until the tangents meet.
double LocalShape::distance_from_outside(const PreciseVec3& from, const PreciseVec3& to) const {
    struct Tangent {
        double t;
        double distance;
        double slope;
    };
    const PreciseVec3 step = to - from;
    const Vec3 direction = rounded(step);
    const auto tangent_at = [&](double t) {
        const LocalPoint near = closest_point(on_segment(from, step, DoubleDouble(t)));
        return Tangent{t, near.distance, dot(near.normal, direction)};
    };
    Tangent low = tangent_at(0.0);
    Tangent high = tangent_at(1.0);
    if (low.slope >= 0.0) return low.distance;
    if (high.slope <= 0.0) return high.distance;
    double low_weight = low.slope;
    double high_weight = high.slope;
    int last_side = 0;
    double bound = 0.0;
    for (int k = 0; k < kMaxSegmentSteps; ++k) {
        const double width = high.t - low.t;
        const double where = (low.distance - high.distance + high.slope * width) / (high.slope - low.slope);
        bound = std::max(bound, low.distance + low.slope * std::clamp(where, 0.0, width));
        if (std::min(low.distance, high.distance) - bound <= kSegmentError * bound) break;
        double t = low.t + width * (low_weight / (low_weight - high_weight));
        if (k % 4 == 3 || !(t > low.t && t < high.t)) t = low.t + 0.5 * width;
        if (!(t > low.t && t < high.t)) break;
        const Tangent middle = tangent_at(t);
        bound = std::max(bound, middle.distance - std::fabs(middle.slope) * std::max(high.t - t, t - low.t));
        const int side = middle.slope < 0.0 ? -1 : 1;
        (side < 0 ? low : high) = middle;
        (side < 0 ? low_weight : high_weight) = middle.slope;
        if (side == last_side) (side < 0 ? high_weight : low_weight) *= 0.5;
        last_side = side;
    }
    return bound;
}

}  // namespace ricochet
