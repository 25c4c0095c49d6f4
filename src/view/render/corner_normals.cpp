#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "ricochet/core/parallel.h"
#include "view/render/preview.h"

namespace ricochet {

namespace {

constexpr std::size_t kBlock = 4096;

// Returns the triangle's normal with a length of twice its area.
Vec3 area_vector(const TriangleMesh& mesh, const Triangle& triangle) {
    const Vec3& a = mesh.vertices[triangle[0]];
    return cross(mesh.vertices[triangle[1]] - a, mesh.vertices[triangle[2]] - a);
}

Vec3 unit_or_zero(const Vec3& v) {
    const double norm = length(v);
    return norm > 0.0 && std::isfinite(norm) ? v / norm : Vec3{};
}

// Triangles around each vertex. The entries from offsets[v] to offsets[v + 1] - 1 of `triangles` belong to vertex v.
struct VertexTriangles {
    std::vector<std::uint32_t> offsets, triangles;
};

VertexTriangles triangles_around_vertices(const TriangleMesh& mesh) {
    VertexTriangles around;
    around.offsets.assign(mesh.vertices.size() + 1, 0);
    for (const Triangle& triangle : mesh.triangles) {
        for (const std::uint32_t v : triangle) ++around.offsets[v + 1];
    }
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) around.offsets[v + 1] += around.offsets[v];
    around.triangles.resize(3 * mesh.triangles.size());
    std::vector<std::uint32_t> next(around.offsets.begin(), around.offsets.end() - 1);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : mesh.triangles[t]) around.triangles[next[v]++] = t;
    }
    return around;
}

}  // namespace

std::vector<std::array<Vec3, 3>> corner_normals(const TriangleMesh& mesh, double crease_degrees) {
    const double least_cosine = std::cos(crease_degrees * std::numbers::pi / 180.0);
    const VertexTriangles around = triangles_around_vertices(mesh);
    std::vector<Vec3> areas(mesh.triangles.size());
    std::vector<Vec3> units(mesh.triangles.size());
    for (std::size_t t = 0; t < areas.size(); ++t) {
        areas[t] = area_vector(mesh, mesh.triangles[t]);
        units[t] = unit_or_zero(areas[t]);
    }
    std::vector<std::array<Vec3, 3>> normals(mesh.triangles.size());
    parallel_for_blocks(normals.size(), kBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t t = begin; t < end; ++t) {
            for (std::size_t corner = 0; corner < 3; ++corner) {
                const std::uint32_t v = mesh.triangles[t][corner];
                Vec3 sum;
                for (std::uint32_t k = around.offsets[v]; k < around.offsets[v + 1]; ++k) {
                    const std::uint32_t other = around.triangles[k];
                    if (dot(units[other], units[t]) >= least_cosine) sum += areas[other];
                }
                const Vec3 smooth = unit_or_zero(sum);
                normals[t][corner] = smooth == Vec3{} ? units[t] : smooth;
            }
        }
    });
    return normals;
}

}  // namespace ricochet
