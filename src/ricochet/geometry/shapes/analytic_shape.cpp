#include "ricochet/geometry/shapes/analytic_shape.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Relative errors of a sum of squares, a scalar product and a local coordinate, in doubles and in double-doubles. The
/// bounds cover at least 8 roundings, and about 6 occur. Local: an error bound of this arithmetic.
constexpr double kDoubleError = 0x1p-50;
constexpr double kDoubleDoubleError = 0x1p-98;

/// Addition to the margin in can_cull(), relative to all lengths involved. Local: an error bound of this arithmetic.
constexpr double kCullSlack = 0x1p-44;

bool is_apart(const ControlPoints& hull, const Box3& box, double margin) {
    Box3 reached{hull.point[0], hull.point[0]};
    for (const Vec3& point : hull) reached.include(point);
    for (int i = 0; i < 3; ++i) {
        if (reached.lower[i] > box.upper[i] + margin || reached.upper[i] < box.lower[i] - margin) return true;
    }
    return false;
}

/// Returns y in coordinates in which the shape, or its round part, is the unit ball or disk.
Vec3 in_units(const Ellipsoid& ellipsoid, const Vec3& y) {
    return {y.x / ellipsoid.half_axis(0), y.y / ellipsoid.half_axis(1),
            ellipsoid.axes() == 3 ? y.z / ellipsoid.half_axis(2) : 0.0};
}

/// Returns true if the convex hull of the control points is inside the shape by at least `margin`. The map to the unit
/// ball stretches no length by more than 1 / smallest half axis.
bool is_deep_inside(const LocalShape& shape, const ControlPoints& local, double margin) {
    const Ellipsoid& ellipsoid = shape.ellipsoid();
    const double largest = 1.0 - margin / ellipsoid.smallest();
    if (!(largest > 0.0)) return false;
    return std::all_of(local.begin(), local.end(), [&](const Vec3& y) {
        if (shape.is_capped() && std::fabs(y.z) > shape.half_height() - margin) return false;
        return length_squared(in_units(ellipsoid, y)) <= largest * largest;
    });
}

/// Returns true if the convex hull is beyond the shape's tangent plane perpendicular to n by at least `margin`.
bool is_beyond_plane(const LocalShape& shape, const ControlPoints& local, const Vec3& n, double margin) {
    const double height = shape.support(n) + margin * length(n);
    return std::all_of(local.begin(), local.end(), [&](const Vec3& y) { return dot(n, y) > height; });
}

/// Returns true if the convex hull is certainly outside the shape. Tests the planes of the caps and a tangent plane
/// that can separate the path's chord from the side. In coordinates in which the shape is the unit ball, the normal of
/// this plane points to the chord's point nearest to the centre.
bool is_far_outside(const LocalShape& shape, const ControlPoints& local, double margin) {
    if (shape.is_capped() &&
        (is_beyond_plane(shape, local, {0, 0, 1}, margin) || is_beyond_plane(shape, local, {0, 0, -1}, margin))) {
        return true;
    }
    const Ellipsoid& ellipsoid = shape.ellipsoid();
    const Vec3 from = in_units(ellipsoid, local.point[0]);
    const Vec3 step = in_units(ellipsoid, local.point[static_cast<std::size_t>(local.count - 1)]) - from;
    const double square = length_squared(step);
    const double t = square > 0.0 ? std::clamp(-dot(from, step) / square, 0.0, 1.0) : 0.0;
    const Vec3 nearest = from + t * step;
    if (length_squared(nearest) <= 1.0) return false;
    return is_beyond_plane(shape, local, in_units(ellipsoid, nearest), margin);
}

Vec3 column(const AffineMap& map, int i) { return {map.row_x[i], map.row_y[i], map.row_z[i]}; }

/// Returns the column times a power of two that brings its largest component between 1 and 2.
PreciseVec3 near_one(const Vec3& column) {
    const double scale = std::ldexp(1.0, -std::ilogb(max_abs(column)));
    return {DoubleDouble(scale * column.x), DoubleDouble(scale * column.y), DoubleDouble(scale * column.z)};
}

PreciseVec3 unit(const PreciseVec3& v) { return (DoubleDouble(1.0) / sqrt(dot_of(v, v))) * v; }

bool is_diagonal(const AffineMap& map) {
    return map.row_x.y == 0.0 && map.row_x.z == 0.0 && map.row_y.x == 0.0 && map.row_y.z == 0.0 && map.row_z.x == 0.0 &&
           map.row_z.y == 0.0;
}

/// Returns the lengths of the map's columns, which are a shape's half axes, in m.
std::array<double, 3> column_lengths(const AffineMap& map) {
    std::array<double, 3> lengths{};
    for (int i = 0; i < 3; ++i) {
        const Vec3 c = column(map, i);
        const double scale = std::ldexp(1.0, std::ilogb(max_abs(c)));
        const PreciseVec3 v = near_one(c);
        lengths[static_cast<std::size_t>(i)] = scale * sqrt(dot_of(v, v)).hi;
    }
    return lengths;
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
    return {world_from_local, LocalShape(column_lengths(world_from_local), false)};
}

AnalyticShape AnalyticShape::cylinder(const AffineMap& world_from_local) {
    return {world_from_local, LocalShape(column_lengths(world_from_local), true)};
}

template <class Scalar>
LocalSegment<Scalar> AnalyticShape::segment(const Vec3& p, const Vec3& q) const {
    const double size = std::max(length(p - frame_.center()), length(q - frame_.center()));
    if constexpr (std::is_same_v<Scalar, double>) {
        const Vec3 from = frame_.local_point(p);
        const Vec3 to = frame_.local_point(q);
        return {{from.x, from.y, from.z}, {to.x, to.y, to.z}, kDoubleError * size, kDoubleError};
    } else {
        return {frame_.precise_local_point(p), frame_.precise_local_point(q), kDoubleDoubleError * size,
                kDoubleDoubleError};
    }
}

int AnalyticShape::side(const Vec3& p) const {
    const int rough = shape_.side_of_start(segment<double>(p, p));
    return rough != 0 ? rough : shape_.side_of_start(segment<DoubleDouble>(p, p));
}

ShapePoint AnalyticShape::in_world(ShapePoint near, const Vec3& p) const {
    near.normal = frame_.world_normal(near.normal);
    const bool is_near = std::fabs(near.distance) < length(near.point);
    near.point = is_near ? p - near.distance * near.normal : frame_.world_point(near.point);
    return near;
}

ShapePoint AnalyticShape::closest_point(const Vec3& p) const {
    return in_world(shape_.closest_point(frame_.precise_local_point(p)), p);
}

ShapePoint AnalyticShape::closest_point_of(ShapePart part, const Vec3& p) const {
    return in_world(shape_.closest_point_of(part, frame_.precise_local_point(p)), p);
}

ShapePoint AnalyticShape::closest_point_beyond(ShapePart part, const Vec3& p) const {
    return in_world(shape_.closest_point_beyond(part, frame_.precise_local_point(p)), p);
}

double AnalyticShape::time_over(ShapePart part, const Path& path, double slack) const {
    return part == ShapePart::side ? path.duration : shape_.time_over_cap(frame_.local_path(path), slack);
}

ShapeContacts AnalyticShape::contacts(const Path& path, double radius, const SupportingParts& supports) const {
    ShapeContacts found = contacts_of(shape_, frame_.local_path(path), radius, supports);
    for (std::size_t k = 0; k < found.count; ++k) {
        ShapeContact& contact = found.contacts[k];
        contact.normal = frame_.world_normal(contact.normal);
        contact.point = frame_.world_point(contact.point);
    }
    return found;
}

bool AnalyticShape::segment_is_clear(const Vec3& p, const Vec3& q) const {
    return shape_.is_clear(segment<double>(p, q)) || shape_.is_clear(segment<DoubleDouble>(p, q));
}

double AnalyticShape::distance_to_segment(const Vec3& p, const Vec3& q) const {
    if (!segment_is_clear(p, q)) return 0.0;
    return shape_.distance_of(frame_.precise_local_point(p), frame_.precise_local_point(q));
}

bool AnalyticShape::can_cull(const Path& path, double margin) const {
    const ControlPoints hull = path.control_points();
    if (is_apart(hull, bounds_, margin)) return true;
    ControlPoints local = hull;
    double size = shape_.extent();
    for (int k = 0; k < hull.count; ++k) {
        Vec3& y = local.point[static_cast<std::size_t>(k)];
        y = frame_.local_point(y);
        size = std::max(size, max_abs(y));
    }
    const double widened = margin + kCullSlack * size;
    return is_deep_inside(shape_, local, widened) || is_far_outside(shape_, local, widened);
}

ShapeFrame::ShapeFrame(const AffineMap& world_from_local)
    : center_(world_from_local.translation), is_aligned_(is_diagonal(world_from_local)) {
    if (is_aligned_) {
        axes_ = {PreciseVec3{DoubleDouble(1.0), {}, {}}, PreciseVec3{{}, DoubleDouble(1.0), {}},
                 PreciseVec3{{}, {}, DoubleDouble(1.0)}};
    } else {
        axes_[0] = unit(near_one(column(world_from_local, 0)));
        const PreciseVec3 second = near_one(column(world_from_local, 1));
        axes_[1] = unit(second - dot_of(second, axes_[0]) * axes_[0]);
        axes_[2] = cross_of(axes_[0], axes_[1]);
    }
    for (std::size_t i = 0; i < 3; ++i) rounded_axes_[i] = rounded(axes_[i]);
}

Vec3 ShapeFrame::local_point(const Vec3& p) const {
    const Vec3 w = p - center_;
    if (is_aligned_) return w;
    return {dot(rounded_axes_[0], w), dot(rounded_axes_[1], w), dot(rounded_axes_[2], w)};
}

PreciseVec3 ShapeFrame::precise_local_point(const Vec3& p) const {
    const PreciseVec3 w = difference<DoubleDouble>(p, center_);
    if (is_aligned_) return w;
    return {dot_of(axes_[0], w), dot_of(axes_[1], w), dot_of(axes_[2], w)};
}

LocalPath ShapeFrame::local_path(const Path& path) const {
    LocalPath local;
    local.degree = path.degree;
    local.duration = path.duration;
    const PreciseVec3 start = precise_local_point(path.c[0]);
    local.component[0][0] = start.x;
    local.component[1][0] = start.y;
    local.component[2][0] = start.z;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(path.degree); ++k) {
        for (std::size_t i = 0; i < 3; ++i) {
            local.component[i][k] =
                is_aligned_ ? DoubleDouble(path.c[k][static_cast<int>(i)]) : dot_of(axes_[i], path.c[k]);
        }
    }
    return local;
}

Vec3 ShapeFrame::rotated(const Vec3& local) const {
    if (is_aligned_) return local;
    return local.x * rounded_axes_[0] + local.y * rounded_axes_[1] + local.z * rounded_axes_[2];
}

}  // namespace ricochet
