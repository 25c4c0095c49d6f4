// The same hard rays for plain single-precision Embree and for the exact questions: how many each gets wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "bench/native_rays.h"
#include "queries/ray_oracle.h"
#include "ricochet/core/parallel.h"
#include "ricochet/queries/mesh_queries.h"
#include "support/counts.h"

namespace ricochet {
namespace {

std::array<float, 3> floats(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Rays wrongly said to hit, or to miss, out of `count`: Embree's and ours.
struct Wrong {
    int embree = 0;
    int ours = 0;
};

Wrong count_wrong(double shift, double scale, int count) {
    const TriangleMesh mesh = testing::lattice_ball({shift, -shift, 0.5 * shift}, scale, 2);
    RandomSequence random(23, 0, 0);
    std::vector<Vec3> origins;
    std::vector<Vec3> directions;
    std::vector<bench::RaySegment> segments;
    while (static_cast<int>(origins.size()) < count) {
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

TEST(HardRaysBeside, PlainEmbreeMissesManyThatTheExactQuestionsAnswer) {
    const int count = test::scaled(20'000);
    for (const auto& [name, shift, scale] :
         {std::tuple{"origin", 0.0, 1.0}, {"far", 1e8, 1.0}, {"huge", 0.0, 0x1p40}, {"tiny", 0.0, 0x1p-40}}) {
        const Wrong wrong = count_wrong(shift, scale, count);
        RecordProperty(std::string(name) + "_embree_wrong", wrong.embree);
        EXPECT_EQ(wrong.ours, 0) << name;
        EXPECT_GT(wrong.embree, count / 1000) << name;
    }
}

}  // namespace
}  // namespace ricochet
