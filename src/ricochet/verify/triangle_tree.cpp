#include "ricochet/verify/triangle_tree.h"

#include <algorithm>
#include <utility>

namespace ricochet::verify {
namespace {

constexpr std::size_t kLeafSize = 4;

Box3 box_of(const Corners& t) {
    Box3 box;
    box.include(t.a);
    box.include(t.b);
    box.include(t.c);
    return box;
}

int longest_axis(const Vec3& size) {
    if (size.x >= size.y && size.x >= size.z) return 0;
    return size.y >= size.z ? 1 : 2;
}

}  // namespace

TriangleTree::TriangleTree(std::vector<NamedTriangle> triangles) {
    if (triangles.empty()) return;
    std::vector<Box3> boxes;
    std::vector<std::uint32_t> order;
    for (const NamedTriangle& t : triangles) {
        order.push_back(static_cast<std::uint32_t>(boxes.size()));
        boxes.push_back(box_of(t.corners));
        largest_ = std::max({largest_, max_abs(boxes.back().lower), max_abs(boxes.back().upper)});
    }
    nodes_.reserve(triangles.size());
    build(0, triangles.size(), boxes, order);
    for (const std::uint32_t index : order) {
        triangles_.push_back(triangles[index]);
        boxes_.push_back(boxes[index]);
    }
}

void TriangleTree::build(std::size_t begin, std::size_t end, const std::vector<Box3>& boxes,
                         std::vector<std::uint32_t>& order) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    Box3 box;
    Box3 centres;
    for (std::size_t k = begin; k < end; ++k) {
        box.include(boxes[order[k]]);
        centres.include(boxes[order[k]].center());
    }
    nodes_[index].box = box;
    if (end - begin <= kLeafSize) {
        nodes_[index].first = static_cast<std::uint32_t>(begin);
        nodes_[index].count = static_cast<std::uint32_t>(end - begin);
        return;
    }
    const int axis = longest_axis(centres.size());
    const std::size_t middle = begin + (end - begin) / 2;
    const auto at = [&](std::size_t k) { return order.begin() + static_cast<std::ptrdiff_t>(k); };
    std::nth_element(at(begin), at(middle), at(end), [&](std::uint32_t a, std::uint32_t b) {
        const double first = boxes[a].center()[axis];
        const double second = boxes[b].center()[axis];
        return first != second ? first < second : a < b;
    });
    build(begin, middle, boxes, order);
    nodes_[index].first = static_cast<std::uint32_t>(nodes_.size());
    build(middle, end, boxes, order);
}

}  // namespace ricochet::verify
