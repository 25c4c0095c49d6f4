/// \file
/// Which positions are the same vertex.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Numbers different positions in the order of their first appearance. Exact comparison: 0 and -0 are equal, positions
/// that are only close are different. Positions must be finite.
class VertexWelder {
public:
    /// Vertices are appended to a list of the caller's.
    explicit VertexWelder(std::vector<Vec3>& vertices) : vertices_(vertices) {}

    /// Reserves for that many different positions: 8 to 16 bytes each, besides the list.
    void reserve(std::size_t positions);
    /// Number of the position; a new one is appended to the list (with -0 stored as 0).
    [[nodiscard]] std::uint32_t index_of(const Vec3& position);

private:
    [[nodiscard]] std::size_t slot_of(const Vec3& position) const;
    void set_slots(std::size_t count);

    std::vector<Vec3>& vertices_;
    std::vector<std::uint32_t> slots_;  // open addressing, power-of-two size, at most half full
};

}  // namespace ricochet
