#include "generators/icosphere.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "generators/planar_region.h"
#include "generators/require.h"

namespace ricochet::meshes {
namespace {

constexpr double kIcosahedronEdge = 1.0514622242382672;  // edge of the icosahedron in the unit sphere
constexpr int kMaxDivisions = 2300;                      // 106 million triangles

std::array<Vec3, 12> icosahedron_corners() {
    const double golden = 0.5 * (1.0 + std::sqrt(5.0));
    std::array<Vec3, 12> corners{{{-1, golden, 0},
                                  {1, golden, 0},
                                  {-1, -golden, 0},
                                  {1, -golden, 0},
                                  {0, -1, golden},
                                  {0, 1, golden},
                                  {0, -1, -golden},
                                  {0, 1, -golden},
                                  {golden, 0, -1},
                                  {golden, 0, 1},
                                  {-golden, 0, -1},
                                  {-golden, 0, 1}}};
    for (Vec3& corner : corners) corner = normalized(corner);
    return corners;
}

constexpr std::array<Triangle, 20> kIcosahedronFaces{{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                      {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                      {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                      {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}}};

/// Builder that numbers vertices without any search: 12 corners, then the inner vertices of 30 edges, then of each
/// face.
class DividedIcosahedron {
public:
    explicit DividedIcosahedron(int divisions) : n_(divisions), corners_(icosahedron_corners()) {
        const auto n = static_cast<std::size_t>(divisions);
        mesh_.vertices.reserve(10 * n * n + 2);
        mesh_.triangles.reserve(20 * n * n);
        mesh_.vertices.assign(corners_.begin(), corners_.end());
    }

    TriangleMesh run() {
        for (const Triangle& face : kIcosahedronFaces) {
            for (std::size_t side = 0; side < 3; ++side) number_edge(face[side], face[(side + 1) % 3]);
        }
        for (const Triangle& face : kIcosahedronFaces) divide(face);
        return std::move(mesh_);
    }

private:
    /// Returns the point with barycentric weights (n - i - j, i, j) / n of a face, on the sphere.
    Vec3 on_sphere(const Triangle& face, int i, int j) const {
        const Vec3 p = static_cast<double>(n_ - i - j) * corners_[face[0]] +
                       static_cast<double>(i) * corners_[face[1]] + static_cast<double>(j) * corners_[face[2]];
        return normalized(p);
    }

    void number_edge(std::uint32_t a, std::uint32_t b) {
        if (a > b) return;  // the neighbouring face adds it
        edge_start_[a][b] = static_cast<std::uint32_t>(mesh_.vertices.size());
        for (int i = 1; i < n_; ++i) mesh_.vertices.push_back(on_sphere({a, b, b}, i, 0));
    }

    std::uint32_t edge_vertex(std::uint32_t a, std::uint32_t b, int step) const {
        return a < b ? edge_start_[a][b] + static_cast<std::uint32_t>(step - 1)
                     : edge_start_[b][a] + static_cast<std::uint32_t>(n_ - step - 1);
    }

    std::uint32_t vertex(const Triangle& face, std::uint32_t inner_start, int i, int j) const {
        const int k = n_ - i - j;
        if (k == n_) return face[0];
        if (i == n_) return face[1];
        if (j == n_) return face[2];
        if (j == 0) return edge_vertex(face[0], face[1], i);
        if (i == 0) return edge_vertex(face[0], face[2], j);
        if (k == 0) return edge_vertex(face[1], face[2], j);
        // Row j has the inner vertices i = 1 .. n - j - 1; rows 1 .. j - 1 are before it.
        const int before = (j - 1) * (n_ - 1) - (j - 1) * j / 2;
        return inner_start + static_cast<std::uint32_t>(before + i - 1);
    }

    void divide(const Triangle& face) {
        const auto inner_start = static_cast<std::uint32_t>(mesh_.vertices.size());
        for (int j = 1; j < n_; ++j) {
            for (int i = 1; i < n_ - j; ++i) mesh_.vertices.push_back(on_sphere(face, i, j));
        }
        for (int j = 0; j < n_; ++j) {
            for (int i = 0; i < n_ - j; ++i) {
                const std::uint32_t right = vertex(face, inner_start, i + 1, j);
                const std::uint32_t up = vertex(face, inner_start, i, j + 1);
                mesh_.triangles.push_back({vertex(face, inner_start, i, j), right, up});
                if (i + j + 1 < n_) mesh_.triangles.push_back({right, vertex(face, inner_start, i + 1, j + 1), up});
            }
        }
    }

    int n_;
    std::array<Vec3, 12> corners_;
    std::array<std::array<std::uint32_t, 12>, 12> edge_start_{};
    TriangleMesh mesh_;
};

}  // namespace

TriangleMesh unit_icosphere(int divisions) { return DividedIcosahedron(divisions).run(); }

int icosphere_divisions(double radius, double edge_length) {
    return std::min(kMaxDivisions, steps_in(kIcosahedronEdge * radius, edge_length));
}

TriangleMesh make_icosphere(const IcosphereShape& shape, double edge_length) {
    require_length("icosphere", "radius", shape.radius);
    TriangleMesh mesh = unit_icosphere(icosphere_divisions(shape.radius, edge_length));
    for (Vec3& p : mesh.vertices) p *= shape.radius;
    return mesh;
}

}  // namespace ricochet::meshes
