#include "meshes/mesh_checks.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/geometry/predicates/predicates.h"

namespace ricochet::meshes {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Edge> directed_edges(const TriangleMesh& mesh) {
    std::vector<Edge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t corner = 0; corner < 3; ++corner) edges.emplace_back(t[corner], t[(corner + 1) % 3]);
    }
    std::sort(edges.begin(), edges.end());
    return edges;
}

Box3 triangle_box(const TriangleMesh& mesh, const Triangle& t) {
    Box3 box;
    for (const std::uint32_t corner : t) box.include(mesh.vertices[corner]);
    return box;
}

bool apart(const Box3& a, const Box3& b) {
    for (int axis = 0; axis < 3; ++axis) {
        if (a.lower[axis] > b.upper[axis] || b.lower[axis] > a.upper[axis]) return true;
    }
    return false;
}

bool uses(const Triangle& t, std::uint32_t vertex) { return std::find(t.begin(), t.end(), vertex) != t.end(); }

/// Returns true if an edge of `from` that shares no vertex with `other` intersects it.
bool edge_meets(const TriangleMesh& mesh, const Triangle& from, const Triangle& other) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
        const std::uint32_t a = from[corner];
        const std::uint32_t b = from[(corner + 1) % 3];
        if (uses(other, a) || uses(other, b)) continue;
        if (segment_intersects_triangle(mesh.vertices[a], mesh.vertices[b], mesh.vertices[other[0]],
                                        mesh.vertices[other[1]], mesh.vertices[other[2]])) {
            return true;
        }
    }
    return false;
}

bool cross_each_other(const TriangleMesh& mesh, const Triangle& a, const Triangle& b) {
    const auto shared = std::count_if(a.begin(), a.end(), [&](std::uint32_t vertex) { return uses(b, vertex); });
    return shared < 2 && (edge_meets(mesh, a, b) || edge_meets(mesh, b, a));
}

}  // namespace

std::size_t unpaired_edges(const TriangleMesh& mesh) {
    const std::vector<Edge> edges = directed_edges(mesh);
    std::size_t unpaired = 0;
    for (const auto& [from, to] : edges) {
        const auto same = std::equal_range(edges.begin(), edges.end(), Edge{from, to});
        const auto opposite = std::equal_range(edges.begin(), edges.end(), Edge{to, from});
        if (same.second - same.first != 1 || opposite.second - opposite.first != 1) ++unpaired;
    }
    return unpaired;
}

long euler_characteristic(const TriangleMesh& mesh) {
    std::set<Edge> edges;
    for (const auto& [from, to] : directed_edges(mesh)) edges.insert({std::min(from, to), std::max(from, to)});
    return static_cast<long>(mesh.vertices.size()) - static_cast<long>(edges.size()) +
           static_cast<long>(mesh.triangles.size());
}

std::size_t shells(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> parent(mesh.vertices.size());
    std::iota(parent.begin(), parent.end(), 0U);
    const auto root = [&](std::uint32_t v) {
        while (parent[v] != v) v = parent[v] = parent[parent[v]];
        return v;
    };
    std::size_t count = mesh.vertices.size();
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t corner = 1; corner < 3; ++corner) {
            const std::uint32_t a = root(t[0]);
            const std::uint32_t b = root(t[corner]);
            if (a == b) continue;
            parent[a] = b;
            --count;
        }
    }
    return count;
}

std::size_t degenerate_triangles(const TriangleMesh& mesh) {
    const auto flat = [&](const Triangle& t) {
        return are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
    };
    return static_cast<std::size_t>(std::count_if(mesh.triangles.begin(), mesh.triangles.end(), flat));
}

std::size_t unused_vertices(const TriangleMesh& mesh) {
    std::vector<bool> used(mesh.vertices.size(), false);
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t corner : t) used[corner] = true;
    }
    return static_cast<std::size_t>(std::count(used.begin(), used.end(), false));
}

std::size_t self_intersections(const TriangleMesh& mesh) {
    std::vector<std::pair<Box3, const Triangle*>> boxes;
    for (const Triangle& t : mesh.triangles) boxes.emplace_back(triangle_box(mesh, t), &t);
    std::sort(boxes.begin(), boxes.end(),
              [](const auto& a, const auto& b) { return a.first.lower.x < b.first.lower.x; });
    std::size_t count = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (std::size_t j = i + 1; j < boxes.size() && boxes[j].first.lower.x <= boxes[i].first.upper.x; ++j) {
            if (apart(boxes[i].first, boxes[j].first)) continue;
            if (cross_each_other(mesh, *boxes[i].second, *boxes[j].second)) ++count;
        }
    }
    return count;
}

}  // namespace ricochet::meshes
