/// \file
/// The orthonormal frame in which a shape with a formula is an axis-aligned one about the origin: a rotation and a
/// translation, so that distances are those of the world.
#pragma once

#include <array>

#include "ricochet/core/transform.h"
#include "ricochet/core/vec3.h"
#include "ricochet/geometry/sweep/distance_polynomials.h"
#include "ricochet/geometry/sweep/path.h"
#include "ricochet/geometry/sweep/polynomial.h"

namespace ricochet {

/// A path in a shape's frame, with coefficients in double-double: exact to some 2^-98 of their size.
struct LocalPath {
    std::array<std::array<DoubleDouble, 4>, 3> component{};  ///< by axis, ascending; zero above the degree
    int degree = 1;
    double duration = 0.0;  ///< s

    [[nodiscard]] PreciseVec3 position(double s) const;
    [[nodiscard]] Vec3 velocity(double s) const;
    /// Second derivative, m/s^2: linear in s.
    [[nodiscard]] Vec3 acceleration(double s) const;
    /// Third derivative, m/s^3: constant.
    [[nodiscard]] Vec3 jerk() const;
};

/// Where a shape stands: world = center + sum of local_i * axis_i.
class ShapeFrame {
public:
    /// Frame of an affine map whose columns are orthogonal up to rounding (rotation times scale) and not zero. The
    /// columns' directions, made orthonormal in double-double, are the axes; a mirrored axis may point either way.
    explicit ShapeFrame(const AffineMap& world_from_local);

    /// Coordinates of p, rounded: each within 2^-50 |p - center|.
    [[nodiscard]] Vec3 local_point(const Vec3& p) const;
    /// Coordinates of p, each within 2^-98 |p - center|.
    [[nodiscard]] PreciseVec3 precise_local_point(const Vec3& p) const;
    [[nodiscard]] LocalPath local_path(const Path& path) const;

    [[nodiscard]] Vec3 world_point(const Vec3& local) const { return center_ + rotated(local); }
    /// A unit vector stays one.
    [[nodiscard]] Vec3 world_normal(const Vec3& local) const {
        return is_aligned_ ? local : normalized(rotated(local));
    }
    [[nodiscard]] const Vec3& axis(int i) const { return rounded_axes_[static_cast<std::size_t>(i)]; }
    [[nodiscard]] const Vec3& center() const { return center_; }

private:
    [[nodiscard]] Vec3 rotated(const Vec3& local) const;

    Vec3 center_;
    std::array<PreciseVec3, 3> axes_{};
    std::array<Vec3, 3> rounded_axes_{};
    bool is_aligned_ = false;  ///< the axes are those of the world: nothing is rotated
};

/// Lengths of the map's columns: a shape's half axes, m.
[[nodiscard]] std::array<double, 3> column_lengths(const AffineMap& map);

}  // namespace ricochet
