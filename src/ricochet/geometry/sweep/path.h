/// \file
/// A piece of a particle's path: a polynomial in time of degree at most 3.
#pragma once

#include <array>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Bezier control points of a path. Their convex hull contains the path and its chords.
struct ControlPoints {
    std::array<Vec3, 4> point;
    int count = 0;

    [[nodiscard]] const Vec3* begin() const { return point.data(); }
    [[nodiscard]] const Vec3* end() const { return point.data() + count; }
};

/// A path p(s) = c[0] + c[1] s + c[2] s^2 + c[3] s^3 for s in [0, duration], in seconds and metres. Both end points are
/// stored values. c[0] is the particle's position, and `end` becomes its next position.
struct Path {
    std::array<Vec3, 4> c;  ///< coefficients; c[k] = 0 for k > degree
    int degree = 1;         ///< 1 line, 2 parabola, 3 cubic
    double duration = 0.0;  ///< in s, >= 0
    Vec3 end;               ///< position at s = duration, rounded once

    /// Returns the position at time s: exactly c[0] at 0 and exactly `end` at `duration`.
    [[nodiscard]] Vec3 position(double s) const;
    /// Returns the velocity at time s, in m/s.
    [[nodiscard]] Vec3 velocity(double s) const;
    /// Returns an upper bound, in m, on the distance between the path on [from, to] and the chord of this interval.
    [[nodiscard]] double sagitta(double from, double to) const;
    [[nodiscard]] ControlPoints control_points() const;
};

/// Returns the end point of line_path().
[[nodiscard]] Vec3 line_end(const Vec3& x, const Vec3& v, double duration);
/// Returns the end point of parabola_path().
[[nodiscard]] Vec3 parabola_end(const Vec3& x, const Vec3& v, const Vec3& a, double duration);

/// Returns a straight path from x with velocity v.
[[nodiscard]] Path line_path(const Vec3& x, const Vec3& v, double duration);
/// Returns a parabola from x with velocity v and constant acceleration a.
[[nodiscard]] Path parabola_path(const Vec3& x, const Vec3& v, const Vec3& a, double duration);
/// Returns the cubic with positions x0, x1 and velocities v0, v1 at its ends (Hermite interpolation). `end` is exactly
/// x1. The degree is lower if leading coefficients vanish exactly. The duration must be positive.
[[nodiscard]] Path hermite_path(const Vec3& x0, const Vec3& v0, const Vec3& x1, const Vec3& v1, double duration);

}  // namespace ricochet
