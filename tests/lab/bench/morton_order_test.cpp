#include "lab/bench/reference.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ricochet/core/random.h"

namespace ricochet::bench {
namespace RICOCHET_FILE {

TEST(MortonOrder, OrdersTheCornersOfACubeInBinaryWithXFirst) {
    std::vector<Vec3> corners;
    for (int i = 7; i >= 0; --i) corners.emplace_back(i & 1, i >> 1 & 1, i >> 2);
    EXPECT_EQ(morton_order(corners), (std::vector<std::uint32_t>{7, 6, 5, 4, 3, 2, 1, 0}));
}

TEST(MortonOrder, KeepsTheOrderOfEqualPointsForAnyNumberOfPoints) {
    EXPECT_TRUE(morton_order({}).empty());
    const std::vector<Vec3> same(3, Vec3{1, 2, 3});
    EXPECT_EQ(morton_order(same), (std::vector<std::uint32_t>{0, 1, 2}));
}

TEST(MortonOrder, ContainsEveryPointOnceWithNeighboursTogether) {
    RandomSequence random(6, 0, 0);
    std::vector<Vec3> points(4096);
    for (Vec3& p : points) p = {random.uniform(), random.uniform(), random.uniform()};
    std::vector<std::uint32_t> order = morton_order(points);
    double path = 0.0;
    for (std::size_t i = 1; i < order.size(); ++i) path += length(points[order[i]] - points[order[i - 1]]);
    EXPECT_LT(path / 4095.0, 0.15);  // 0.66 in random order, 1/16 at best
    std::sort(order.begin(), order.end());
    for (std::uint32_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
