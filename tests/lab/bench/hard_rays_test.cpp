// Traces the same hard rays with plain single-precision Embree and with the exact queries, and counts wrong results.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "lab/bench/native_rays.h"
#include "queries/ray_oracle.h"
#include "ricochet/core/parallel.h"
#include "ricochet/queries/mesh_queries.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::array<float, 3> floats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Number of rays out of `count` with a wrong hit or a wrong miss, for Embree and for the exact queries.
struct Wrong {
    int embree = 0;
    int ours = 0;
};

constexpr int kBlock = 20'000;

Wrong count_wrong(const TriangleMesh& mesh, double scale, std::uint32_t block) {
    RandomSequence random(23, block, 0);
    std::vector<Vec3> origins;
    std::vector<Vec3> directions;
    std::vector<bench::RaySegment> segments;
    while (static_cast<int>(origins.size()) < test::scaled(kBlock)) {
        const auto [origin, direction] = testing::hard_ray(mesh, scale / 1024.0, random);
        if (direction == Vec3{}) continue;
        origins.push_back(origin);
        directions.push_back(direction);
        const double reach = 4.0 * (length(origin - mesh.vertices[0]) + scale) / length(direction);
        segments.push_back({floats(origin), floats(reach * direction)});
    }
    std::vector<std::uint32_t> native(origins.size());
    bench::NativeRays(mesh).trace(segments, native);
    const auto ours = MeshQueries(mesh).occluded({origins, directions});
    const testing::RayOracle oracle(mesh);
    std::vector<std::uint8_t> truth(origins.size());
    parallel_for_blocks(truth.size(), 64, [&](std::size_t, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) truth[i] = !oracle.ask(origins[i], directions[i]).first.empty();
    });
    Wrong wrong;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        wrong.embree += (native[i] != bench::kNoTriangle) != (truth[i] != 0) ? 1 : 0;
        wrong.ours += (ours[i] != 0) != (truth[i] != 0) ? 1 : 0;
    }
    return wrong;
}

/// Returns the number of blocks of rays for each mesh. A short run has one. A long run has 125, which are 10^7 rays in
/// all, or that many times RICOCHET_HARD_RAYS.
std::uint32_t blocks_of_each() {
    const char* times = std::getenv("RICOCHET_HARD_RAYS");  // NOLINT(concurrency-mt-unsafe): no code sets it
    const auto factor = static_cast<std::uint32_t>(times == nullptr ? 1 : std::max(1, std::atoi(times)));
    return test::is_long_run() ? 125 * factor : 1;
}

void expect_none_wrong(const std::string& name, double shift, double scale) {
    const TriangleMesh mesh = testing::lattice_ball({shift, -shift, 0.5 * shift}, scale, 2);
    Wrong wrong;
    const std::uint32_t blocks = blocks_of_each();
    for (std::uint32_t block = 0; block < blocks; ++block) {
        const Wrong more = count_wrong(mesh, scale, block);
        wrong.embree += more.embree;
        wrong.ours += more.ours;
    }
    const auto rays = static_cast<int>(blocks) * test::scaled(kBlock);
    std::printf("%s: of %d hard rays Embree gets %d wrong, the exact questions %d\n", name.c_str(), rays, wrong.embree,
                wrong.ours);
    EXPECT_EQ(wrong.ours, 0) << name;
    EXPECT_GT(wrong.embree, rays / 1000) << name;
}

// Each position has its own test, so that long runs can be split.
struct HardPlace {
    const char* name;
    double shift;  // m
    double scale;
};
class HardRaysBeside : public ::testing::TestWithParam<HardPlace> {};

TEST_P(HardRaysBeside, PlainEmbreeErrsOftenAndTheExactQueriesNever) {
    expect_none_wrong(GetParam().name, GetParam().shift, GetParam().scale);
}

INSTANTIATE_TEST_SUITE_P(At, HardRaysBeside,
                         ::testing::Values(HardPlace{"origin", 0.0, 1.0}, HardPlace{"far_away", 1e8, 1.0},
                                           HardPlace{"large", 0.0, 0x1p40}, HardPlace{"small", 0.0, 0x1p-40}),
                         [](const auto& placement) { return std::string(placement.param.name); });

}  // namespace RICOCHET_FILE
}  // namespace ricochet
