#include "ricochet/geometry/shapes/shape_frame.h"

#include <cmath>

namespace ricochet {
namespace {

using std::size_t;

Vec3 column(const AffineMap& map, int i) { return {map.row_x[i], map.row_y[i], map.row_z[i]}; }

/// The column times a power of two that brings its largest component between 1 and 2.
PreciseVec3 near_one(const Vec3& column) {
    const double scale = std::ldexp(1.0, -std::ilogb(max_abs(column)));
    return {DoubleDouble(scale * column.x), DoubleDouble(scale * column.y), DoubleDouble(scale * column.z)};
}

PreciseVec3 unit(const PreciseVec3& v) { return (DoubleDouble(1.0) / sqrt(dot_of(v, v))) * v; }

bool is_diagonal(const AffineMap& map) {
    return map.row_x.y == 0.0 && map.row_x.z == 0.0 && map.row_y.x == 0.0 && map.row_y.z == 0.0 && map.row_z.x == 0.0 &&
           map.row_z.y == 0.0;
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
    for (size_t i = 0; i < 3; ++i) rounded_axes_[i] = rounded(axes_[i]);
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
    for (size_t k = 1; k <= static_cast<size_t>(path.degree); ++k) {
        for (size_t i = 0; i < 3; ++i) {
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

std::array<double, 3> column_lengths(const AffineMap& map) {
    std::array<double, 3> lengths{};
    for (int i = 0; i < 3; ++i) {
        const Vec3 c = column(map, i);
        const double scale = std::ldexp(1.0, std::ilogb(max_abs(c)));
        const PreciseVec3 v = near_one(c);
        lengths[static_cast<size_t>(i)] = scale * sqrt(dot_of(v, v)).hi;
    }
    return lengths;
}

}  // namespace ricochet
