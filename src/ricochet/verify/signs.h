/// \file
/// Signs of orientation determinants, exact, in an arithmetic of the verifier's own: floating point where its error
/// bound leaves no doubt (double, then long double), whole numbers of any length otherwise. Shares nothing with the
/// sweep's predicates.
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet::verify {

/// Sign of (b - a) x (c - a) . (p - a): +1 on the side from which (a, b, c) turns counter-clockwise.
[[nodiscard]] int spatial_sign(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

/// Sign of (b - a) x (p - a) in the plane of the coordinates `u` and `v` (0, 1 or 2), u to the right and v upward.
[[nodiscard]] int planar_sign(int u, int v, const Vec3& a, const Vec3& b, const Vec3& p);

/// Sign of n . (p - point).
[[nodiscard]] int height_sign(const Vec3& n, const Vec3& point, const Vec3& p);

/// True when the three points lie on one line (or coincide).
[[nodiscard]] bool on_one_line(const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace ricochet::verify
