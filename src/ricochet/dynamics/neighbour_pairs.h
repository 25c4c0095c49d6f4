/// \file
/// Pairs of overlapping boxes, for repeated queries while the boxes change little.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/dynamics/neighbour_grid.h"

namespace ricochet {

/// Cache of neighbour pairs. It stores a grid of slightly enlarged boxes, and a second grid of boxes that have left
/// their enlarged boxes since. While these are few, only pairs of boxes that have been near each other are tested (L.
/// Verlet, Phys. Rev. 159, 1967). If boxes move far between calls, they are not enlarged. The cache only saves time:
/// the pairs are the same without it.
class NeighbourPairs {
public:
    /// Returns pairs like NeighbourGrid::find_pairs().
    const std::vector<NeighbourPair>& find(std::span<const Box3> boxes);
    /// Returns the pairs if only the boxes with the indices `changed`, ascending, differ from the last call.
    const std::vector<NeighbourPair>& update(std::span<const Box3> boxes, std::span<const std::uint32_t> changed);
    [[nodiscard]] const std::vector<NeighbourPair>& all() const { return pairs_; }

    /// Appends boxes like NeighbourGrid::find_near(), in any order, using the boxes of the last call.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const;

private:
    void take(std::span<const Box3> boxes);
    [[nodiscard]] bool take_later(std::span<const Box3> boxes);
    void find_anew(std::span<const Box3> boxes);
    void take_kept();
    void add_pairs_of(std::span<const std::uint32_t> some);

    NeighbourGrid grid_;            // of the kept boxes
    std::vector<Box3> kept_;        // the enlarged box of every box
    std::vector<Box3> boxes_;       // all boxes of the last call
    bool is_larger_ = false;        // kept boxes are enlarged
    bool was_useful_ = false;       // kept boxes have been reused
    int searches_as_they_are_ = 0;  // searches left before boxes are enlarged again
    NeighbourGrid later_grid_;
    std::vector<std::uint32_t> later_;      // the boxes in later_grid_, ascending
    std::vector<std::uint8_t> is_later_;    // flag of every box: its kept box is out of date
    std::vector<std::uint8_t> is_changed_;  // flag of every box, used within a call
    std::vector<NeighbourPair> pairs_;
};

}  // namespace ricochet
