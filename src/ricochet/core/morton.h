/// \file
/// Places as numbers along the Z-curve: near numbers are near places.
/// Source: G. M. Morton, "A Computer Oriented Geodetic Data Base", IBM, 1966.
#pragma once

#include <algorithm>
#include <cstdint>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// The lowest ten bits of x with two zero bits between neighbours.
[[nodiscard]] constexpr std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | x << 16) & 0x030000FFU;
    x = (x | x << 8) & 0x0300F00FU;
    x = (x | x << 4) & 0x030C30C3U;
    return (x | x << 2) & 0x09249249U;
}

/// The cell of a point among 1024 an axis of the box; points outside belong to the nearest cell, any number will do for
/// places that are no numbers.
[[nodiscard]] inline std::uint32_t morton_code(const Vec3& p, const Box3& box) {
    constexpr double kCells = 1024.0;
    const Vec3 size = box.size();
    const auto cell = [&](int axis) {
        const double place = (p[axis] - box.lower[axis]) / size[axis] * kCells;
        return place > 0.0 ? static_cast<std::uint32_t>(std::min(place, kCells - 1.0)) : 0U;
    };
    return spread_bits(cell(0)) | spread_bits(cell(1)) << 1U | spread_bits(cell(2)) << 2U;
}

}  // namespace ricochet
