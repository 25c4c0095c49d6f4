// Queries for rays: first hits, all hits, numbers of hits, and occlusion.
#include <fmt/format.h>

#include <numeric>
#include <optional>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/loop_stop.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/geometry/sweep/ray_triangle.h"
#include "ricochet/queries/mesh_index.h"
#include "ricochet/queries/ray_crossings.h"

namespace ricochet {
namespace {

/// Number of rays between two calls of poll_loop_stop(), because a call takes as long as a short ray.
constexpr std::size_t kPollEvery = 16;

void require_rays(const RayBatch& rays) {
    require_same_length(rays.directions.size(), rays.origins.size(), "directions");
    if (rays.most.size() > 1) require_same_length(rays.most.size(), rays.origins.size(), "most");
    require_positions(rays.origins, "origins");
    for (std::size_t i = 0; i < rays.directions.size(); ++i) {
        const Vec3& d = rays.directions[i];
        if (is_finite(d) && max_abs(d) > 0.0) continue;
        throw InputError(fmt::format(
            "directions[{}]: found [{}, {}, {}], expected a finite direction of length above 0", i, d.x, d.y, d.z));
    }
    for (std::size_t i = 0; i < rays.most.size(); ++i) {
        if (rays.most[i] >= 0.0) continue;
        throw InputError(fmt::format("most[{}]: found {}, expected a distance of at least 0 m", i, rays.most[i]));
    }
}

double most_of(const RayBatch& rays, std::size_t i) {
    if (rays.most.empty()) return kInfinity;
    return rays.most.size() == 1 ? rays.most[0] : rays.most[i];
}

/// Calls visit(block, i, query) for every ray i, in parallel, block by block.
template <class Visit>
void for_each_ray(const RayBatch& rays, const Visit& visit) {
    require_rays(rays);
    parallel_for_blocks(rays.origins.size(), kQueryBlock, [&](std::size_t block, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (i % kPollEvery == 0) poll_loop_stop();
            visit(block, i, RayQuery{Ray(rays.origins[i], rays.directions[i]), most_of(rays, i)});
        }
    });
}

}  // namespace

MeshHits MeshQueries::first_hits(const RayBatch& rays) const {
    MeshHits hits = no_hits(rays.origins.size());
    for_each_ray(rays, [&](std::size_t, std::size_t i, const RayQuery& query) {
        const std::optional<RayCrossing> crossing_point = first_crossing_on(*index_, query);
        if (!crossing_point) return;
        hits.triangle[i] = crossing_point->triangle;
        hits.distance[i] = query.ray.distance(crossing_point->t);
        hits.point[i] = query.ray.at(crossing_point->t);
    });
    return hits;
}

std::vector<std::uint8_t> MeshQueries::occluded(const RayBatch& rays) const {
    std::vector<std::uint8_t> results(rays.origins.size(), 0);
    for_each_ray(rays, [&](std::size_t, std::size_t i, const RayQuery& query) {
        results[i] = hits_anything(*index_, query) ? 1 : 0;
    });
    return results;
}

std::vector<std::uint64_t> MeshQueries::count_hits(const RayBatch& rays) const {
    std::vector<std::uint64_t> counts(rays.origins.size(), 0);
    for_each_ray(rays, [&](std::size_t, std::size_t i, const RayQuery& query) {
        thread_local std::vector<RayCrossing> crossings;
        all_crossings(*index_, query, crossings);
        counts[i] = crossings.size();
    });
    return counts;
}

AllMeshHits MeshQueries::all_hits(const RayBatch& rays) const {
    const std::size_t count = rays.origins.size();
    AllMeshHits all;
    all.first.assign(count + 1, 0);
    struct Found {
        std::size_t ray;
        RayCrossing crossing_point;
    };
    std::vector<std::vector<Found>> blocks((count + kQueryBlock - 1) / kQueryBlock);
    for_each_ray(rays, [&](std::size_t block, std::size_t i, const RayQuery& query) {
        thread_local std::vector<RayCrossing> crossings;
        all_crossings(*index_, query, crossings);
        all.first[i + 1] = crossings.size();
        for (const RayCrossing& crossing_point : crossings) blocks[block].push_back({i, crossing_point});
    });
    std::partial_sum(all.first.begin(), all.first.end(), all.first.begin());
    all.hits = no_hits(all.first.back());
    all.crossing.assign(all.first.back(), 0);
    all.in_plane.assign(all.first.back(), 0);
    parallel_for_blocks(blocks.size(), 1, [&](std::size_t block, std::size_t, std::size_t) {
        std::size_t k = all.first[block * kQueryBlock];
        for (const auto& [ray, crossing_point] : blocks[block]) {
            const RayQuery query{Ray(rays.origins[ray], rays.directions[ray]), kInfinity};
            all.hits.triangle[k] = crossing_point.triangle;
            all.hits.distance[k] = query.ray.distance(crossing_point.t);
            all.hits.point[k] = query.ray.at(crossing_point.t);
            all.crossing[k] = crossing_point.crossing;
            all.in_plane[k++] = crossing_point.is_in_plane ? 1 : 0;
        }
        blocks[block] = {};
    });
    return all;
}

}  // namespace ricochet
