// Rays through corners, along edges and faces, and one ulp beside them, on balls that are far from the origin, tiny or
// huge. Every result is compared with an oracle in arbitrary-precision integers.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "queries/ray_oracle.h"
#include "ricochet/core/parallel.h"
#include "ricochet/queries/mesh_queries.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

struct Place {
    const char* name;
    double shift;
    double scale;
};

class HardRays : public ::testing::TestWithParam<Place> {
protected:
    static constexpr std::size_t kBatch = 1 << 14;

    void SetUp() override {
        const auto& [name, shift, scale] = GetParam();
        mesh_ = testing::lattice_ball({shift, -shift, 0.5 * shift}, scale, 2);
        unit_ = scale / 1024.0;
    }
    /// Returns the number of rays.
    static std::size_t count() {
        return test::is_long_run() ? 25'000'000 : static_cast<std::size_t>(test::scaled(20'000));
    }
    /// Fills origins_ and directions_ with the next rays.
    void draw(std::size_t batch, std::size_t size) {
        origins_.clear();
        directions_.clear();
        RandomSequence random(17, 0, batch);
        while (origins_.size() < size) {
            const testing::HardRay ray = testing::hard_ray(mesh_, unit_, random);
            if (ray.direction == Vec3{}) continue;
            origins_.push_back(ray.origin);
            directions_.push_back(ray.direction);
        }
    }
    [[nodiscard]] RayBatch rays() const { return {origins_, directions_}; }

    TriangleMesh mesh_;
    double unit_ = 0.0;
    std::vector<Vec3> origins_;
    std::vector<Vec3> directions_;
};

struct Errors {
    std::size_t first = 0;  ///< rays with a wrong first triangle, a false hit or a missed hit
    std::size_t occluded = 0;
    std::size_t count = 0;
    std::size_t winding = 0;  ///< rays whose crossings do not add up to inside or outside
    std::string example;
};

TEST_P(HardRays, ResultsAgreeWithArbitraryPrecisionIntegers) {
    const MeshQueries queries(mesh_);
    const testing::RayOracle oracle(mesh_);
    std::vector<Errors> errors((count() + kBatch - 1) / kBatch);
    std::size_t hits = 0;
    std::size_t along = 0;
    for (std::size_t batch = 0; batch < errors.size(); ++batch) {
        draw(batch, std::min(kBatch, count() - batch * kBatch));
        const MeshHits first = queries.first_hits(rays());
        const auto occluded = queries.occluded(rays());
        const auto counts = queries.count_hits(rays());
        const AllMeshHits all = queries.all_hits(rays());
        const auto inside = queries.inside(origins_);
        std::vector<Errors> wrong(origins_.size());
        std::vector<testing::TrueHits> truth(origins_.size());
        parallel_for_blocks(origins_.size(), 64, [&](std::size_t, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) truth[i] = oracle.ask(origins_[i], directions_[i]);
        });
        Errors& sum = errors[batch];
        for (std::size_t i = 0; i < origins_.size(); ++i) {
            const auto& [triangles, places, runs_along, begins_on] = truth[i];
            const std::int64_t expected = triangles.empty() ? kNoHit : triangles[0];
            const bool first_is_wrong = first.triangle[i] != expected;
            sum.first += first_is_wrong ? 1 : 0;
            if (first_is_wrong && sum.example.empty()) sum.example = "ray " + std::to_string(batch * kBatch + i);
            sum.occluded += (occluded[i] != 0) != !triangles.empty() ? 1 : 0;
            sum.count += !runs_along && counts[i] != places ? 1 : 0;
            const std::size_t from = all.first[i];
            const std::size_t to = all.first[i + 1];
            sum.count += to - from != counts[i] || (to > from && all.hits.triangle[from] != expected) ? 1 : 0;
            int winding = 0;
            for (std::size_t k = from; k < to; ++k) winding += all.crossing[k];
            sum.winding += !begins_on && winding != inside[i] ? 1 : 0;
            hits += triangles.empty() ? 0 : 1;
            along += runs_along ? 1 : 0;
        }
    }
    Errors sum;
    for (const Errors& e : errors) {
        sum.first += e.first;
        sum.occluded += e.occluded;
        sum.count += e.count;
        sum.winding += e.winding;
        if (sum.example.empty()) sum.example = e.example;
    }
    RecordProperty("rays", static_cast<int>(count()));
    EXPECT_EQ(sum.first, 0U) << sum.example;
    EXPECT_EQ(sum.occluded, 0U);
    EXPECT_EQ(sum.count, 0U);
    EXPECT_EQ(sum.winding, 0U);
    EXPECT_GT(hits, count() / 4);
    EXPECT_GE(along, count() / 100);
}

TEST_P(HardRays, ResultsDoNotDependOnThreadsOrOrder) {
    const MeshQueries queries(mesh_);
    draw(1, static_cast<std::size_t>(test::scaled(20'000)));
    const MeshHits first = queries.first_hits(rays());
    MeshHits alone;
    {
        const ThreadLimit one(1);
        alone = queries.first_hits(rays());
    }
    EXPECT_EQ(alone.triangle, first.triangle);
    EXPECT_EQ(alone.distance, first.distance);
    std::reverse(origins_.begin(), origins_.end());
    std::reverse(directions_.begin(), directions_.end());
    MeshHits turned = queries.first_hits(rays());
    std::reverse(turned.triangle.begin(), turned.triangle.end());
    std::reverse(turned.distance.begin(), turned.distance.end());
    EXPECT_EQ(turned.triangle, first.triangle);
    EXPECT_EQ(turned.distance, first.distance);
}

INSTANTIATE_TEST_SUITE_P(Anywhere, HardRays,
                         ::testing::Values(Place{"AtTheOrigin", 0.0, 1.0}, Place{"FarAway", 1e8, 1.0},
                                           Place{"Huge", 0.0, 0x1p40}, Place{"Tiny", 0.0, 0x1p-40}),
                         [](const auto& param) { return std::string(param.param.name); });

}  // namespace RICOCHET_FILE
}  // namespace ricochet
