/// \file
/// Tests whether a segment intersects a triangle, and whether a point is too near to a surface. They use the verifier's
/// own signs and distances.
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet::verify {

// Exact signs of orientation determinants, in the verifier's own arithmetic. The functions use double, then long
// double, if the error bound leaves no doubt. Otherwise they use integers of any length. They share no code with the
// sweep's predicates.

/// Returns the sign of (b - a) x (c - a) . (p - a). It is +1 if (a, b, c) is counter-clockwise as seen from p.
[[nodiscard]] int spatial_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

/// Returns the sign of (b - a) x (p - a) in a coordinate plane. u, v: axes of the plane (0, 1 or 2), with u to the
/// right and v upward.
[[nodiscard]] int planar_sign(int u, int v, const Vec3& a, const Vec3& b, const Vec3& p);

/// Returns the sign of n . (p - point).
[[nodiscard]] int height_sign(const Vec3& n, const Vec3& point, const Vec3& p);

/// Returns true if the three points lie on one line or coincide.
[[nodiscard]] bool on_one_line(const Vec3& a, const Vec3& b, const Vec3& c);

/// The corners of a triangle whose area is not zero.
struct Corners {
    Vec3 a;
    Vec3 b;
    Vec3 c;
};

/// Returns true if the closed segment [p, q], which may be a point, and the closed triangle have a point in common.
[[nodiscard]] bool intersects(const Vec3& p, const Vec3& q, const Corners& triangle);

/// Returns true if a point of the segment other than its start lies on the triangle. The start itself is allowed to lie
/// on the triangle, too.
[[nodiscard]] bool intersects_after_start(const Vec3& p, const Vec3& q, const Corners& triangle);

/// Returns the approximate point at which [p, q] crosses the triangle's plane, or p if the segment lies in this plane.
[[nodiscard]] Vec3 crossing_point(const Vec3& p, const Vec3& q, const Corners& triangle);

// Distance tests. They use doubles if the error bound leaves no doubt, otherwise numbers with a hundred digits.

/// Returns true if the distance of p from the triangle is below `least` (in m, > 0).
[[nodiscard]] bool is_nearer(const Vec3& p, const Corners& triangle, double least);

/// Returns true if the distance of p from a plane is below `least` (in m, > 0). The plane passes through `point` and is
/// perpendicular to `normal` (not zero, of any length).
[[nodiscard]] bool is_nearer(const Vec3& p, const Vec3& point, const Vec3& normal, double least);

}  // namespace ricochet::verify
