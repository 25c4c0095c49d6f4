/// \file
/// Axis-aligned box, and Morton codes of points in a box.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Closed axis-aligned box. Empty (lower > upper) if default-constructed.
struct Box3 {
    Vec3 lower{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(),
               std::numeric_limits<double>::infinity()};
    Vec3 upper{-std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
               -std::numeric_limits<double>::infinity()};

    void include(const Vec3& p) {
        lower = min(lower, p);
        upper = max(upper, p);
    }
    void include(const Box3& b) {
        lower = min(lower, b.lower);
        upper = max(upper, b.upper);
    }
    [[nodiscard]] bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
    [[nodiscard]] bool contains(const Vec3& p) const {
        return p.x >= lower.x && p.x <= upper.x && p.y >= lower.y && p.y <= upper.y && p.z >= lower.z && p.z <= upper.z;
    }
    [[nodiscard]] Vec3 center() const { return 0.5 * lower + 0.5 * upper; }
    [[nodiscard]] Vec3 size() const { return upper - lower; }
    /// Returns the length of the space diagonal; 0 if the box is empty.
    [[nodiscard]] double diagonal() const { return empty() ? 0.0 : length(size()); }
};

/// Returns the lowest 21 bits of x, with two zero bits between neighbouring bits.
[[nodiscard]] constexpr std::uint64_t spread_bits(std::uint64_t x) {
    x = (x | x << 32U) & 0x001F00000000FFFFULL;
    x = (x | x << 16U) & 0x001F0000FF0000FFULL;
    x = (x | x << 8U) & 0x100F00F00F00F00FULL;
    x = (x | x << 4U) & 0x10C30C30C30C30C3ULL;
    return (x | x << 2U) & 0x1249249249249249ULL;
}

/// Returns the position of a point along the Z-order curve through 2^21 cells per axis of the box, in 63 bits. Points
/// with close codes are close to each other. Points outside the box belong to the nearest cell. A NaN coordinate counts
/// as cell 0 of its axis.
/// Source: G. M. Morton, "A Computer Oriented Geodetic Data Base", IBM, 1966.
[[nodiscard]] inline std::uint64_t morton_code(const Vec3& p, const Box3& box) {
    constexpr double kCells = 1 << 21;
    const Vec3 size = box.size();
    const auto cell = [&](int axis) {
        const double x = (p[axis] - box.lower[axis]) / size[axis] * kCells;
        return x > 0.0 ? static_cast<std::uint64_t>(std::min(x, kCells - 1.0)) : 0U;
    };
    return spread_bits(cell(0)) | spread_bits(cell(1)) << 1U | spread_bits(cell(2)) << 2U;
}

/// Returns a sort key: the leading bits of the Morton code, then an index below 2^index_bits.
[[nodiscard]] inline std::uint64_t morton_key(const Vec3& p, const Box3& box, std::uint32_t index,
                                              unsigned index_bits) {
    return morton_code(p, box) << 1U >> index_bits << index_bits | index;
}

/// Returns the index in a sort key.
[[nodiscard]] constexpr std::uint32_t index_of_key(std::uint64_t key, unsigned index_bits) {
    return static_cast<std::uint32_t>(key & ((std::uint64_t{1} << index_bits) - 1U));
}

}  // namespace ricochet
