/// \file
/// Cuts a polygon in the plane into triangles by ear clipping. Private to the triangulation.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/geometry/mesh/triangle_mesh.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {

/// A balanced k-d tree over points that finds the points near a triangle.
/// Method: J. L. Bentley, "Multidimensional binary search trees used for associative searching", CACM 18(9), 1975.
class PointTree {
public:
    /// Rebuilds the tree with the given members, which are indices into `points`. `points` must stay alive and
    /// unchanged.
    void build(const std::vector<Point2>& points, std::vector<std::uint32_t> members);
    /// Removes a member. Ignores other indices.
    void remove(std::uint32_t member);

    /// Calls visit(member) for the members in boxes that the closed counter-clockwise triangle (a, b, c) touches, until
    /// visit returns true. May visit other members too. Returns true if a call of visit returned true.
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
        std::uint32_t members = 0;      // number of members that remain below this node
        std::uint32_t first_child = 0;  // index of the first child, followed by the second one; 0 for a leaf
        std::uint32_t parent = 0;
    };

    void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);
    void fit_box(Node& node) const;
    [[nodiscard]] static bool is_apart(const Node& node, const Point2& a, const Point2& b, const Point2& c);

    const std::vector<Point2>* points_ = nullptr;
    std::vector<std::uint32_t> members_;  // in the order of the leaves
    std::vector<Node> nodes_;
    std::vector<std::uint32_t> leaf_of_;        // per point; kNone for points that are not members
    mutable std::vector<std::uint32_t> stack_;  // scratch memory of a search
};

/// Cuts polygons by ear clipping, with exact signs. A corner is tested once at the start and again when one of its
/// neighbours is clipped. The test uses only the reflex corners near the triangle of the corner, which a tree finds, so
/// the time is close to linear. Memory is reused from one polygon to the next.
class EarClipper {
public:
    /// Appends n - 2 triangles of indices into `points`, which has n >= 3 corners in either orientation. Neighbours
    /// must be different corners, but may have equal positions. The triangles have the outline's winding. Returns false
    /// if the outline crosses itself. The triangles then cover the outline, but overlap.
    [[nodiscard]] bool clip(const std::vector<Point2>& points, std::vector<Triangle>& triangles);

private:
    // kTouching also accepts flat ears and ears with corners on their boundary, for outlines that touch themselves.
    enum class Strictness { kSimple, kTouching };

    void start(const std::vector<Point2>& points);
    [[nodiscard]] int turn_at(std::uint32_t corner) const;
    [[nodiscard]] int turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const;
    [[nodiscard]] bool is_ear(std::uint32_t corner, Strictness strictness) const;
    [[nodiscard]] bool fits_between_neighbours(std::uint32_t corner, Strictness strictness) const;
    [[nodiscard]] bool is_free_of_corners(std::uint32_t corner, Strictness strictness) const;
    void clip_all(Strictness strictness, std::vector<Triangle>& triangles);
    void clip_ear(std::uint32_t corner, std::vector<Triangle>& triangles);
    void update(std::uint32_t corner, Strictness strictness);
    void fan_the_rest(std::vector<Triangle>& triangles);

    std::vector<Point2> points_;  // mirrored if necessary, so that the outline is counter-clockwise
    std::vector<std::uint32_t> next_;
    std::vector<std::uint32_t> previous_;
    std::vector<char> is_reflex_;  // corners that an ear must not contain
    std::vector<char> is_queued_;  // corners that were ears at their last test
    std::vector<std::uint32_t> queue_;
    std::uint32_t remaining_ = 0;
    std::uint32_t any_corner_ = 0;  // a corner that is not clipped yet
    PointTree reflex_tree_;
};

}  // namespace ricochet
