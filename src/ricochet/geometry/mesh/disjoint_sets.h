/// \file
/// Sets that are joined two by two.
#pragma once

#include <cstdint>
#include <numeric>
#include <vector>

namespace ricochet {

/// Union-find with path halving; the smallest member stands for its set, so that results do not depend on the order.
/// Source: R. E. Tarjan, J. van Leeuwen, "Worst-case Analysis of Set Union Algorithms", JACM 31(2), 1984.
class DisjointSets {
public:
    explicit DisjointSets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

    [[nodiscard]] std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a < b) parent_[b] = a;
        if (b < a) parent_[a] = b;
    }
    /// Number of sets.
    [[nodiscard]] std::size_t count() const {
        std::size_t sets = 0;
        for (std::uint32_t i = 0; i < parent_.size(); ++i) sets += parent_[i] == i ? 1 : 0;
        return sets;
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace ricochet
