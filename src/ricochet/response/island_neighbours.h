/// \file
/// Neighbours and times of next contact of an island's members.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/dynamics/neighbour_grid.h"

namespace ricochet {

/// Many times that change one by one, with fast access to the earliest. They are stored as a tree of minima.
class EarliestTime {
public:
    /// Sets all times to infinity.
    void reset(std::size_t count);
    void set(std::size_t index, double time);
    [[nodiscard]] double time_of(std::size_t index) const { return minima_[leaves_ + index]; }
    [[nodiscard]] double earliest() const { return minima_[1]; }
    /// Appends the indices of all times up to `until`, in ascending order.
    void collect(double until, std::vector<std::size_t>& found) const { collect(1, until, found); }

private:
    void collect(std::size_t node, double until, std::vector<std::size_t>& found) const;

    std::size_t leaves_ = 1;  // a power of two
    std::vector<double> minima_{0.0, std::numeric_limits<double>::infinity()};
};

/// Pairs of overlapping boxes, updated as boxes change one by one. Neighbours are listed in ascending order.
class IslandNeighbours {
public:
    /// Finds the neighbours of all boxes that are not empty. They must outlive the object, and each call reads them.
    void begin(const std::vector<Box3>& boxes);
    /// Updates the neighbours of changed boxes. changed: their indices, in ascending order.
    void update(std::span<const std::size_t> changed);
    [[nodiscard]] const std::vector<std::uint32_t>& of(std::size_t index) const { return near_[index]; }

private:
    void sort_all();
    void find(std::size_t index);

    const std::vector<Box3>* boxes_ = nullptr;
    std::vector<std::vector<std::uint32_t>> near_;
    NeighbourGrid grid_;                     // of the boxes at the time when it was built
    std::vector<std::uint8_t> has_changed_;  // 1 for each box that has changed since the grid was built
    std::vector<std::uint32_t> changed_;     // indices of these boxes
};

}  // namespace ricochet
