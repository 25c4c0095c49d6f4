#include "inspect/mesh_openings.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>

#include "inspect/mesh_topology.h"
#include "ricochet/core/box3.h"
#include "ricochet/geometry/mesh/closed_surface.h"

namespace ricochet {
namespace {

/// Numbers of directions in which a loop is measured: fixed directions, and the most directions across edges. Long
/// loops skip some of their edges.
constexpr int kDirections = 90;
constexpr std::size_t kMostEdges = 512;

/// Returns twice the area that a closed chain encloses, as a vector (M. E. Newell's rule).
Vec3 area_vector(const TriangleMesh& mesh, std::span<const std::uint32_t> loop) {
    Vec3 sum;
    const Vec3& origin = mesh.vertices[loop[0]];
    for (std::size_t k = 0; k < loop.size(); ++k) {
        sum += cross(mesh.vertices[loop[k]] - origin, mesh.vertices[loop[(k + 1) % loop.size()]] - origin);
    }
    return sum;
}

double extent(const TriangleMesh& mesh, std::span<const std::uint32_t> loop, const Vec3& direction) {
    double low = std::numeric_limits<double>::infinity();
    double high = -low;
    for (const std::uint32_t v : loop) {
        const double along = dot(mesh.vertices[v] - mesh.vertices[loop[0]], direction);
        low = std::min(low, along);
        high = std::max(high, along);
    }
    return high - low;
}

double width_of(const TriangleMesh& mesh, std::span<const std::uint32_t> loop) {
    const Vec3 area = area_vector(mesh, loop);
    if (!(length(area) > 0.0)) return 0.0;
    const auto [first, second] = tangent_frame(normalized(area));
    double width = std::numeric_limits<double>::infinity();
    // The smallest extent of a convex outline is across one of its edges.
    const std::size_t stride = 1 + loop.size() / kMostEdges;
    for (std::size_t k = 0; k < loop.size(); k += stride) {
        const Vec3 edge = mesh.vertices[loop[(k + 1) % loop.size()]] - mesh.vertices[loop[k]];
        const Vec3 across = cross(area, edge);
        if (length(across) > 0.0) width = std::min(width, extent(mesh, loop, normalized(across)));
    }
    for (int k = 0; k < kDirections; ++k) {
        const double angle = k * std::numbers::pi / kDirections;
        width = std::min(width, extent(mesh, loop, std::cos(angle) * first + std::sin(angle) * second));
    }
    return width;
}

}  // namespace

std::vector<MeshOpening> openings_of(const TriangleMesh& mesh) {
    std::vector<MeshOpening> openings;
    for (const std::vector<std::uint32_t>& loop : MeshTopology(joined_by_position(mesh)).boundary_loops()) {
        Box3 box;
        for (const std::uint32_t v : loop) box.include(mesh.vertices[v]);
        openings.push_back({width_of(mesh, loop), box.diagonal()});
    }
    return openings;
}

}  // namespace ricochet
