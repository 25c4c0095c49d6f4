#include "inspect/self_intersections.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

/// A balanced tree over boxes in double precision. The boxes are not rounded, so no overlap is missed.
class BoxTree {
public:
    explicit BoxTree(const std::vector<Box3>& boxes);

    /// Calls visit(number) for every box that has a common point with the given box. Several threads may call this
    /// function at the same time.
    template <typename Visit>
    void for_each_overlap(const Box3& box, Visit&& visit) const {
        std::array<std::uint32_t, kMaxLevels> stack;
        std::size_t size = 0;
        if (!nodes_.empty()) stack[size++] = 0;
        while (size > 0) {
            const Node& node = nodes_[stack[--size]];
            if (!boxes_overlap(node.box, box)) continue;
            if (node.first_child != 0) {
                stack[size++] = node.first_child;
                stack[size++] = node.first_child + 1;
                continue;
            }
            for (std::uint32_t i = node.begin; i < node.end; ++i) {
                if (boxes_overlap(boxes_[order_[i]], box)) visit(order_[i]);
            }
        }
    }

private:
    // Each split divides the boxes of a node into two halves, so fewer than 2^32 boxes give at most 32 levels. The
    // stack contains at most one waiting node for each level.
    static constexpr std::size_t kMaxLevels = 64;

    struct Node {
        Box3 box;
        std::uint32_t begin = 0;  // the node's boxes are order_[begin, end)
        std::uint32_t end = 0;
        std::uint32_t first_child = 0;  // index of the first child; the second child is the next node; 0 for a leaf
    };

    [[nodiscard]] static bool boxes_overlap(const Box3& a, const Box3& b) {
        return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
               a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
    }
    void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

    const std::vector<Box3>& boxes_;
    std::vector<std::uint32_t> order_;
    std::vector<Node> nodes_;
};

BoxTree::BoxTree(const std::vector<Box3>& boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    if (boxes.empty()) return;
    nodes_.emplace_back();
    split(0, 0, static_cast<std::uint32_t>(boxes.size()));
}

void BoxTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
    constexpr std::uint32_t kLeafSize = 4;
    Box3 box;
    for (std::uint32_t i = begin; i < end; ++i) box.include(boxes_[order_[i]]);
    nodes_[node].box = box;
    nodes_[node].begin = begin;
    nodes_[node].end = end;
    if (end - begin <= kLeafSize) return;
    const Vec3 size = box.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(
        order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](std::uint32_t a, std::uint32_t b) {
            return boxes_[a].lower[axis] + boxes_[a].upper[axis] < boxes_[b].lower[axis] + boxes_[b].upper[axis];
        });
    const auto child = static_cast<std::uint32_t>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    nodes_[node].first_child = child;
    split(child, begin, middle);
    split(child + 1, middle, end);
}

// Two triangles whose common vertices come first, in the same order.
struct TrianglePair {
    Triangle first;
    Triangle second;
    int shared = 0;
};

TrianglePair align(Triangle first, Triangle second) {
    TrianglePair pair{first, second, 0};
    for (std::size_t i = 0; i < 3; ++i) {
        const auto at = std::find(pair.second.begin() + pair.shared, pair.second.end(), first[i]);
        if (at == pair.second.end()) continue;
        const auto next = static_cast<std::size_t>(pair.shared);
        std::iter_swap(at, pair.second.begin() + pair.shared);
        std::swap(pair.first[i], pair.first[next]);
        ++pair.shared;
    }
    return pair;
}

class PairTest {
public:
    explicit PairTest(const TriangleMesh& mesh) : mesh_(mesh) {}

    [[nodiscard]] bool operator()(std::uint32_t i, std::uint32_t j) const {
        const TrianglePair pair = align(mesh_.triangles[i], mesh_.triangles[j]);
        switch (pair.shared) {
            case 0:
                return cross(pair.first, pair.second);
            case 1:
                return intersect_besides_vertex(pair);
            case 2:
                return overlap_in_plane(pair);
            default:
                return true;
        }
    }

private:
    [[nodiscard]] const Vec3& at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }

    [[nodiscard]] bool edge_intersects(std::uint32_t p, std::uint32_t q, const Triangle& t) const {
        return segment_intersects_triangle(at(p), at(q), at(t[0]), at(t[1]), at(t[2]));
    }

    // Triangles without a common vertex intersect if an edge of one intersects the other.
    [[nodiscard]] bool cross(const Triangle& s, const Triangle& t) const {
        return edge_intersects(s[0], s[1], t) || edge_intersects(s[1], s[2], t) || edge_intersects(s[2], s[0], t) ||
               edge_intersects(t[0], t[1], s) || edge_intersects(t[1], t[2], s) || edge_intersects(t[2], t[0], s);
    }

    // If triangles with one common vertex intersect elsewhere, the edge opposite the vertex in one triangle intersects
    // the other triangle.
    [[nodiscard]] bool intersect_besides_vertex(const TrianglePair& pair) const {
        return edge_intersects(pair.first[1], pair.first[2], pair.second) ||
               edge_intersects(pair.second[1], pair.second[2], pair.first);
    }

    // Triangles with a common edge overlap if they are in one plane and on the same side of the edge.
    [[nodiscard]] bool overlap_in_plane(const TrianglePair& pair) const {
        const Vec3& a = at(pair.first[0]);
        const Vec3& b = at(pair.first[1]);
        const Vec3& c = at(pair.first[2]);
        const Vec3& d = at(pair.second[2]);
        if (orient3d(a, b, c, d) != 0) return false;
        return point_on_triangle(d, a, b, c) || point_on_triangle(c, a, b, d) ||
               segment_intersects_triangle(a, d, b, c, c) || segment_intersects_triangle(b, d, a, c, c);
    }

    const TriangleMesh& mesh_;
};

/// The boxes of all triangles with a nonzero area, and the numbers of these triangles.
struct TriangleBoxes {
    explicit TriangleBoxes(const TriangleMesh& mesh) {
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const Triangle& t = mesh.triangles[i];
            if (are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) continue;
            Box3 box;
            for (const std::uint32_t v : t) box.include(mesh.vertices[v]);
            boxes.push_back(box);
            numbers.push_back(i);
        }
    }

    std::vector<std::uint32_t> numbers;
    std::vector<Box3> boxes;
};

/// The largest number of tests of triangle pairs is kPairTests + kPairTestsPerTriangle * triangles. With a lower limit,
/// the count would be incomplete for ordinary meshes. With a higher limit, meshes whose triangles all cross each other
/// would take too much time.
constexpr std::size_t kPairTestsPerTriangle = 256;
constexpr std::size_t kPairTests = std::size_t{1} << 20;
constexpr std::size_t kPairBlock = 256;  // number of consecutive triangles in a block
constexpr std::size_t kPairBlocks = 16;  // number of blocks tested in parallel

/// Search for the intersections of a range of triangles with triangles of higher index. The search can stop and
/// continue.
struct PairSearch {
    std::size_t next = 0;  ///< next triangle to test
    std::size_t end = 0;
    std::size_t pairs = 0;  ///< number of pairs found so far
    std::size_t tests = 0;  ///< number of tests made so far

    /// Continues the search. Stops after the triangle at which `most` further tests have been made.
    void go_on(const BoxTree& tree, const std::vector<Box3>& boxes, const std::vector<std::uint32_t>& numbers,
               const PairTest& intersect, std::size_t most) {
        const std::size_t last = tests + most;
        for (; next < end && tests < last; ++next) {
            tree.for_each_overlap(boxes[next], [&](std::uint32_t j) {
                if (j <= next) return;
                ++tests;
                pairs += intersect(numbers[next], numbers[j]) ? 1 : 0;
            });
        }
    }
};

}  // namespace

SelfIntersections find_self_intersections(const TriangleMesh& mesh) {
    const TriangleBoxes triangles(mesh);
    const std::vector<std::uint32_t>& numbers = triangles.numbers;
    const std::vector<Box3>& boxes = triangles.boxes;
    const BoxTree tree(boxes);
    const PairTest intersect(mesh);
    std::size_t left = kPairTests + kPairTestsPerTriangle * boxes.size();
    SelfIntersections result;
    // The blocks tested in parallel share the remaining tests equally. Blocks that need more tests continue one after
    // the other. The triangle at which the search ends therefore does not depend on the number of threads.
    for (std::size_t begin = 0; begin < boxes.size() && left > 0; begin += kPairBlocks * kPairBlock) {
        std::array<PairSearch, kPairBlocks> searches;
        parallel_for_blocks(kPairBlocks, 1, [&](std::size_t, std::size_t first, std::size_t last) {
            for (std::size_t k = first; k < last; ++k) {
                searches[k] = {std::min(boxes.size(), begin + k * kPairBlock),
                               std::min(boxes.size(), begin + (k + 1) * kPairBlock)};
                searches[k].go_on(tree, boxes, numbers, intersect, left / kPairBlocks);
            }
        });
        for (const PairSearch& search : searches) left -= std::min(left, search.tests);
        for (PairSearch& search : searches) {
            const std::size_t before = search.tests;
            search.go_on(tree, boxes, numbers, intersect, left);
            left -= std::min(left, search.tests - before);
            result.pairs += search.pairs;
            result.are_all = result.are_all && search.next == search.end;
        }
        result.are_all = result.are_all && (left > 0 || begin + kPairBlocks * kPairBlock >= boxes.size());
    }
    return result;
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> intersections_between(const TriangleMesh& mesh,
                                                                           const std::vector<std::uint32_t>& part_of,
                                                                           std::size_t most) {
    const PairTest intersect(mesh);
    const TriangleBoxes triangles(mesh);
    const std::vector<std::uint32_t>& numbers = triangles.numbers;
    const BoxTree tree(triangles.boxes);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    std::size_t left = kPairTests + kPairTestsPerTriangle * numbers.size();
    for (std::size_t i = 0; i < numbers.size() && pairs.size() < most && left > 0; ++i) {
        tree.for_each_overlap(triangles.boxes[i], [&](std::uint32_t j) {
            if (j <= i || left == 0) return;
            --left;
            if (part_of[numbers[i]] == part_of[numbers[j]] || pairs.size() == most) return;
            if (intersect(numbers[i], numbers[j])) pairs.emplace_back(numbers[i], numbers[j]);
        });
    }
    return pairs;
}

}  // namespace ricochet
