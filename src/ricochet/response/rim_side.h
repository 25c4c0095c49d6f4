/// \file
/// Decides in double arithmetic whether a particle is above a triangle or beyond its rim.
#pragma once

#include <optional>

#include "ricochet/core/vec3.h"
#include "ricochet/geometry/predicates/triangle_plane.h"

namespace ricochet {

/// Returns true if the projection of p onto a triangle's plane lies farther than `slack`, in m, outside the triangle.
/// Returns false if the projection lies inside the triangle, and std::nullopt if the error bound of double arithmetic
/// allows both. A result agrees with a test of the distance of the computed projection: p minus its signed distance
/// times the normal.
[[nodiscard]] std::optional<bool> is_foot_beyond(const TrianglePlane& plane, const Vec3& p, double slack);

}  // namespace ricochet
