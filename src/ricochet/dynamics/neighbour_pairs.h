/// \file
/// Cache of pairs of overlapping boxes, for repeated queries with boxes that change little.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/dynamics/neighbour_grid.h"

namespace ricochet {

/// Cache of neighbour pairs. It stores a grid of slightly enlarged boxes, the kept boxes. A second grid contains the
/// boxes that have left their kept boxes since. While these are few, only pairs whose kept boxes overlap are tested
/// again (L. Verlet, Phys. Rev. 159, 1967). If boxes move far between calls, they are not enlarged.
class NeighbourPairs {
public:
    /// Returns the same pairs as NeighbourGrid::find_pairs().
    const std::vector<NeighbourPair>& find(std::span<const Box3> boxes);
    /// Returns the pairs if only some boxes differ from the last call. changed: indices of these boxes, ascending.
    const std::vector<NeighbourPair>& update(std::span<const Box3> boxes, std::span<const std::uint32_t> changed);
    [[nodiscard]] const std::vector<NeighbourPair>& all() const { return pairs_; }

    /// Appends the indices of boxes of the last call that have a point in common with `box`, in any order.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const;

private:
    void take(std::span<const Box3> boxes);
    [[nodiscard]] bool take_later(std::span<const Box3> boxes);
    void rebuild(std::span<const Box3> boxes);
    void select_kept_pairs();
    void add_pairs_of(std::span<const std::uint32_t> some);

    NeighbourGrid grid_;           // grid of the kept boxes
    std::vector<Box3> kept_;       // enlarged copy of every box
    std::vector<Box3> boxes_;      // all boxes of the last call
    bool is_larger_ = false;       // true if the kept boxes are enlarged
    bool was_useful_ = false;      // true if the kept boxes have been reused
    int unenlarged_searches_ = 0;  // number of searches before boxes are enlarged again
    NeighbourGrid later_grid_;
    std::vector<std::uint32_t> later_;      // indices of the boxes in later_grid_, ascending
    std::vector<std::uint8_t> is_later_;    // for every box, 1 if its kept box is out of date
    std::vector<std::uint8_t> is_changed_;  // for every box, a flag that is used within a call
    std::vector<NeighbourPair> pairs_;
};

}  // namespace ricochet
