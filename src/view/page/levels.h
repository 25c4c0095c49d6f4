/// \file
/// Numbers rounded to levels, as the page stores them.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "ricochet/core/box3.h"

namespace ricochet {

/// One whole number a row, below 2^bits.
using Levels = std::vector<std::uint16_t>;

/// Numbers of a range as levels 0 to largest; one more level says "not a number" where has_gaps says so.
struct LevelScale {
    double low = 0.0;
    double step = 1.0;
    std::uint16_t largest = 0;
    bool has_gaps = false;

    [[nodiscard]] std::uint16_t level(double value) const;
};

/// Grid of positions: a coordinate is lower + level * step, m.
struct PositionGrid {
    Vec3 lower;
    double step = 1.0;
    std::uint16_t largest = 0;

    [[nodiscard]] LevelScale axis(int axis) const { return {lower[axis], step, largest, false}; }
};
/// How far rounding to a grid of that step may move a point, m: half the diagonal of a cell.
[[nodiscard]] inline double rounding_distance(double step) { return 0.5 * std::sqrt(3.0) * step; }
/// The grid of 2^bits levels along the longest edge of the box.
[[nodiscard]] PositionGrid position_grid(const Box3& box, int bits);

/// The levels of points along one axis.
[[nodiscard]] Levels axis_levels(const std::vector<Vec3>& points, const PositionGrid& grid, int axis);

}  // namespace ricochet
