/// \file
/// Numbers quantized to levels, as stored in the page.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "ricochet/core/box3.h"

namespace ricochet {

/// One integer per row, below 2^bits.
using Levels = std::vector<std::uint16_t>;

/// Quantization of a range of values to the levels 0 to `largest`. If has_gaps is set, level `largest` + 1 means "not a
/// number".
struct LevelScale {
    double low = 0.0;
    double step = 1.0;
    std::uint16_t largest = 0;
    bool has_gaps = false;

    [[nodiscard]] std::uint16_t level(double value) const;
};

/// Grid of positions. A coordinate is lower + level * step, in m.
struct PositionGrid {
    Vec3 lower;
    double step = 1.0;
    std::uint16_t largest = 0;

    [[nodiscard]] LevelScale axis(int axis) const { return {lower[axis], step, largest, false}; }
};
/// Returns the largest distance, in m, by which rounding to a grid of the given step moves a point. It is half the
/// diagonal of a cell.
[[nodiscard]] inline double rounding_distance(double step) { return 0.5 * std::sqrt(3.0) * step; }
/// Returns the grid with 2^bits levels along the longest edge of the box.
[[nodiscard]] PositionGrid position_grid(const Box3& box, int bits);

/// Returns the levels of points along one axis.
[[nodiscard]] Levels axis_levels(const std::vector<Vec3>& points, const PositionGrid& grid, int axis);

}  // namespace ricochet
