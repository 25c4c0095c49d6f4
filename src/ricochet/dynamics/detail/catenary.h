/// \file
/// The shape of a hanging rope.
#pragma once

#include <cstddef>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet::detail {

/// `count` >= 2 places at equal distances along an inextensible rope that hangs between two places; up is a unit
/// vector. A rope no longer than the distance of its ends is a straight line; one whose ends are above each other hangs
/// down and comes back on the same line. The first and the last place are exactly the ends.
[[nodiscard]] std::vector<Vec3> catenary(const Vec3& from, const Vec3& to, double length, const Vec3& up,
                                         std::size_t count);

}  // namespace ricochet::detail
