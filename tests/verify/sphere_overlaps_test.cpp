#include "ricochet/verify/sphere_overlaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::vector<StandingSphere> random_spheres(int count, std::uint64_t seed) {
    RandomSequence random(seed, 0, 0);
    std::vector<StandingSphere> spheres;
    for (int k = 0; k < count; ++k) {
        const Vec3 at{random.uniform(), random.uniform(), random.uniform()};
        const double radius = 0.002 * std::pow(50.0, std::pow(random.uniform(), 8));
        spheres.push_back({static_cast<std::uint64_t>(3 * k), at, radius, false});
    }
    return spheres;
}

TEST(SphereOverlaps, ResultsMatchABruteForceSearch) {
    for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(seed);
        const auto spheres = random_spheres(static_cast<int>(test::scaled(1500)), seed);
        std::vector<std::pair<std::uint64_t, std::uint64_t>> expected;
        double largest = 0.0;
        for (std::size_t i = 0; i < spheres.size(); ++i) {
            for (std::size_t j = i + 1; j < spheres.size(); ++j) {
                const double sum = spheres[i].radius + spheres[j].radius;
                const double depth = sum - length(spheres[i].position - spheres[j].position);
                const double part = depth / std::min(spheres[i].radius, spheres[j].radius);
                largest = std::max(largest, part);
                if (part > 0.01) expected.emplace_back(spheres[i].particle, spheres[j].particle);
            }
        }
        SphereOverlaps overlaps;
        std::vector<std::pair<std::uint64_t, std::uint64_t>> found;
        for (const auto& pair : overlaps.check(spheres, 0.01)) found.emplace_back(pair.first, pair.second);
        EXPECT_EQ(found, expected);
        EXPECT_GE(expected.size(), test::scaled(1500) < 1500 ? 0U : 11U);
        EXPECT_EQ(overlaps.largest(), largest);
    }
}

TEST(SphereOverlaps, ExistingOverlapIsReportedOnlyIfItGrows) {
    std::vector<StandingSphere> spheres = {{5, {0, 0, 0}, 1.0, true}, {2, {1.5, 0, 0}, 1.0, true}};
    SphereOverlaps overlaps;
    EXPECT_TRUE(overlaps.check(spheres, 1e-9).empty());
    EXPECT_EQ(overlaps.largest(), 0.5);
    for (StandingSphere& sphere : spheres) sphere.is_new = false;
    spheres[1].position.x = 1.6;
    EXPECT_TRUE(overlaps.check(spheres, 1e-9).empty());
    spheres[1].position.x = 1.55;
    const auto found = overlaps.check(spheres, 1e-9);
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0].first, 2U);
    EXPECT_EQ(found[0].second, 5U);
    spheres[1].position.x = 2.0;
    EXPECT_TRUE(overlaps.check(spheres, 1e-9).empty());
    spheres[1].position.x = 1.99;
    EXPECT_EQ(overlaps.check(spheres, 1e-9).size(), 1U);
    EXPECT_TRUE(overlaps.check({}, 1e-9).empty());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
