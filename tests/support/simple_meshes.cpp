#include "support/simple_meshes.h"

#include <array>
#include <cstdint>
#include <map>
#include <utility>

namespace ricochet::testing {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Splits each triangle into four and moves the new vertices onto the unit sphere.
TriangleMesh subdivided(const TriangleMesh& coarse) {
    TriangleMesh fine{coarse.vertices, {}};
    std::map<Edge, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
        const auto [found, is_new] =
            middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(fine.vertices.size()));
        if (is_new) fine.vertices.push_back(normalized(fine.vertices[a] + fine.vertices[b]));
        return found->second;
    };
    for (const auto& [a, b, c] : coarse.triangles) {
        const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
        for (const Triangle& t :
             {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}}) {
            fine.triangles.push_back(t);
        }
    }
    return fine;
}

}  // namespace

TriangleMesh box_mesh(const Vec3& lower, const Vec3& upper) {
    TriangleMesh mesh;
    for (unsigned corner = 0; corner < 8; ++corner) {
        mesh.vertices.push_back({(corner & 1U) != 0 ? upper.x : lower.x, (corner & 2U) != 0 ? upper.y : lower.y,
                                 (corner & 4U) != 0 ? upper.z : lower.z});
    }
    mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                      {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
    return mesh;
}

TriangleMesh sphere_mesh(const Vec3& center, double radius, int levels) {
    TriangleMesh mesh{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
                      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}}};
    for (int level = 0; level < levels; ++level) mesh = subdivided(mesh);
    for (Vec3& vertex : mesh.vertices) vertex = center + radius * vertex;
    return mesh;
}

TriangleMesh flipped(TriangleMesh mesh) {
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    return mesh;
}

TriangleMesh merged(TriangleMesh first, const TriangleMesh& second) {
    const auto offset = static_cast<std::uint32_t>(first.vertices.size());
    first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
    for (const auto& [a, b, c] : second.triangles) first.triangles.push_back({a + offset, b + offset, c + offset});
    return first;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& offset) {
    for (Vec3& vertex : mesh.vertices) vertex += offset;
    return mesh;
}

}  // namespace ricochet::testing
