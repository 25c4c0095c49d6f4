/// \file
/// Pairs of boxes that overlap, of which a few change and are asked for again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/dynamics/neighbour_grid.h"

namespace ricochet {

/// Keeps a grid of all boxes, and one of those that have changed since.
class NeighbourPairs {
public:
    /// As NeighbourGrid::find_pairs().
    const std::vector<NeighbourPair>& find(std::span<const Box3> boxes);
    /// The same of boxes of which only those have changed, by their numbers, ascending, since the last call.
    const std::vector<NeighbourPair>& update(std::span<const Box3> boxes, std::span<const std::uint32_t> changed);
    [[nodiscard]] const std::vector<NeighbourPair>& all() const { return pairs_; }

    /// As NeighbourGrid::find_near(), of the boxes as they were at the last call.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const;

private:
    NeighbourGrid grid_;
    NeighbourGrid later_grid_;
    std::vector<std::uint32_t> later_;      // those in that grid, ascending
    std::vector<std::uint8_t> is_later_;    // of all: the first grid has them as they were
    std::vector<std::uint8_t> is_changed_;  // of all, in a call
    std::vector<NeighbourPair> pairs_;
};

}  // namespace ricochet
