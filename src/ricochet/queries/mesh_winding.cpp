#include "ricochet/queries/mesh_winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>

#include "ricochet/core/parallel.h"
#include "ricochet/geometry/mesh/vertex_welder.h"
#include "ricochet/geometry/mesh/winding_number.h"
#include "ricochet/queries/mesh_index.h"
#include "ricochet/queries/ray_crossings.h"

namespace ricochet {
namespace {

/// Directions of rays. Half-strips extend in the opposite directions. The directions have few significant bits, and are
/// in no plane of symmetry of a grid.
constexpr std::array<Vec3, 3> kDirections{
    {{0.4375, 0.6171875, 1.0}, {-0.8046875, 1.0, 0.3671875}, {1.0, -0.5703125, -0.7421875}}};

/// Rounding of a determinant of two differences of points and a direction, relative to the product of their lengths:
/// about 2^-50, with a margin. Local: an error bound of this arithmetic.
constexpr double kDeterminantRounding = 0x1p-47;

/// Least sum of the magnitudes of the sine and the cosine of a half angle, relative to the lengths by which both are
/// scaled. Below it, rounding could change the angle by more than about 2^-30. This happens if the ray passes very near
/// to a vertex of the boundary. Local: an error bound of this arithmetic.
constexpr double kSmallestSine = 0x1p-20;

/// Returns all directed edges, sorted by the numbers of their ends. The key has the smaller number in its upper half,
/// and the larger one in its lower half. The index is 1 if the edge goes from the smaller to the larger number, else 0.
/// Edges between equal positions are omitted.
std::vector<KeyedIndex> directed_edges(const TriangleMesh& mesh, std::vector<Vec3>& positions) {
    VertexWelder welder(positions);
    welder.reserve(mesh.vertices.size());
    std::vector<std::uint32_t> number(mesh.vertices.size());
    for (std::size_t v = 0; v < number.size(); ++v) number[v] = welder.index_of(mesh.vertices[v]);
    std::vector<KeyedIndex> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t a = number[t[k]];
            const std::uint64_t b = number[t[(k + 1) % 3]];
            if (a != b) edges.push_back({std::min(a, b) << 32U | std::max(a, b), a < b ? 1U : 0U});
        }
    }
    std::vector<KeyedIndex> spare;
    parallel_sort(edges, spare);
    return edges;
}

/// Returns half the solid angle of the half-strip from an edge, seen from the ray's origin. It is positive if the edge
/// turns to the left about the ray. Returns nullopt if the ray passes too near to one end of the edge. Formula: A. van
/// Oosterom and J. Strackee, "The Solid Angle of a Plane Triangle", IEEE Trans. Biomed. Eng. 30, 1983.
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

/// Returns the winding number around the ray's origin, or nullopt if the ray passes too near to a vertex of the
/// boundary.
std::optional<double> winding_number(const MeshIndex& mesh, const Ray& ray) {
    double half_angles = 0.0;
    for (const BoundaryEdge& edge : mesh.boundary()) {
        const std::optional<double> angle = half_angle(edge, ray);
        if (!angle) return std::nullopt;
        half_angles += edge.surplus * *angle;
    }
    thread_local std::vector<RayCrossing> places;
    all_crossings(mesh, {ray, std::numeric_limits<double>::infinity()}, places);
    double crossings = 0.0;
    for (const RayCrossing& place : places) crossings += place.crossing;
    return crossings - half_angles / (2.0 * std::numbers::pi);
}

}  // namespace

std::vector<BoundaryEdge> boundary_of(const TriangleMesh& mesh) {
    std::vector<Vec3> positions;
    const std::vector<KeyedIndex> edges = directed_edges(mesh, positions);
    std::vector<BoundaryEdge> boundary;
    for (std::size_t k = 0; k < edges.size();) {
        const std::uint64_t key = edges[k].key;
        int surplus = 0;
        for (; k < edges.size() && edges[k].key == key; ++k) surplus += edges[k].index == 1 ? 1 : -1;
        if (surplus == 0) continue;
        const Vec3& smaller = positions[key >> 32U];
        const Vec3& larger = positions[key & 0xFFFFFFFFU];
        boundary.push_back({surplus > 0 ? smaller : larger, surplus > 0 ? larger : smaller, std::fabs(surplus)});
    }
    return boundary;
}

double winding_number(const MeshIndex& mesh, const Vec3& point) {
    for (const Vec3& direction : kDirections) {
        if (const auto number = winding_number(mesh, Ray(point, direction))) return *number;
    }
    return winding_number(mesh.mesh(), point);  // fallback: sum over all triangles
}

}  // namespace ricochet
