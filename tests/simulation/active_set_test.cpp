#include "ricochet/simulation/active_mover.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr std::size_t kMany = 100'000;
constexpr std::size_t kManyTriangles = 1'000'000;

ActiveSet every(std::uint32_t stride, std::size_t particles) {
    ActiveSet active({particles / stride});
    std::uint32_t next = 0;
    for (std::uint32_t& i : active.block(0)) i = stride * next++;
    return active;
}

std::vector<Vec3> random_positions() {
    RandomSequence random(7, 0, 0);
    std::vector<Vec3> positions(kMany);
    for (Vec3& p : positions) p = random.in_unit_ball();
    return positions;
}

double length_of_tour(const ActiveSet& active, const std::vector<Vec3>& positions) {
    double sum = 0.0;
    const auto list = active.block(0);
    for (std::size_t k = 1; k < list.size(); ++k) sum += length(positions[list[k]] - positions[list[k - 1]]);
    return sum;
}

TEST(ActiveSet, SortingPaysForAThinSelectionAmongManyTriangles) {
    EXPECT_TRUE(every(20, kMany).is_worth_sorting(kMany, kManyTriangles));
    EXPECT_TRUE(every(4, kMany).is_worth_sorting(kMany, kManyTriangles));
    EXPECT_FALSE(every(3, kMany).is_worth_sorting(kMany, kManyTriangles)) << "most of them are moved anyway";
    EXPECT_FALSE(every(20, kMany).is_worth_sorting(kMany, 20'000)) << "the caches hold all triangles";
    EXPECT_FALSE(every(1000, kMany).is_worth_sorting(kMany, kManyTriangles)) << "too few to gain anything";
}

TEST(ActiveSet, SortingByPositionPlacesNeighboursTogether) {
    const std::vector<Vec3> positions = random_positions();
    const ActiveSet unsorted = every(4, kMany);
    ActiveSet sorted = unsorted;
    sorted.sort_by_position(positions, {{-1, -1, -1}, {1, 1, 1}});
    EXPECT_LT(length_of_tour(sorted, positions), 0.1 * length_of_tour(unsorted, positions));
    std::vector<std::uint32_t> members(sorted.block(0).begin(), sorted.block(0).end());
    std::sort(members.begin(), members.end());
    EXPECT_TRUE(std::equal(members.begin(), members.end(), unsorted.block(0).begin(), unsorted.block(0).end()));
}

TEST(ActiveSet, OrderDoesNotDependOnTheNumberOfThreads) {
    const std::vector<Vec3> positions = random_positions();
    std::vector<std::uint32_t> expected;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        ActiveSet active = every(4, kMany);
        active.sort_by_position(positions, {{-1, -1, -1}, {1, 1, 1}});
        const std::vector<std::uint32_t> order(active.block(0).begin(), active.block(0).end());
        if (expected.empty()) expected = order;
        EXPECT_EQ(order, expected) << threads;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
