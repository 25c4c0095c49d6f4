/// \file
/// A piece of a particle's path: a polynomial in time, at most cubic.
#pragma once

#include <array>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Bezier control points of a path: the path and its chords lie in their convex hull.
struct ControlPoints {
    std::array<Vec3, 4> point;
    int count = 0;

    [[nodiscard]] const Vec3* begin() const { return point.data(); }
    [[nodiscard]] const Vec3* end() const { return point.data() + count; }
};

/// p(s) = c[0] + c[1] s + c[2] s^2 + c[3] s^3 for s in [0, duration], seconds and metres. The two end points are stored
/// values: c[0] is the particle's position, `end` is the position that becomes the next state.
struct Path {
    std::array<Vec3, 4> c;  ///< coefficients; c[k] = 0 for k > degree
    int degree = 1;         ///< 1 line, 2 parabola, 3 cubic
    double duration = 0.0;  ///< s, >= 0
    Vec3 end;               ///< position at s = duration, rounded once

    /// Position at s; exactly c[0] at 0 and exactly `end` at duration.
    [[nodiscard]] Vec3 position(double s) const;
    /// Derivative at s, m/s.
    [[nodiscard]] Vec3 velocity(double s) const;
    /// Upper bound of the distance between the path on [from, to] and its chord there, m.
    [[nodiscard]] double sagitta(double from, double to) const;
    [[nodiscard]] ControlPoints control_points() const;
};

/// Where line_path() ends.
[[nodiscard]] Vec3 line_end(const Vec3& x, const Vec3& v, double duration);
/// Where parabola_path() ends.
[[nodiscard]] Vec3 parabola_end(const Vec3& x, const Vec3& v, const Vec3& a, double duration);

/// Straight flight from x with velocity v.
[[nodiscard]] Path line_path(const Vec3& x, const Vec3& v, double duration);
/// Parabola from x with velocity v and constant acceleration a.
[[nodiscard]] Path parabola_path(const Vec3& x, const Vec3& v, const Vec3& a, double duration);
/// The cubic with positions x0, x1 and velocities v0, v1 at its ends (Hermite interpolation); `end` is x1 itself. Of
/// lower degree where its leading coefficients vanish exactly. The duration must be positive.
[[nodiscard]] Path hermite_path(const Vec3& x0, const Vec3& v0, const Vec3& x1, const Vec3& v1, double duration);

}  // namespace ricochet
