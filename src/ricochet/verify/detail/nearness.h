/// \file
/// Is a place nearer to a surface than it may be? In doubles with their error where that leaves no doubt, with a
/// hundred digits otherwise.
#pragma once

#include "ricochet/core/vec3.h"
#include "ricochet/verify/detail/meeting.h"

namespace ricochet::verify {

/// True when the distance of p from the triangle is below `least` (m, > 0).
[[nodiscard]] bool is_nearer(const Vec3& p, const Corners& triangle, double least);

/// True when the distance of p from the plane through `point` across `normal` (not zero, of any length) is below
/// `least` (m, > 0).
[[nodiscard]] bool is_nearer(const Vec3& p, const Vec3& point, const Vec3& normal, double least);

}  // namespace ricochet::verify
