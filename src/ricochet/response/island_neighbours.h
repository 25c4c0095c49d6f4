/// \file
/// Private to the responses: what the members of an island look at when they look for who meets whom next.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/dynamics/neighbour_grid.h"

namespace ricochet {

/// The earliest of times that change one by one: a tree of minima.
class EarliestTime {
public:
    /// All are infinite.
    void reset(std::size_t count);
    void set(std::size_t index, double time);
    [[nodiscard]] double time_of(std::size_t index) const { return minima_[leaves_ + index]; }
    [[nodiscard]] double earliest() const { return minima_[1]; }
    /// Appends those up to a time, ascending.
    void collect(double until, std::vector<std::size_t>& found) const { collect(1, until, found); }

private:
    void collect(std::size_t node, double until, std::vector<std::size_t>& found) const;

    std::size_t leaves_ = 1;  // a power of two
    std::vector<double> minima_{0.0, std::numeric_limits<double>::infinity()};
};

/// Whose boxes overlap, while boxes change one by one. Numbers of neighbours are ascending.
class IslandNeighbours {
public:
    /// boxes: empty ones have no neighbours. They must outlive it, and are as they are when they are looked at.
    void begin(const std::vector<Box3>& boxes);
    /// The boxes of some have changed; ascending.
    void update(std::span<const std::size_t> changed);
    [[nodiscard]] const std::vector<std::uint32_t>& of(std::size_t index) const { return near_[index]; }

private:
    void sort_all();
    void find(std::size_t index);

    const std::vector<Box3>* boxes_ = nullptr;
    std::vector<std::vector<std::uint32_t>> near_;
    NeighbourGrid grid_;                     // of the boxes as they were when it was made
    std::vector<std::uint8_t> has_changed_;  // since then
    std::vector<std::uint32_t> changed_;     // those
};

}  // namespace ricochet
