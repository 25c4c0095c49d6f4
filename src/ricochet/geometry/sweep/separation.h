/// \file
/// How far a place is from a triangle at least: a bound that is proved by a direction, in a hundred operations. The
/// nearest point itself, to the last digits and for any triangle, is in closest_point.h.
///
/// Seen along any direction a triangle lies between its corners, so a place that is beyond all three by some distance
/// is at least that far from the triangle (separating axes, e.g. C. Ericson, "Real-Time Collision Detection", Morgan
/// Kaufmann 2005, section 5.2.1). The bound is good where the direction is that from the nearest point of the triangle;
/// that one needs no care, since a bad direction only gives a smaller bound.
#pragma once

#include "ricochet/core/vec3.h"

namespace ricochet {

/// A direction, of any length, that leads from the triangle's nearest point to p, as plain doubles find it. It may be
/// anything, zero and no number too, for triangles and places that they are not enough for.
[[nodiscard]] Vec3 direction_away(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// p's distance from the triangle (a, b, c) is certainly no less than this, m. Negative or no number where the
/// direction tells nothing. All places between two are as far as the smaller of their bounds along the same direction.
[[nodiscard]] double distance_along(const Vec3& direction, const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace ricochet
