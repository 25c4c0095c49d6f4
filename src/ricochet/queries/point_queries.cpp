// Queries for points: inside tests, winding numbers, nearest points and signed distances.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/loop_stop.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/sweep/closest_point.h"
#include "ricochet/geometry/sweep/point_sweep.h"
#include "ricochet/queries/mesh_index.h"

namespace ricochet {
namespace {

struct Nearest {
    std::uint32_t triangle;
    ClosestPointOnTriangle point;
};

/// Returns true if x is selected as the nearest triangle instead of y. SignedDistance uses the same order.
bool comes_before(const Nearest& x, const Nearest& y) {
    if (x.point.distance_squared != y.point.distance_squared) {
        return x.point.distance_squared < y.point.distance_squared;
    }
    if (rank(x.point.feature) != rank(y.point.feature)) return rank(x.point.feature) < rank(y.point.feature);
    return x.triangle < y.triangle;
}

std::optional<Nearest> nearest(const MeshIndex& mesh, const Vec3& p, double within) {
    std::optional<Nearest> best;
    mesh.hierarchy().query_point(p, within, [&](std::uint32_t triangle) {
        if (mesh.is_degenerate(triangle)) return within;
        const auto [a, b, c] = mesh.corners(triangle);
        const Nearest found{triangle, closest_point_on_triangle(p, a, b, c)};
        if (best && !comes_before(found, *best)) return within;
        best = found;
        // The distance is rounded up, so that equally near triangles are still visited.
        within = std::min(within, std::sqrt(found.point.distance_squared) * (1.0 + 0x1p-40));
        return within;
    });
    return best;
}

/// Returns the distance of a point from its nearest point. Above a face it uses the distance from the plane, which is
/// more accurate.
double distance(const MeshIndex& mesh, const Nearest& nearest, const Vec3& p) {
    if (nearest.point.feature != TriangleFeature::kFace) return length(nearest.point.offset);
    const auto [a, b, c] = mesh.corners(nearest.triangle);
    return std::fabs(signed_distance(p, a, b, c));
}

/// Calls visit(i) for every point i, in parallel.
template <class Visit>
void for_each_point(std::span<const Vec3> points, const Visit& visit) {
    require_positions(points, "points");
    parallel_for_blocks(points.size(), kQueryBlock, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            poll_loop_stop();
            visit(i);
        }
    });
}

}  // namespace

std::vector<std::uint8_t> MeshQueries::inside(std::span<const Vec3> points, InsideRule rule) const {
    const MeshInterior& interior = index_->interior(rule);
    std::vector<std::uint8_t> results(points.size());
    for_each_point(points, [&](std::size_t i) { results[i] = interior.contains(points[i], rule) ? 1 : 0; });
    return results;
}

std::vector<double> MeshQueries::winding_numbers(std::span<const Vec3> points) const {
    std::vector<double> results(points.size());
    for_each_point(points, [&](std::size_t i) { results[i] = winding_number(*index_, points[i]); });
    return results;
}

NearestPoints MeshQueries::closest_points(std::span<const Vec3> points, double within) const {
    if (!(within >= 0.0))
        throw InputError(fmt::format("within: found {}, expected a distance of at least 0 m", within));
    MeshHits none = no_hits(points.size());
    NearestPoints result{std::move(none.triangle), std::move(none.distance), std::move(none.point)};
    for_each_point(points, [&](std::size_t i) {
        const auto found = nearest(*index_, points[i], within);
        if (!found) return;
        const double far = distance(*index_, *found, points[i]);
        if (far > within) return;
        result.triangle[i] = found->triangle;
        result.distance[i] = far;
        result.point[i] = found->point.point;
    });
    return result;
}

std::vector<double> MeshQueries::signed_distances(std::span<const Vec3> points, InsideRule rule) const {
    const MeshInterior& interior = index_->interior(rule);
    std::vector<double> results(points.size());
    for_each_point(points, [&](std::size_t i) {
        const auto found = nearest(*index_, points[i], kInfinity);
        const double far = found ? distance(*index_, *found, points[i]) : kInfinity;
        results[i] = interior.contains(points[i], rule) ? -far : far;
    });
    return results;
}

}  // namespace ricochet
