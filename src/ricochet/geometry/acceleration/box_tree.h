/// \file
/// Which boxes meet a box: a hierarchy over boxes that change their places from step to step, in doubles. It is fitted
/// anew to them, and built anew where that has made it poor; what it finds does not depend on that.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"

namespace ricochet {

/// Queries are safe from any number of threads, but not beside fit().
class BoxTree {
public:
    /// The boxes from now on, none of them empty. Their number may differ from before.
    void fit(std::span<const Box3> boxes) {
        fit(boxes.size(), [&](std::uint32_t i) { return boxes[i]; });
    }
    /// The same with box_of(i) for so many i, asked from any number of threads.
    template <class BoxOf>
    void fit(std::size_t count, const BoxOf& box_of) {
        if (count != order_.size() || count == 0) {
            build(all_boxes(count, box_of));
            return;
        }
        place_leaves(box_of);
        if (place_branches() <= kPoor * cost_when_built_) return;
        build(all_boxes(count, box_of));
    }

    /// Calls visit(i) for every box that has a point in common with `box`, in no particular order.
    template <class Visit>
    void near(const Box3& box, const Visit& visit) const {
        if (nodes_.empty()) return;
        std::array<std::uint32_t, kMostDepth> open{};
        std::size_t count = 0;
        open[count++] = 0;
        while (count > 0) {
            const std::uint32_t index = open[--count];
            const Node& node = nodes_[index];
            if (!meet(node.box, box)) continue;
            if (node.count == 0) {
                open[count++] = node.first;
                open[count++] = index + 1;
                continue;
            }
            for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
                if (meet(boxes_[k], box)) visit(order_[k]);
            }
        }
    }
    /// Of all of them; empty where there are none.
    [[nodiscard]] Box3 bounds() const { return nodes_.empty() ? Box3{} : nodes_.front().box; }

    /// True when two boxes have a point in common.
    [[nodiscard]] static bool meet(const Box3& a, const Box3& b) {
        const bool x = (a.lower.x <= b.upper.x) & (b.lower.x <= a.upper.x);
        const bool y = (a.lower.y <= b.upper.y) & (b.lower.y <= a.upper.y);
        const bool z = (a.lower.z <= b.upper.z) & (b.lower.z <= a.upper.z);
        return x & y & z;
    }

private:
    struct Node {
        Box3 box;
        std::uint32_t first = 0;  ///< a leaf's first box; else the second child (the first one is the next node)
        std::uint32_t count = 0;  ///< boxes of a leaf; 0 for others
    };

    template <class BoxOf>
    [[nodiscard]] static std::vector<Box3> all_boxes(std::size_t count, const BoxOf& box_of) {
        std::vector<Box3> boxes(count);
        parallel_for_blocks(count, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) boxes[i] = box_of(static_cast<std::uint32_t>(i));
        });
        return boxes;
    }
    /// In the order of the leaves, so that what lies together is asked for together.
    template <class BoxOf>
    void place_leaves(const BoxOf& box_of) {
        parallel_for_blocks(nodes_.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                Node& node = nodes_[i];
                if (node.count == 0) continue;
                Box3 box;
                for (std::uint32_t k = node.first; k < node.first + node.count; ++k) {
                    boxes_[k] = box_of(order_[k]);
                    box.include(boxes_[k]);
                }
                node.box = box;
            }
        });
    }
    [[nodiscard]] double place_branches();
    void build(std::span<const Box3> boxes);
    void split(std::uint32_t begin, std::uint32_t end, std::span<const Box3> boxes);

    /// Boxes or nodes per unit of parallel work.
    static constexpr std::size_t kBlock = 1 << 13;
    /// Fitted boxes that are larger by this factor, all branches together, are worth a new hierarchy.
    static constexpr double kPoor = 2.0;
    /// Halving 2^32 boxes leaves no more levels than this.
    static constexpr std::size_t kMostDepth = 48;

    std::vector<Node> nodes_;           ///< depth first
    std::vector<std::uint32_t> order_;  ///< numbers of the boxes, in the order of the leaves
    std::vector<Box3> boxes_;           ///< in the same order
    double cost_when_built_ = 0.0;
};

}  // namespace ricochet
