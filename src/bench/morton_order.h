/// \file
/// Points in an order in which neighbours of the list are neighbours in space.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet::bench {

/// Indices of the points along the Z-curve through the cube of their box, 2^21 cells an axis; equal cells in the order
/// of the list. Points must be finite. Source: G. M. Morton, "A Computer Oriented Geodetic Data Base", IBM, 1966.
[[nodiscard]] std::vector<std::uint32_t> morton_order(std::span<const Vec3> points);

}  // namespace ricochet::bench
