#include "ricochet/geometry/shapes/analytic_shape.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/shapes/shape_contact.h"

namespace ricochet {
namespace {

/// Relative error of a sum of squares or a scalar product and of a local coordinate: some 6 roundings; 8 and more are
/// granted, in doubles and in double-doubles.
constexpr double kRoughError = 0x1p-50;
constexpr double kPreciseError = 0x1p-98;

/// What clears() adds to the reach, relative to all lengths involved.
constexpr double kDistanceFieldSlack = 0x1p-44;

/// Corners of the path's Bezier hull: path and chords lie inside.
struct Hull {
    std::array<Vec3, 4> point;
    int count = 0;
};

Hull hull_of(const Path& path) {
    const double h = path.duration;
    if (path.degree < 2) return {{path.c[0], path.end, {}, {}}, 2};
    const Vec3 second = path.c[0] + (h / path.degree) * path.c[1];
    if (path.degree == 2) return {{path.c[0], second, path.end, {}}, 3};
    return {{path.c[0], second, path.c[0] + (h / 3.0) * (2.0 * path.c[1] + h * path.c[2]), path.end}, 4};
}

bool is_apart(const Hull& hull, const Box3& box, double reach) {
    Vec3 lower = hull.point[0];
    Vec3 upper = hull.point[0];
    for (int k = 1; k < hull.count; ++k) {
        lower = min(lower, hull.point[static_cast<std::size_t>(k)]);
        upper = max(upper, hull.point[static_cast<std::size_t>(k)]);
    }
    for (int i = 0; i < 3; ++i) {
        if (lower[i] > box.upper[i] + reach || upper[i] < box.lower[i] - reach) return true;
    }
    return false;
}

/// y in the coordinates in which the (round part of the) shape is the unit ball, or disk.
Vec3 in_units(const CentredEllipsoid& around, const Vec3& y) {
    return {y.x / around.half_axis(0), y.y / around.half_axis(1), around.axes() == 3 ? y.z / around.half_axis(2) : 0.0};
}

/// Is the hull inside the shape by at least `reach`? The map to the unit ball stretches nothing by more than 1 /
/// smallest half axis.
bool is_deep_inside(const LocalShape& shape, const Hull& local, double reach) {
    const CentredEllipsoid& around = shape.around();
    const double largest = 1.0 - reach / around.smallest();
    if (!(largest > 0.0)) return false;
    return std::all_of(local.point.begin(), local.point.begin() + local.count, [&](const Vec3& y) {
        if (shape.is_capped() && std::fabs(y.z) > shape.half_height() - reach) return false;
        return length_squared(in_units(around, y)) <= largest * largest;
    });
}

/// Is the hull beyond a tangent plane across n by at least `reach`?
bool is_beyond_plane(const LocalShape& shape, const Hull& local, const Vec3& n, double reach) {
    const double height = shape.support(n) + reach * length(n);
    return std::all_of(local.point.begin(), local.point.begin() + local.count,
                       [&](const Vec3& y) { return dot(n, y) > height; });
}

/// Tries the caps, and the plane that separates the path's chord from the side: where the shape is the unit ball, that
/// across the chord's point nearest to the centre.
bool is_far_outside(const LocalShape& shape, const Hull& local, double reach) {
    if (shape.is_capped() &&
        (is_beyond_plane(shape, local, {0, 0, 1}, reach) || is_beyond_plane(shape, local, {0, 0, -1}, reach))) {
        return true;
    }
    const CentredEllipsoid& around = shape.around();
    const Vec3 from = in_units(around, local.point[0]);
    const Vec3 step = in_units(around, local.point[static_cast<std::size_t>(local.count - 1)]) - from;
    const double square = length_squared(step);
    const double t = square > 0.0 ? std::clamp(-dot(from, step) / square, 0.0, 1.0) : 0.0;
    const Vec3 nearest = from + t * step;
    if (length_squared(nearest) <= 1.0) return false;
    return is_beyond_plane(shape, local, in_units(around, nearest), reach);
}

}  // namespace

AnalyticShape::AnalyticShape(const AffineMap& world_from_local, const LocalShape& shape)
    : frame_(world_from_local), shape_(shape) {
    for (const Vec3& n : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}) {
        const double size =
            (1.0 + 0x1p-49) * shape_.support({dot(frame_.axis(0), n), dot(frame_.axis(1), n), dot(frame_.axis(2), n)});
        const double padded = size + ulp(max_abs(frame_.center()) + size);
        bounds_.include(frame_.center() + padded * n);
        bounds_.include(frame_.center() - padded * n);
    }
}

AnalyticShape AnalyticShape::ball(const AffineMap& world_from_local) {
    return {world_from_local, LocalShape::ball(column_lengths(world_from_local))};
}

AnalyticShape AnalyticShape::cylinder(const AffineMap& world_from_local) {
    return {world_from_local, LocalShape::cylinder(column_lengths(world_from_local))};
}

template <class Scalar>
LocalSegment<Scalar> AnalyticShape::segment(const Vec3& p, const Vec3& q) const {
    const double size = std::max(length(p - frame_.center()), length(q - frame_.center()));
    if constexpr (std::is_same_v<Scalar, double>) {
        const Vec3 from = frame_.local_point(p);
        const Vec3 to = frame_.local_point(q);
        return {{from.x, from.y, from.z}, {to.x, to.y, to.z}, kRoughError * size, kRoughError};
    } else {
        return {frame_.precise_local_point(p), frame_.precise_local_point(q), kPreciseError * size, kPreciseError};
    }
}

int AnalyticShape::side(const Vec3& p) const {
    const int rough = shape_.side_of_start(segment<double>(p, p));
    return rough != 0 ? rough : shape_.side_of_start(segment<DoubleDouble>(p, p));
}

ShapePoint AnalyticShape::closest_point(const Vec3& p) const {
    const LocalNearest near = shape_.nearest(frame_.precise_local_point(p));
    const Vec3 normal = frame_.world_normal(near.normal);
    const bool is_near = std::fabs(near.distance) < length(near.foot);
    return {is_near ? p - near.distance * normal : frame_.world_point(near.foot), normal, near.distance};
}

std::optional<ShapeContact> AnalyticShape::first_contact(const Path& path, double radius) const {
    const auto contact = ricochet::first_contact(shape_, frame_.local_path(path), radius);
    if (!contact) return std::nullopt;
    return ShapeContact{contact->time, frame_.world_normal(contact->normal), frame_.world_point(contact->foot)};
}

bool AnalyticShape::segment_is_free(const Vec3& p, const Vec3& q) const {
    return shape_.is_free(segment<double>(p, q)) || shape_.is_free(segment<DoubleDouble>(p, q));
}

double AnalyticShape::distance_of_segment(const Vec3& p, const Vec3& q) const {
    if (!segment_is_free(p, q)) return 0.0;
    return shape_.distance_of(frame_.precise_local_point(p), frame_.precise_local_point(q));
}

bool AnalyticShape::clears(const Path& path, double reach) const {
    const Hull hull = hull_of(path);
    if (is_apart(hull, bounds_, reach)) return true;
    Hull local = hull;
    double size = shape_.extent();
    for (int k = 0; k < hull.count; ++k) {
        Vec3& y = local.point[static_cast<std::size_t>(k)];
        y = frame_.local_point(y);
        size = std::max(size, max_abs(y));
    }
    const double widened = reach + kDistanceFieldSlack * size;
    return is_deep_inside(shape_, local, widened) || is_far_outside(shape_, local, widened);
}

}  // namespace ricochet
