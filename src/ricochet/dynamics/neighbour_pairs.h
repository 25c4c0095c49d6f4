/// \file
/// Pairs of boxes that overlap, asked for again and again while the boxes change little.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/dynamics/neighbour_grid.h"

namespace ricochet {

/// Keeps a grid of somewhat larger boxes than all that it has been asked for, and one of those that have left theirs
/// since. As long as these are few, only pairs of boxes that have been near each other are tested (L. Verlet, Phys.
/// Rev. 159, 1967); where boxes go far from call to call nothing is made larger. What has been kept saves time only:
/// the same pairs come out without it.
class NeighbourPairs {
public:
    /// As NeighbourGrid::find_pairs().
    const std::vector<NeighbourPair>& find(std::span<const Box3> boxes);
    /// The same of boxes of which only those have changed, by their numbers, ascending, since the last call.
    const std::vector<NeighbourPair>& update(std::span<const Box3> boxes, std::span<const std::uint32_t> changed);
    [[nodiscard]] const std::vector<NeighbourPair>& all() const { return pairs_; }

    /// As NeighbourGrid::find_near(), in any order, of the boxes as they were at the last call.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const;

private:
    void take(std::span<const Box3> boxes);
    [[nodiscard]] bool take_later(std::span<const Box3> boxes);
    void find_anew(std::span<const Box3> boxes);
    void take_kept();
    void add_pairs_of(std::span<const std::uint32_t> some);

    NeighbourGrid grid_;            // of the kept boxes
    std::vector<Box3> kept_;        // of all
    std::vector<Box3> boxes_;       // of all, as they were at the last call
    bool is_larger_ = false;        // kept boxes are larger than those that they were made for
    bool was_useful_ = false;       // they have been used again
    int searches_as_they_are_ = 0;  // to come, before boxes are made larger again
    NeighbourGrid later_grid_;
    std::vector<std::uint32_t> later_;      // those in that grid, ascending
    std::vector<std::uint8_t> is_later_;    // of all: the first grid has them as they were
    std::vector<std::uint8_t> is_changed_;  // of all, in a call
    std::vector<NeighbourPair> pairs_;
};

}  // namespace ricochet
