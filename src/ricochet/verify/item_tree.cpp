#include "ricochet/verify/item_tree.h"

#include <algorithm>
#include <numeric>

namespace ricochet::verify {

ItemTree::ItemTree(std::uint32_t count, std::uint32_t leaf_size, const std::function<Vec3(std::uint32_t)>& center_of)
    : order_(count) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (count > 0) build(0, count, leaf_size, center_of);
}

void ItemTree::build(std::uint32_t begin, std::uint32_t end, std::uint32_t leaf_size,
                     const std::function<Vec3(std::uint32_t)>& center_of) {
    const std::size_t index = nodes_.size();
    nodes_.push_back({begin, end - begin});
    if (end - begin <= leaf_size) return;
    Box3 centers;
    for (std::uint32_t k = begin; k < end; ++k) centers.include(center_of(order_[k]));
    const Vec3 size = centers.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const double at_a = center_of(a)[axis];
                         const double at_b = center_of(b)[axis];
                         return at_a != at_b ? at_a < at_b : a < b;
                     });
    build(begin, middle, leaf_size, center_of);
    nodes_[index] = {static_cast<std::uint32_t>(nodes_.size()), 0};
    build(middle, end, leaf_size, center_of);
}

std::vector<Box3> ItemTree::boxes(const std::function<Box3(std::uint32_t)>& box_of) const {
    std::vector<Box3> boxes(nodes_.size());
    for (std::size_t i = nodes_.size(); i-- > 0;) {
        const Node& node = nodes_[i];
        for (std::uint32_t k = node.first; k < node.first + node.count; ++k) boxes[i].include(box_of(k));
        if (node.count > 0) continue;
        boxes[i].include(boxes[i + 1]);
        boxes[i].include(boxes[node.first]);
    }
    return boxes;
}

}  // namespace ricochet::verify
