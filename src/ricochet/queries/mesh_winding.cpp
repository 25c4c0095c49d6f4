#include "ricochet/queries/mesh_winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <tuple>

#include "ricochet/geometry/mesh/mesh_openings.h"
#include "ricochet/queries/mesh_index.h"
#include "ricochet/queries/ray_places.h"

namespace ricochet {
namespace {

/// Directions of rays, against which half-strips go. They have few bits, and lie in no plane of symmetry of a grid.
constexpr std::array<Vec3, 3> kDirections{
    {{0.4375, 0.6171875, 1.0}, {-0.8046875, 1.0, 0.3671875}, {1.0, -0.5703125, -0.7421875}}};

/// Rounding of a determinant of two differences of points and a direction, as a part of the product of their lengths:
/// some 2^-50, with room to spare.
constexpr double kDeterminantRounding = 0x1p-47;

/// Sine and cosine of a half angle, times a length of some 1, below which rounding would lose more than some 2^-30 of
/// the angle: where the ray passes so near to a vertex of the boundary.
constexpr double kSmallestSine = 0x1p-20;

/// Returns for every vertex the first vertex at its position.
std::vector<std::uint32_t> first_at_position(const std::vector<Vec3>& vertices) {
    std::vector<std::uint32_t> order(vertices.size());
    std::iota(order.begin(), order.end(), 0U);
    const auto key = [&](std::uint32_t v) { return std::tuple(vertices[v].x, vertices[v].y, vertices[v].z); };
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t v, std::uint32_t w) { return key(v) != key(w) ? key(v) < key(w) : v < w; });
    std::vector<std::uint32_t> first(vertices.size());
    for (std::size_t k = 0; k < order.size(); ++k) {
        const bool is_same = k > 0 && key(order[k - 1]) == key(order[k]);
        first[order[k]] = is_same ? first[order[k - 1]] : order[k];
    }
    return first;
}

/// A directed edge by its vertices, the smaller number first, and +1 if it goes from that one to the other.
struct DirectedEdge {
    std::array<std::uint32_t, 2> ends;
    int sense;
};

std::vector<DirectedEdge> directed_edges(const TriangleMesh& mesh) {
    const std::vector<std::uint32_t> first = first_at_position(mesh.vertices);
    std::vector<DirectedEdge> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = first[t[k]];
            const std::uint32_t b = first[t[(k + 1) % 3]];
            if (a != b) edges.push_back({{std::min(a, b), std::max(a, b)}, a < b ? 1 : -1});
        }
    }
    std::sort(edges.begin(), edges.end(), [](const DirectedEdge& x, const DirectedEdge& y) { return x.ends < y.ends; });
    return edges;
}

/// Returns half the solid angle of the half-strip from an edge, seen from the ray's origin, positive where the edge
/// turns to the left about the ray; nothing if the ray passes too near to one of its ends. The formula is that of A.
/// van Oosterom and J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 30, 1983.
std::optional<double> half_angle(const BoundaryEdge& edge, const Ray& ray) {
    const Vec3 a = edge.from - ray.origin;
    const Vec3 b = edge.to - ray.origin;
    const Vec3& d = ray.direction;
    const double la = length(a);
    const double lb = length(b);
    const double ld = length(d);
    const double size = la * lb * ld;
    double sine = dot(a, cross(b, d));
    const double cosine = size + dot(a, b) * ld - dot(a, d) * lb - dot(b, d) * la;
    if (std::fabs(sine) + std::fabs(cosine) <= kSmallestSine * size) return std::nullopt;
    if (std::fabs(sine) <= kDeterminantRounding * size) {
        sine = std::copysign(sine, moved_side(ray, edge.from, edge.to));
    }
    return std::atan2(sine, cosine);
}

/// Returns the winding number around the ray's origin; nothing if the ray passes too near to a vertex of the boundary.
std::optional<double> winding_number(const MeshIndex& mesh, const Ray& ray) {
    double half_angles = 0.0;
    for (const BoundaryEdge& edge : mesh.boundary()) {
        const std::optional<double> angle = half_angle(edge, ray);
        if (!angle) return std::nullopt;
        half_angles += edge.surplus * *angle;
    }
    thread_local std::vector<RayPlace> places;
    all_places(mesh, {ray, std::numeric_limits<double>::infinity()}, places);
    double crossings = 0.0;
    for (const RayPlace& place : places) crossings += place.crossing;
    return crossings - half_angles / (2.0 * std::numbers::pi);
}

}  // namespace

std::vector<BoundaryEdge> boundary_of(const TriangleMesh& mesh) {
    const std::vector<DirectedEdge> edges = directed_edges(mesh);
    std::vector<BoundaryEdge> boundary;
    for (std::size_t k = 0; k < edges.size();) {
        const auto& [u, v] = edges[k].ends;
        int surplus = 0;
        std::size_t end = k;
        for (; end < edges.size() && edges[end].ends == edges[k].ends; ++end) surplus += edges[end].sense;
        const std::uint32_t from = surplus > 0 ? u : v;
        const std::uint32_t to = surplus > 0 ? v : u;
        if (surplus != 0) boundary.push_back({mesh.vertices[from], mesh.vertices[to], std::fabs(surplus)});
        k = end;
    }
    return boundary;
}

double winding_number(const MeshIndex& mesh, const Vec3& point) {
    for (const Vec3& direction : kDirections) {
        if (const auto number = winding_number(mesh, Ray(point, direction))) return *number;
    }
    return winding_number(mesh.mesh(), point);  // triangle by triangle
}

}  // namespace ricochet
