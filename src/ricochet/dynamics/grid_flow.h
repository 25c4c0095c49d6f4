/// \file
/// A vector field sampled on a regular grid.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ricochet/dynamics/flow_field.h"

namespace ricochet {

/// Vectors at the points of a grid along the axes. Point (i, j, k) stands at origin + (i, j, k) * spacing and has the
/// number i + counts[0] (j + counts[1] k).
struct VectorGrid {
    Vec3 origin;                            ///< m
    Vec3 spacing{1, 1, 1};                  ///< m, each > 0
    std::array<std::uint32_t, 3> counts{};  ///< points along each axis, >= 1; 1: the same all along that axis
    std::vector<Vec3> values;               ///< one a point
};

/// What a grid says about places beyond its points.
enum class OutsideGrid {
    clamp,  ///< the value at the nearest point of the grid's box
    zero,   ///< nothing
};

/// Trilinear interpolation of the samples (m/s); linear fields come out exactly but for rounding. Steady.
/// Throws InputError when the counts do not fit the values, a spacing is not > 0, or a value is not finite.
[[nodiscard]] FlowPointer make_grid_flow(VectorGrid grid, OutsideGrid outside = OutsideGrid::clamp);

}  // namespace ricochet
