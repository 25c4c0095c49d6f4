#include "ricochet/geometry/acceleration/box_tree.h"

#include <algorithm>
#include <numeric>

namespace ricochet {
namespace {

constexpr std::uint32_t kLeaf = 4;

/// What a query pays for a node, relative to others: the sum of its edges, which flat boxes have too.
double cost(const Box3& box) {
    const Vec3 size = box.size();
    return size.x + size.y + size.z;
}

}  // namespace

void BoxTree::build(std::span<const Box3> boxes) {
    nodes_.clear();
    order_.resize(boxes.size());
    boxes_.resize(boxes.size());
    std::iota(order_.begin(), order_.end(), std::uint32_t{0});
    if (boxes.empty()) return;
    split(0, static_cast<std::uint32_t>(boxes.size()), boxes);
    place_leaves([&](std::uint32_t i) { return boxes[i]; });
    cost_when_built_ = place_branches();
}

/// At the median along the longest side of the box of the centres.
void BoxTree::split(std::uint32_t begin, std::uint32_t end, std::span<const Box3> boxes) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    if (end - begin <= kLeaf) {
        nodes_[index] = {{}, begin, end - begin};
        return;
    }
    Box3 centers;
    for (std::uint32_t k = begin; k < end; ++k) centers.include(boxes[order_[k]].center());
    const Vec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto is_before = [&](std::uint32_t a, std::uint32_t b) {
        const double at_a = boxes[a].lower[axis] + boxes[a].upper[axis];
        const double at_b = boxes[b].lower[axis] + boxes[b].upper[axis];
        return at_a != at_b ? at_a < at_b : a < b;
    };
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, is_before);
    split(begin, middle, boxes);
    nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
    split(middle, end, boxes);
}

/// Children stand behind their parents. Returns the cost of all branches.
double BoxTree::place_branches() {
    double sum = 0.0;
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        Node& node = nodes_[i];
        if (node.count > 0) continue;
        Box3 box = nodes_[i + 1].box;
        box.include(nodes_[node.first].box);
        node.box = box;
        sum += cost(box);
    }
    return sum;
}

}  // namespace ricochet
