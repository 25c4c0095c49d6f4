/// \file
/// Private to triangulation: points of the plane from which some are removed over time.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/geometry/predicates/orient2d.h"

namespace ricochet {

/// A balanced k-d tree over points; finds those near a triangle.
/// Method: J. L. Bentley, "Multidimensional binary search trees used for associative searching", CACM 18(9), 1975.
class PointTree {
public:
    /// Starts over with the given members, places in `points` (which must stay alive and unchanged).
    void build(const std::vector<Point2>& points, std::vector<std::uint32_t> members);
    /// Takes a member out; others are ignored.
    void remove(std::uint32_t member);

    /// Calls visit(member) for the members in boxes that the closed counter-clockwise triangle (a, b, c) meets, and
    /// maybe some others, until it returns true. Returns whether it did.
    template <typename Visit>
    bool any_near_triangle(const Point2& a, const Point2& b, const Point2& c, Visit&& visit) const {
        if (nodes_.empty()) return false;
        std::vector<std::uint32_t>& stack = stack_;
        stack.assign(1, 0);
        while (!stack.empty()) {
            const Node& node = nodes_[stack.back()];
            stack.pop_back();
            if (node.members == 0 || is_apart(node, a, b, c)) continue;
            if (node.first_child != 0) {
                stack.push_back(node.first_child + 1);
                stack.push_back(node.first_child);
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.begin + node.members; ++i) {
                if (visit(members_[i])) return true;
            }
        }
        return false;
    }

private:
    struct Node {
        Point2 lower;
        Point2 upper;
        std::uint32_t begin = 0;        // leaf: members_[begin, begin + members)
        std::uint32_t members = 0;      // that are left below this node
        std::uint32_t first_child = 0;  // the other one follows; 0 for a leaf
        std::uint32_t parent = 0;
    };

    void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
    void fit_box(Node& node) const;
    [[nodiscard]] static bool is_apart(const Node& node, const Point2& a, const Point2& b, const Point2& c);

    const std::vector<Point2>* points_ = nullptr;
    std::vector<std::uint32_t> members_;  // in the order of the leaves
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_;        // per point; kNone for points that are not members
    mutable std::vector<std::uint32_t> stack_;  // scratch of a search
};

}  // namespace ricochet
