#include "ricochet/geometry/shapes/local_shape.h"

#include <algorithm>

#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// Maximum number of halvings and secants for the nearest point of a segment. The returned bound is valid after any
/// number of steps.
constexpr int kMaxSegmentSteps = 100;

/// Relative difference between a segment's least distance and its bound at which the search for the closest point ends.
/// Local: the difference is below the rounding of the result.
constexpr double kSegmentError = 0x1p-50;

/// Error of the smallest squared length along a segment, because the foot of the perpendicular is rounded. It is
/// relative to the squared length at the start. The foot has a relative error of about 8 u, and the squared length has
/// the square of that error. Local: an error bound of this arithmetic.
constexpr double kMinimumError = 0x1p-98;

/// Returns the fraction at which the height is zero while it changes linearly from `before` > 0 to `after` < before.
template <class Scalar>
Scalar crossing(const Scalar& before, const Scalar& after) {
    return before / (before - after);
}

}  // namespace

LocalShape::LocalShape(const std::array<double, 3>& half_axes, bool is_capped)
    : ellipsoid_(half_axes, is_capped ? 2 : 3), is_capped_(is_capped), half_height_(is_capped ? half_axes[2] : 0.0) {}

template <class Scalar>
int LocalShape::side_of_start(const LocalSegment<Scalar>& segment) const {
    const Vec3 y = rounded(segment.from);
    const int lateral = sign_beyond(high(ellipsoid_.value(segment.from)),
                                    ellipsoid_.value_error(y, segment.coordinate_error, segment.unit));
    if (!is_capped_ || lateral > 0) return lateral;
    const double magnitude = std::fabs(y.z) + half_height_;
    const Scalar height = (y.z < 0.0 ? -segment.from.z : segment.from.z) + Scalar(-half_height_);
    const int beyond_cap = sign_beyond(high(height), segment.coordinate_error + segment.unit * magnitude);
    if (beyond_cap > 0) return 1;
    return lateral < 0 && beyond_cap < 0 ? -1 : 0;
}

/// Returns the part of the segment between the caps' planes, slightly enlarged for rounding. Returns nullopt if the
/// whole segment is beyond one plane.
template <class Scalar>
std::optional<LocalShape::Interval<Scalar>> LocalShape::between_caps(const LocalSegment<Scalar>& segment) const {
    Interval<Scalar> part;
    for (const double sign : {1.0, -1.0}) {
        const Scalar before = sign * segment.from.z + Scalar(-half_height_);
        const Scalar after = sign * segment.to.z + Scalar(-half_height_);
        const double largest = std::max(std::fabs(high(segment.from.z)), std::fabs(high(segment.to.z)));
        const double error = segment.coordinate_error + segment.unit * (largest + half_height_);
        if (high(before) > error && high(after) > error) return std::nullopt;
        const double slack = 4.0 * segment.unit + 4.0 * error / std::fabs(high(before - after));
        if (high(before) > error) {
            part.from = std::max(part.from, crossing(before, after) + Scalar(-slack));
        } else if (high(after) > error) {
            part.to = std::min(part.to, Scalar(1.0) - crossing(after, before) + Scalar(slack));
        }
    }
    if (part.from > part.to) return std::nullopt;
    return part;
}

/// For a segment outside, the smallest value() between the caps decides. value() is convex along the segment, so an
/// error in the minimum's position changes the minimum only by the square of the error.
template <class Scalar>
bool LocalShape::is_clear(const LocalSegment<Scalar>& segment) const {
    const int side = side_of_start(segment);
    const LocalSegment<Scalar> reversed{segment.to, segment.from, segment.coordinate_error, segment.unit};
    if (side == 0 || side_of_start(reversed) != side) return false;
    if (side < 0) return true;
    const auto part = is_capped_ ? between_caps(segment) : std::optional(Interval<Scalar>{});
    if (!part) return true;
    const VectorOf<Scalar> step = segment.to - segment.from;
    const Vec3 y = rounded(segment.from);
    const Vec3 d = rounded(step);
    double slope = 0.0;
    double curvature = 0.0;
    for (int i = 0; i < ellipsoid_.axes(); ++i) {
        slope += y[i] / ellipsoid_.half_axis(i) * (d[i] / ellipsoid_.half_axis(i));
        curvature += d[i] / ellipsoid_.half_axis(i) * (d[i] / ellipsoid_.half_axis(i));
    }
    const Scalar lowest(curvature > 0.0 ? -slope / curvature : 0.0);
    const VectorOf<Scalar> nearest = segment.from + std::clamp(lowest, part->from, part->to) * step;
    const Vec3 magnitude = abs(y) + abs(d);
    const double error =
        ellipsoid_.value_error(magnitude, 4.0 * segment.coordinate_error, 4.0 * segment.unit + kMinimumError);
    return high(ellipsoid_.value(nearest)) > error;
}

template int LocalShape::side_of_start(const LocalSegment<double>&) const;
template int LocalShape::side_of_start(const LocalSegment<DoubleDouble>&) const;
template bool LocalShape::is_clear(const LocalSegment<double>&) const;
template bool LocalShape::is_clear(const LocalSegment<DoubleDouble>&) const;

namespace {

/// Returns the direction in which a cap faces along z.
double up_of(ShapePart cap) { return cap == ShapePart::top ? 1.0 : -1.0; }

ShapePart cap_on(double up) { return up > 0.0 ? ShapePart::top : ShapePart::bottom; }

/// Returns the nearest point on a cap's rim for a point that is beyond the side and beyond the cap by the given
/// distances.
ShapePoint rim_point(const ShapePoint& lateral, ShapePart part, double up, double height, double half_height) {
    const double distance = std::sqrt(lateral.distance * lateral.distance + height * height);
    const Vec3 normal = (lateral.distance / distance) * lateral.normal + Vec3{0.0, 0.0, up * (height / distance)};
    return {{lateral.point.x, lateral.point.y, up * half_height}, normal, distance, part, true};
}

}  // namespace

ShapePoint LocalShape::closest_point(const PreciseVec3& y) const {
    ShapePoint lateral = ellipsoid_.closest_point(y);
    if (!is_capped_) return lateral;
    const double up = y.z.hi < 0.0 ? -1.0 : 1.0;
    const double height = (up * y.z + -half_height_).hi;
    const bool is_outside_side = lateral.distance > 0.0;
    if (height <= 0.0 && (is_outside_side || lateral.distance >= height)) return lateral;
    if (!is_outside_side) return closest_point_beyond(cap_on(up), y);
    return rim_point(lateral, ShapePart::side, up, height, half_height_);
}

ShapePoint LocalShape::closest_point_of(ShapePart part, const PreciseVec3& y) const {
    const ShapePoint lateral = ellipsoid_.closest_point(y);
    if (!is_capped_) return lateral;
    if (part == ShapePart::side) {
        const double up = y.z.hi < 0.0 ? -1.0 : 1.0;
        const double height = (up * y.z + -half_height_).hi;
        return height <= 0.0 ? lateral : rim_point(lateral, part, up, height, half_height_);
    }
    const ShapePoint over_cap = closest_point_beyond(part, y);
    if (lateral.distance <= 0.0) return over_cap;
    return rim_point(lateral, part, up_of(part), over_cap.distance, half_height_);
}

ShapePoint LocalShape::closest_point_beyond(ShapePart part, const PreciseVec3& y) const {
    if (part == ShapePart::side) return ellipsoid_.closest_point(y);
    const double up = up_of(part);
    return {{y.x.hi, y.y.hi, up * half_height_}, {0.0, 0.0, up}, (up * y.z + -half_height_).hi, part, false};
}

std::span<const ShapePart> LocalShape::parts() const {
    static constexpr std::array kAll{ShapePart::side, ShapePart::top, ShapePart::bottom};
    return std::span(kAll).first(is_capped_ ? 3 : 1);
}

double LocalShape::distance_of(const PreciseVec3& from, const PreciseVec3& to) const {
    const ShapePoint at_from = closest_point(from);
    const ShapePoint at_to = closest_point(to);
    double least = std::min(std::fabs(at_from.distance), std::fabs(at_to.distance));
    const Vec3 size = abs(rounded(from)) + abs(rounded(to));
    // The depth inside a convex body is concave along the segment, so its smallest value is at an end.
    if (at_from.distance > 0.0 && at_to.distance > 0.0) least = std::min(least, distance_from_outside(from, to));
    return std::max(0.0, least - ellipsoid_.distance_error(least, size));
}

/// Returns a lower bound on the distance of a segment outside the shape. The distance from a convex body is convex
/// along the segment, so it is never below its tangents. Secants (with the Illinois rule) bracket the root of its slope
/// until the tangents give a tight bound.
double LocalShape::distance_from_outside(const PreciseVec3& from, const PreciseVec3& to) const {
    struct Tangent {
        double t;
        double distance;
        double slope;
    };
    const PreciseVec3 step = to - from;
    const Vec3 direction = rounded(step);
    const auto tangent_at = [&](double t) {
        const ShapePoint near = closest_point(from + DoubleDouble(t) * step);
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
