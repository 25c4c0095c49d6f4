/// \file
/// Private to the responses: whether a particle is above a triangle or beyond its rim, in plain arithmetic.
#pragma once

#include <optional>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/predicates/triangle_plane.h"

namespace ricochet {

/// Returns true if the foot of p on a triangle's plane lies farther than `slack`, in m, beyond the triangle, and false
/// if it lies inside the triangle. Returns nothing if the error bound of plain arithmetic allows both. An answer agrees
/// with the computed distance of the computed foot, p less its signed distance times the normal, from the triangle.
[[nodiscard]] std::optional<bool> is_foot_beyond(const TrianglePlane& plane, const Vec3& p, double slack);

}  // namespace ricochet
