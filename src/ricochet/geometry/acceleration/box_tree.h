/// \file
/// Bounding volume hierarchy for boxes that move from step to step. A query finds all boxes that intersect a given box.
/// The hierarchy is refitted to the moved boxes, and rebuilt if refitting has made it inefficient. The result of a
/// query does not depend on this.
///
/// A node stores four children side by side, in single precision and rounded outward. One comparison tests all of them
/// (H. Dammertz, J. Hanika, A. Keller, "Shallow bounding volume hierarchies for fast SIMD ray tracing of incoherent
/// rays", EGSR 2008). A test of the boxes in double precision then decides.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/box_tools.h"
#include "ricochet/core/parallel.h"

namespace ricochet {

/// A tree over boxes. Queries are safe from any number of threads, but not concurrently with fit().
class BoxTree {
public:
    /// Replaces the boxes, none of which may be empty. The number of boxes may change.
    void fit(std::span<const Box3> boxes) {
        fit(boxes.size(), [&](std::uint32_t i) { return boxes[i]; });
    }
    /// Replaces the boxes by box_of(i) for i below `count`. box_of is called from any number of threads.
    template <class BoxOf>
    void fit(std::size_t count, const BoxOf& box_of) {
        if (count != order_.size() || count == 0) {
            build(all_boxes(count, box_of));
            return;
        }
        place_boxes(box_of);
        if (place_branches() <= kRebuildCostRatio * cost_when_built_) return;
        build(all_boxes(count, box_of));
    }

    /// Calls visit(i) for every box that has a point in common with `box`, in no particular order.
    template <class Visit>
    void near(const Box3& box, const Visit& visit) const {
        static_cast<void>(any_near(box, [&](std::uint32_t i) {
            visit(i);
            return false;
        }));
    }
    /// Visits boxes like near() until is_it(i) returns true for one of them. Returns true if this happens.
    template <class IsIt>
    [[nodiscard]] bool any_near(const Box3& box, const IsIt& is_it) const {
        if (nodes_.empty()) return false;
        const Bounds sought = outward(box);
        std::array<std::uint32_t, kMostOpen> open;
        std::size_t count = 0;
        open[count++] = 0;
        while (count > 0) {
            const Node& node = nodes_[open[--count]];
            const Mask meeting = lanes_meeting(node, sought);
            if (std::bit_cast<std::array<std::uint64_t, 2>>(meeting) == std::array<std::uint64_t, 2>{}) continue;
            for (std::size_t lane = 0; lane < kLanes; ++lane) {
                if (meeting[lane] == 0) continue;
                const std::uint32_t child = node.child[lane];
                if ((child & kBox) == 0) {
                    open[count++] = child;
                } else if (const std::uint32_t k = child & ~kBox; overlap(boxes_[k], box) && is_it(order_[k])) {
                    return true;
                }
            }
        }
        return false;
    }
    /// Returns true if a box has a point in common with `box`.
    [[nodiscard]] bool has_near(const Box3& box) const {
        return any_near(box, [](std::uint32_t) { return true; });
    }
    /// Returns a box around all boxes. It is empty if there are no boxes.
    [[nodiscard]] const Box3& bounds() const { return bounds_; }

private:
    using Quad = float __attribute__((vector_size(16)));
    using Mask = int __attribute__((vector_size(16)));
    static constexpr std::size_t kLanes = 4;
    /// Flag of a child that is a box. The other bits are the box's position in the order of the leaves.
    static constexpr std::uint32_t kBox = 0x80000000U;
    static constexpr std::uint32_t kNoChild = 0xFFFFFFFFU;

    struct Bounds {
        std::array<float, 3> lower;
        std::array<float, 3> upper;
    };
    /// Bounds of four children. The bounds of a missing child are NaN.
    struct alignas(64) Node {
        Quad lower_x, lower_y, lower_z;
        Quad upper_x, upper_y, upper_z;
        std::array<std::uint32_t, kLanes> child;  ///< index of a node, or a box
    };

    [[nodiscard]] static Bounds outward(const Box3& box);
    [[nodiscard]] static Bounds bounds_of(const Node& node);
    static void place(Node& node, std::size_t lane, const Bounds& bounds) {
        node.lower_x[lane] = bounds.lower[0];
        node.lower_y[lane] = bounds.lower[1];
        node.lower_z[lane] = bounds.lower[2];
        node.upper_x[lane] = bounds.upper[0];
        node.upper_y[lane] = bounds.upper[1];
        node.upper_z[lane] = bounds.upper[2];
    }
    [[nodiscard]] static Mask lanes_meeting(const Node& node, const Bounds& box) {
        const Mask x = (node.lower_x <= box.upper[0]) & (node.upper_x >= box.lower[0]);
        const Mask y = (node.lower_y <= box.upper[1]) & (node.upper_y >= box.lower[1]);
        const Mask z = (node.lower_z <= box.upper[2]) & (node.upper_z >= box.lower[2]);
        return x & y & z;
    }

    template <class BoxOf>
    [[nodiscard]] static std::vector<Box3> all_boxes(std::size_t count, const BoxOf& box_of) {
        std::vector<Box3> boxes(count);
        parallel_for_blocks(count, kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) boxes[i] = box_of(static_cast<std::uint32_t>(i));
        });
        return boxes;
    }
    /// Updates the boxes in the order of the leaves, so that box_of is called for neighbouring boxes in succession.
    template <class BoxOf>
    void place_boxes(const BoxOf& box_of) {
        parallel_for_blocks(nodes_.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                Node& node = nodes_[i];
                for (std::size_t lane = 0; lane < kLanes; ++lane) {
                    if (node.child[lane] == kNoChild || (node.child[lane] & kBox) == 0) continue;
                    const std::uint32_t k = node.child[lane] & ~kBox;
                    boxes_[k] = box_of(order_[k]);
                    place(node, lane, outward(boxes_[k]));
                }
            }
        });
    }
    [[nodiscard]] double place_branches();
    void build(std::span<const Box3> boxes);
    [[nodiscard]] std::uint32_t add_node(std::uint32_t begin, std::uint32_t end, std::span<const Box3> boxes);
    void halve(std::uint32_t begin, std::uint32_t middle, std::uint32_t end, std::span<const Box3> boxes);

    /// Boxes or nodes per unit of parallel work.
    static constexpr std::size_t kBlock = 1 << 13;
    /// Growth of the cost of all branches since the last build, at which the hierarchy is rebuilt. Local, because only
    /// the cost depends on it.
    static constexpr double kRebuildCostRatio = 2.0;
    /// Capacity of the stack of open nodes. Division of 2^31 boxes by four at each level gives at most 17 levels. At
    /// most three children wait on each level except the last.
    static constexpr std::size_t kMostOpen = 64;

    std::vector<Node> nodes_;           ///< in depth-first order
    std::vector<std::uint32_t> order_;  ///< indices of the boxes, in the order of the leaves
    std::vector<Box3> boxes_;           ///< in the same order
    Box3 bounds_;                       ///< encloses all boxes
    double cost_when_built_ = 0.0;
};

}  // namespace ricochet
