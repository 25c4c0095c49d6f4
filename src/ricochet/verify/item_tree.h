/// \file
/// The verifier's own bounding volume hierarchy. Private to the verifier.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"

namespace ricochet::verify {

/// Binary tree over numbered items. The owner keeps the boxes of the nodes, so that boxes can change without a new
/// tree. Items are named by their position in the order of the leaves.
class ItemTree {
public:
    ItemTree() = default;
    /// Builds a tree over the items 0 to count - 1. Each node with more than `leaf_size` items divides them into two
    /// halves along the longest side of the box around their centres. center_of(item): the centre of an item.
    ItemTree(std::uint32_t count, std::uint32_t leaf_size, const std::function<Vec3(std::uint32_t)>& center_of);

    /// Returns the items in the order of the leaves.
    [[nodiscard]] const std::vector<std::uint32_t>& order() const { return order_; }
    /// Returns the box of every node. box_of(k): the box of the item at position k.
    [[nodiscard]] std::vector<Box3> boxes(const std::function<Box3(std::uint32_t)>& box_of) const;

    /// Calls visit(k) for the positions in all leaves for which meets(node) is true for the leaf and all nodes above
    /// it.
    template <class Meets, class Visit>
    void visit(const Meets& meets, const Visit& visit) const {
        if (nodes_.empty()) return;
        std::array<std::uint32_t, kMostDepth> open{};
        std::size_t count = 0;
        open[count++] = 0;
        while (count > 0) {
            const std::uint32_t index = open[--count];
            if (!meets(index)) continue;
            const Node& node = nodes_[index];
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k) visit(k);
            if (node.count > 0) continue;
            open[count++] = node.first;
            open[count++] = index + 1;
        }
    }

private:
    struct Node {
        /// First position of a leaf, or second child of another node. The first child is the next node.
        std::uint32_t first = 0;
        std::uint32_t count = 0;  ///< number of items of a leaf; 0 for other nodes
    };

    void build(std::uint32_t begin, std::uint32_t end, std::uint32_t leaf_size,
               const std::function<Vec3(std::uint32_t)>& center_of);

    /// Upper bound of the depth. Repeated halving of 2^32 items gives fewer levels.
    static constexpr std::size_t kMostDepth = 48;

    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;  ///< in depth-first order
};

}  // namespace ricochet::verify
