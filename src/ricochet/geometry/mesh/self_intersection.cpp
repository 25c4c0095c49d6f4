#include "ricochet/geometry/mesh/self_intersection.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/geometry/acceleration/box_tree.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet {
namespace {

// Two triangles turned so that the vertices that both name come first, in the same order.
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
        const auto place = static_cast<std::size_t>(pair.shared);
        std::iter_swap(at, pair.second.begin() + pair.shared);
        std::swap(pair.first[i], pair.first[place]);
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
                return meet_besides_vertex(pair);
            case 2:
                return lie_on_each_other(pair);
            default:
                return true;
        }
    }

private:
    [[nodiscard]] const Vec3& at(std::uint32_t vertex) const { return mesh_.vertices[vertex]; }

    [[nodiscard]] bool edge_meets(std::uint32_t p, std::uint32_t q, const Triangle& t) const {
        return segment_meets_triangle(at(p), at(q), at(t[0]), at(t[1]), at(t[2]));
    }

    // Triangles without a common vertex meet when an edge of one meets the other.
    [[nodiscard]] bool cross(const Triangle& s, const Triangle& t) const {
        return edge_meets(s[0], s[1], t) || edge_meets(s[1], s[2], t) || edge_meets(s[2], s[0], t) ||
               edge_meets(t[0], t[1], s) || edge_meets(t[1], t[2], s) || edge_meets(t[2], t[0], s);
    }

    // From a common vertex, what else is common reaches an edge that is opposite to it.
    [[nodiscard]] bool meet_besides_vertex(const TrianglePair& pair) const {
        return edge_meets(pair.first[1], pair.first[2], pair.second) ||
               edge_meets(pair.second[1], pair.second[2], pair.first);
    }

    // With a common edge: in one plane and on the same side of the edge.
    [[nodiscard]] bool lie_on_each_other(const TrianglePair& pair) const {
        const Vec3& a = at(pair.first[0]);
        const Vec3& b = at(pair.first[1]);
        const Vec3& c = at(pair.first[2]);
        const Vec3& d = at(pair.second[2]);
        if (orient3d(a, b, c, d) != 0) return false;
        return point_on_triangle(d, a, b, c) || point_on_triangle(c, a, b, d) ||
               segment_meets_triangle(a, d, b, c, c) || segment_meets_triangle(b, d, a, c, c);
    }

    const TriangleMesh& mesh_;
};

}  // namespace

std::size_t count_self_intersections(const TriangleMesh& mesh) {
    const PairTest meet(mesh);
    std::vector<std::uint32_t> numbers;
    std::vector<Box3> boxes;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        if (is_degenerate(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]])) continue;
        Box3 box;
        for (const std::uint32_t v : t) box.include(mesh.vertices[v]);
        boxes.push_back(box);
        numbers.push_back(i);
    }
    const BoxTree tree(boxes);
    std::atomic<std::size_t> pairs{0};
    constexpr std::size_t kBlock = 1024;
    parallel_for_blocks(boxes.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        std::size_t found = 0;
        for (std::size_t i = begin; i < end; ++i) {
            tree.for_each_overlap(boxes[i],
                                  [&](std::uint32_t j) { found += j > i && meet(numbers[i], numbers[j]) ? 1 : 0; });
        }
        pairs += found;
    });
    return pairs;
}

}  // namespace ricochet
