#include "ricochet/verify/triangle_tree.h"

#include <algorithm>

namespace ricochet::verify {

TriangleTree::TriangleTree(const std::vector<NamedTriangle>& triangles) {
    constexpr std::uint32_t kLeafSize = 4;
    std::vector<Box3> boxes;
    for (const NamedTriangle& t : triangles) {
        boxes.push_back(enclosing(t.corners.a, t.corners.b, t.corners.c));
        largest_ = std::max({largest_, max_abs(boxes.back().lower), max_abs(boxes.back().upper)});
    }
    tree_ = ItemTree(static_cast<std::uint32_t>(boxes.size()), kLeafSize,
                     [&](std::uint32_t t) { return boxes[t].center(); });
    for (const std::uint32_t t : tree_.order()) {
        triangles_.push_back(triangles[t]);
        boxes_.push_back(boxes[t]);
    }
    node_boxes_ = tree_.boxes([&](std::uint32_t k) { return boxes_[k]; });
}

}  // namespace ricochet::verify
