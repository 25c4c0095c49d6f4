/// \file
/// Private to the responses: decides in plain arithmetic whether a particle is above a triangle or beyond its rim.
#pragma once

#include <optional>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/predicates/triangle_plane.h"

namespace ricochet {

/// Returns true if the foot of p on a triangle's plane lies farther than `slack`, in m, beyond the triangle. Returns
/// false if the foot lies inside the triangle, and std::nullopt if the error bound of plain arithmetic allows both. A
/// result agrees with the distance of the computed foot, p less its signed distance times the normal, from the
/// triangle.
[[nodiscard]] std::optional<bool> is_foot_beyond(const TrianglePlane& plane, const Vec3& p, double slack);

}  // namespace ricochet
