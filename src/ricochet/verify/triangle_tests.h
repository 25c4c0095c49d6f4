/// \file
/// Does a segment intersect a surface, and is a point too near to one? With the verifier's own signs and distances.
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet::verify {

// Signs of orientation determinants, exact, in an arithmetic of the verifier's own: floating point where its error
// bound leaves no doubt (double, then long double), whole numbers of any length otherwise. Shares nothing with the
// sweep's predicates.

/// Sign of (b - a) x (c - a) . (p - a): +1 on the side from which (a, b, c) turns counter-clockwise.
[[nodiscard]] int spatial_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

/// Sign of (b - a) x (p - a) in the plane of the coordinates `u` and `v` (0, 1 or 2), u to the right and v upward.
[[nodiscard]] int planar_sign(int u, int v, const Vec3& a, const Vec3& b, const Vec3& p);

/// Sign of n . (p - point).
[[nodiscard]] int height_sign(const Vec3& n, const Vec3& point, const Vec3& p);

/// True when the three points lie on one line (or coincide).
[[nodiscard]] bool on_one_line(const Vec3& a, const Vec3& b, const Vec3& c);

/// The corners of a triangle whose area is not zero.
struct Corners {
    Vec3 a;
    Vec3 b;
    Vec3 c;
};

/// True when the closed segment [p, q], which may be a point, and the closed triangle have a point in common.
[[nodiscard]] bool intersects(const Vec3& p, const Vec3& q, const Corners& triangle);

/// The same for a segment whose start may lie on the triangle: true when any other point of it does.
[[nodiscard]] bool intersects_after_start(const Vec3& p, const Vec3& q, const Corners& triangle);

/// About where [p, q] crosses the triangle's plane (rounded); p when it runs in that plane.
[[nodiscard]] Vec3 crossing_point(const Vec3& p, const Vec3& q, const Corners& triangle);

// Is a point nearer to a surface than it may be? In doubles with their error where that leaves no doubt, with a
// hundred digits otherwise.

/// True when the distance of p from the triangle is below `least` (m, > 0).
[[nodiscard]] bool is_nearer(const Vec3& p, const Corners& triangle, double least);

/// True when the distance of p from the plane through `point` across `normal` (not zero, of any length) is below
/// `least` (m, > 0).
[[nodiscard]] bool is_nearer(const Vec3& p, const Vec3& point, const Vec3& normal, double least);

}  // namespace ricochet::verify
