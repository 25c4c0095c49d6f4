#include "ricochet/geometry/acceleration/point_tree.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace ricochet {
namespace {

constexpr std::uint32_t kLeafSize = 8;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

// Exact: every point of the box is strictly right of the line from a to b when its leftmost corner is.
bool is_right_of(const Point2& lower, const Point2& upper, const Point2& a, const Point2& b) {
    const Point2 leftmost{b.v < a.v ? upper.u : lower.u, b.u > a.u ? upper.v : lower.v};
    return orient2d(a, b, leftmost) < 0;
}

}  // namespace

void PointTree::build(const std::vector<Point2>& points, std::vector<std::uint32_t> members) {
    points_ = &points;
    members_ = std::move(members);
    leaf_of_.assign(points.size(), kNone);
    nodes_.clear();
    if (members_.empty()) return;
    nodes_.emplace_back();
    split(0, 0, static_cast<std::uint32_t>(members_.size()));
}

// Depth is logarithmic, since halves are equal.
void PointTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    nodes_[node].begin = begin;
    nodes_[node].members = end - begin;
    fit_box(nodes_[node]);
    if (end - begin <= kLeafSize) {
        for (std::uint32_t i = begin; i < end; ++i) leaf_of_[members_[i]] = node;
        return;
    }
    const Node& box = nodes_[node];
    const bool along_u = box.upper.u - box.lower.u > box.upper.v - box.lower.v;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(members_.begin() + begin, members_.begin() + middle, members_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const Point2& p = (*points_)[a];
                         const Point2& q = (*points_)[b];
                         return along_u ? p.u < q.u : p.v < q.v;
                     });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node].first_child = child;
    nodes_[child].parent = node;
    nodes_[child + 1].parent = node;
    split(child, begin, middle);
    split(child + 1, middle, end);
}

void PointTree::fit_box(Node& node) const {
    node.lower = node.upper = (*points_)[members_[node.begin]];
    for (std::uint32_t i = node.begin; i < node.begin + node.members; ++i) {
        const Point2& p = (*points_)[members_[i]];
        node.lower = {std::min(node.lower.u, p.u), std::min(node.lower.v, p.v)};
        node.upper = {std::max(node.upper.u, p.u), std::max(node.upper.v, p.v)};
    }
}

void PointTree::remove(std::uint32_t member) {
    if (nodes_.empty() || leaf_of_[member] == kNone) return;
    std::uint32_t node = std::exchange(leaf_of_[member], kNone);
    const auto first = members_.begin() + nodes_[node].begin;
    std::iter_swap(std::find(first, first + nodes_[node].members, member), first + nodes_[node].members - 1);
    for (; node != 0; node = nodes_[node].parent) --nodes_[node].members;
    --nodes_[0].members;
}

bool PointTree::is_apart(const Node& node, const Point2& a, const Point2& b, const Point2& c) {
    if (std::max({a.u, b.u, c.u}) < node.lower.u || std::min({a.u, b.u, c.u}) > node.upper.u ||
        std::max({a.v, b.v, c.v}) < node.lower.v || std::min({a.v, b.v, c.v}) > node.upper.v) {
        return true;
    }
    return is_right_of(node.lower, node.upper, a, b) || is_right_of(node.lower, node.upper, b, c) ||
           is_right_of(node.lower, node.upper, c, a);
}

}  // namespace ricochet
