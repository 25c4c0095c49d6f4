/// \file
/// Union-find over the numbers 0 to count - 1.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace ricochet {

/// Disjoint sets of numbers. The smallest member represents its set, so that results do not depend on the order of the
/// joins. Uses path halving. Source: R. E. Tarjan, J. van Leeuwen, "Worst-case Analysis of Set Union Algorithms",
/// JACM 31(2), 1984.
class DisjointSets {
public:
    DisjointSets() = default;
    explicit DisjointSets(std::size_t count) { reset(count); }

    /// Makes each number a set of its own. Keeps the allocated memory.
    void reset(std::size_t count) {
        parent_.resize(count);
        std::iota(parent_.begin(), parent_.end(), 0U);
    }

    /// Returns the representative of a number's set.
    [[nodiscard]] std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
        return i;
    }

    /// Joins the sets of two numbers. Returns false if both are already in one set.
    bool join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a == b) return false;
        parent_[a < b ? b : a] = a < b ? a : b;
        return true;
    }

    /// Returns the number of sets.
    [[nodiscard]] std::size_t count() const {
        std::size_t sets = 0;
        for (std::uint32_t i = 0; i < parent_.size(); ++i) sets += parent_[i] == i ? 1 : 0;
        return sets;
    }
    /// Returns the number of elements of all sets together.
    [[nodiscard]] std::size_t size() const { return parent_.size(); }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace ricochet
