#include "cli/wall_clearance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

namespace ricochet::cli {
namespace {

/// Largest number of moves per ball. A move shifts the ball away from the nearest wall. If a wall blocked the previous
/// move, the move undoes half of it. Corners and gaps need several moves.
constexpr int kMoves = 16;
/// Allowed penetration of a ball through a wall, relative to the ball's radius. The penetration is less than a pixel.
constexpr double kPoke = 0.01;

}  // namespace

/// The balls that still penetrate walls, with their candidate positions.
struct WallClearance::Search {
    std::vector<std::size_t> ball;      // index of the ball in DrawnBalls
    std::vector<Vec3> start;            // position of the particle, in m
    std::vector<Vec3> before;           // position before the last move, in m
    std::vector<Vec3> center;           // current position, in m
    std::vector<double> distance;       // distance to the nearest wall, in m
    std::vector<Vec3> nearest;          // nearest point of the wall, in m
    std::vector<std::uint8_t> blocked;  // 1 if a wall is between the particle and the current position
    double largest = 0.0;               // largest radius, in m

    /// Removes all balls except the given ones.
    void keep(const std::vector<std::size_t>& kept) {
        const auto choose = [&kept](auto& list) {
            for (std::size_t k = 0; k < kept.size(); ++k) list[k] = list[kept[k]];
            list.resize(kept.size());
        };
        choose(ball), choose(start), choose(before), choose(center);
    }
};

void WallClearance::add(TriangleMesh mesh) {
    if (!mesh.triangles.empty()) meshes_.emplace_back(std::move(mesh));
}

void WallClearance::find_nearest(Search& search) const {
    const std::size_t count = search.center.size();
    search.distance.assign(count, std::numeric_limits<double>::infinity());
    search.nearest.assign(count, Vec3{});
    const auto offer = [&](std::size_t k, double distance, const Vec3& point) {
        if (!(distance < search.distance[k])) return;
        search.distance[k] = distance;
        search.nearest[k] = point;
    };
    for (const MeshQueries& mesh : meshes_) {
        const NearestPoints found = mesh.closest_points(search.center, search.largest);
        for (std::size_t k = 0; k < count; ++k) {
            if (found.triangle[k] != kNoHit) offer(k, found.distance[k], found.point[k]);
        }
    }
    for (const PreviewPlane& plane : planes_) {
        for (std::size_t k = 0; k < count; ++k) {
            const double height = dot(search.center[k] - plane.point, plane.normal);
            offer(k, std::fabs(height), search.center[k] - height * plane.normal);
        }
    }
}

void WallClearance::find_blocked(Search& search) const {
    const std::size_t count = search.center.size();
    search.blocked.assign(count, 0);
    std::vector<std::size_t> moved;
    std::vector<Vec3> origins;
    std::vector<Vec3> displacements;
    std::vector<double> lengths;
    for (std::size_t k = 0; k < count; ++k) {
        const Vec3 displacement = search.center[k] - search.start[k];
        if (!(length(displacement) > 0.0)) continue;
        moved.push_back(k), origins.push_back(search.start[k]), displacements.push_back(displacement),
            lengths.push_back(length(displacement));
    }
    for (const MeshQueries& mesh : meshes_) {
        const std::vector<std::uint8_t> hit = mesh.occluded({origins, displacements, lengths});
        for (std::size_t k = 0; k < moved.size(); ++k) search.blocked[moved[k]] |= hit[k];
    }
    for (const PreviewPlane& plane : planes_) {
        for (const std::size_t k : moved) {
            const double before = dot(search.start[k] - plane.point, plane.normal);
            const double after = dot(search.center[k] - plane.point, plane.normal);
            if (before * after < 0.0) search.blocked[k] = 1;
        }
    }
}

void WallClearance::clear(const DrawnBalls& balls) const {
    if (meshes_.empty() && planes_.empty()) return;
    Search search;
    for (std::size_t i = 0; i < balls.centers.size(); ++i) {
        if (!(balls.radii[i] > balls.own[i]) || !is_finite(balls.centers[i])) continue;
        search.ball.push_back(i);
        search.largest = std::max(search.largest, balls.radii[i]);
    }
    for (const std::size_t i : search.ball) search.start.push_back(balls.centers[i]);
    search.before = search.center = search.start;
    std::vector<double> room(balls.centers.size(), -1.0);  // clearance at the best position so far, in m
    for (int move = 0; move <= kMoves && !search.ball.empty(); ++move) {
        find_nearest(search);
        find_blocked(search);
        std::vector<std::size_t> kept;
        for (std::size_t k = 0; k < search.ball.size(); ++k) {
            const std::size_t i = search.ball[k];
            const double distance = search.distance[k];
            if (search.blocked[k] != 0) {
                search.center[k] = 0.5 * (search.before[k] + search.center[k]);
                kept.push_back(k);
                continue;
            }
            if (distance > room[i]) {
                room[i] = distance;
                balls.centers[i] = search.center[k];
            }
            const double lacking = balls.radii[i] - distance;
            if (lacking <= kPoke * balls.radii[i] || !(distance > 0.0)) continue;
            search.before[k] = search.center[k];
            search.center[k] += (lacking / distance) * (search.center[k] - search.nearest[k]);
            kept.push_back(k);
        }
        search.keep(kept);
    }
    for (std::size_t i = 0; i < room.size(); ++i) {
        const bool pokes = room[i] >= 0.0 && room[i] < (1.0 - kPoke) * balls.radii[i];
        if (pokes) balls.radii[i] = std::max(balls.own[i], room[i]);
    }
}

}  // namespace ricochet::cli
