/// \file
/// Private to the simulation: a grid of sleeping spheres, kept as long as the same spheres sleep.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/box_tools.h"
#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/dynamics/particles.h"
#include "ricochet/simulation/lone_motion.h"

namespace ricochet {

/// The boxes of sleeping spheres, each given by its number in a range of particles.
class SleeperGrid {
public:
    /// Computes the boxes again if the set of sleeping spheres has changed. first: first particle of the range.
    void update(const PairTraces& traces, const Particles& particles, std::size_t first);

    [[nodiscard]] bool empty() const { return bounds_.empty(); }
    /// Returns the box of a sleeping sphere.
    [[nodiscard]] const Box3& box(std::uint32_t k) const { return boxes_[k]; }
    /// Returns false if a box is far from all sleepers.
    [[nodiscard]] bool may_be_near(const Box3& box) const { return overlap(box, bounds_); }
    /// Appends all sleepers whose boxes are near a box.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const { grid_.find_near(box, found); }

private:
    NeighbourGrid grid_;
    std::vector<Box3> boxes_;
    Box3 bounds_;                          // box around all sleepers
    std::vector<std::uint8_t> is_asleep_;  // PairTraces::is_asleep of the boxes
    std::uint64_t version_ = 0;            // of the sleeping islands
};

}  // namespace ricochet
