/// \file
/// Private to self_intersection: boxes of which the overlapping ones are sought.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ricochet/core/box3.h"

namespace ricochet {

/// A balanced tree over boxes, in double precision: nothing is rounded, so nothing is missed.
class BoxTree {
public:
    explicit BoxTree(const std::vector<Box3>& boxes);

    /// Calls visit(number) for every box that has a point in common with the given one. May be called from several
    /// threads at once.
    template <typename Visit>
    void for_each_overlap(const Box3& box, Visit&& visit) const {
        std::array<std::uint32_t, kMostLevels> stack;
        std::size_t size = 0;
        if (!nodes_.empty()) stack[size++] = 0;
        while (size > 0) {
            const Node& node = nodes_[stack[--size]];
            if (!overlap(node.box, box)) continue;
            if (node.first_child != 0) {
                stack[size++] = node.first_child;
                stack[size++] = node.first_child + 1;
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.end; ++i) {
                if (overlap(boxes_[order_[i]], box)) visit(order_[i]);
            }
        }
    }

private:
    // Halves are equal, so 32-bit numbers of boxes make at most 32 levels, each of which leaves one node waiting.
    static constexpr std::size_t kMostLevels = 64;

    struct Node {
        Box3 box;
        std::uint32_t begin = 0;  // leaf: order_[begin, end)
        std::uint32_t end = 0;
        std::uint32_t first_child = 0;  // the other one follows; 0 for a leaf
    };

    [[nodiscard]] static bool overlap(const Box3& a, const Box3& b) {
        return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
               a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
    }
    void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

    const std::vector<Box3>& boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

}  // namespace ricochet
