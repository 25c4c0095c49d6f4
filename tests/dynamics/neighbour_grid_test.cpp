#include "ricochet/dynamics/neighbour_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::scaled;

bool meet(const Box3& a, const Box3& b) {
    if (a.empty() || b.empty()) return false;
    return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y && b.lower.y <= a.upper.y &&
           a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

std::vector<NeighbourPair> brute_force(const std::vector<Box3>& boxes) {
    std::vector<NeighbourPair> pairs;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        for (std::uint32_t j = i + 1; j < boxes.size(); ++j) {
            if (meet(boxes[i], boxes[j])) pairs.push_back({i, j});
        }
    }
    return pairs;
}

Box3 ball_box(const Vec3& center, double radius) {
    const Vec3 r{radius, radius, radius};
    return {center - r, center + r};
}

/// Returns balls in a box around a centre. Their radii are spread evenly over the given number of decades.
std::vector<Box3> random_balls(std::uint64_t seed, std::size_t count, double decades, const Vec3& size,
                               const Vec3& center) {
    RandomSequence random(seed, 1, 0);
    std::vector<Box3> boxes;
    for (std::size_t k = 0; k < count; ++k) {
        const double x = random.uniform() - 0.5;
        const double y = random.uniform() - 0.5;
        const double z = random.uniform() - 0.5;
        const double radius = 0.1 * std::pow(10.0, -decades * random.uniform());
        boxes.push_back(ball_box(center + Vec3{x * size.x, y * size.y, z * size.z}, radius));
    }
    return boxes;
}

TEST(NeighbourGrid, MatchesBruteForceForEqualRadiiAndOverThreeDecades) {
    NeighbourGrid grid;  // reused, because its stored state must not affect the result
    std::size_t found = 0;
    for (int seed = 1; seed <= std::max(20, scaled(60)); ++seed) {  // covers every size
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto count = static_cast<std::size_t>(1 + 37 * (seed % 20));
        const double decades = seed % 4;
        const Vec3 size = seed % 3 == 0 ? Vec3{4, 0, 0.5} : Vec3{1.5, 2, 1};
        const Vec3 center = seed % 5 == 0 ? Vec3{1e6, -3e5, 12} : Vec3{-0.3, 0.1, 0};
        const std::vector<Box3> boxes = random_balls(static_cast<std::uint64_t>(seed), count, decades, size, center);
        const std::vector<NeighbourPair> pairs = grid.find_pairs(boxes);
        found += pairs.size();
        ASSERT_TRUE(pairs == brute_force(boxes));
    }
    EXPECT_GT(found, 100U);
}

TEST(NeighbourGrid, FindsPairsAmongBoxesThatTouchAtTheCornersOfCells) {
    std::vector<Box3> boxes;
    for (int x = -3; x <= 3; ++x) {
        for (int y = -3; y <= 3; ++y) {
            for (int z = 0; z <= 2; ++z) {
                const Vec3 lower{0.25 * x, 0.25 * y, 0.25 * z};
                boxes.push_back({lower, lower + Vec3{0.25, 0.25, 0.25}});
            }
        }
    }
    EXPECT_EQ(NeighbourGrid().find_pairs(boxes), brute_force(boxes));
}

TEST(NeighbourGrid, LongBoxesPointsEmptyOnesAndThoseFarAwayAreFound) {
    for (int seed = 1; seed <= scaled(40); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::vector<Box3> boxes = random_balls(static_cast<std::uint64_t>(seed), 300, 2.0, {1, 1, 1}, {0, 0, 0});
        RandomSequence random(static_cast<std::uint64_t>(seed), 2, 0);
        for (Box3& box : boxes) {
            const double kind = random.uniform();
            const double stretch = random.uniform();
            if (kind < 0.1) box = {};
            if (kind >= 0.1 && kind < 0.2) box.upper = box.lower;
            if (kind >= 0.2 && kind < 0.3) box.upper[static_cast<int>(3.0 * stretch)] += stretch;
            if (kind >= 0.3 && kind < 0.35) box = {1e12 * box.lower, 1e12 * box.lower + box.size()};
            if (kind >= 0.35 && kind < 0.4) box = boxes.front();
            if (kind >= 0.4 && kind < 0.42) box.upper = box.lower + 1e-250 * box.size();
        }
        ASSERT_TRUE(NeighbourGrid().find_pairs(boxes) == brute_force(boxes));
    }
}

TEST(NeighbourGrid, FindsAllBoxesThatAnyBoxOverlaps) {
    for (int seed = 1; seed <= scaled(20); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const std::vector<Box3> boxes =
            random_balls(static_cast<std::uint64_t>(seed), 400, seed % 4, {2, 1, 1.5}, {0.2, 0, 0});
        NeighbourGrid grid;
        grid.find_pairs(boxes);
        const std::vector<Box3> asked =
            random_balls(static_cast<std::uint64_t>(seed) + 100, 60, seed % 3, {4, 2, 2}, {0, 0, 0});
        for (const Box3& box : asked) {
            std::vector<std::uint32_t> found;
            grid.find_near(box, found);
            std::sort(found.begin(), found.end());
            std::vector<std::uint32_t> expected;
            for (std::uint32_t i = 0; i < boxes.size(); ++i) {
                if (meet(boxes[i], box)) expected.push_back(i);
            }
            ASSERT_TRUE(found == expected);
        }
    }
}

TEST(NeighbourGrid, FindsNoPairsInZeroOrOneBox) {
    NeighbourGrid grid;
    EXPECT_TRUE(grid.find_pairs({}).empty());
    const std::vector<Box3> one{ball_box({1, 2, 3}, 0.5)};
    EXPECT_TRUE(grid.find_pairs(one).empty());
    const std::vector<Box3> none(5);
    EXPECT_TRUE(grid.find_pairs(none).empty());
    const std::vector<Box3> points(3, Box3{{0, 0, 0}, {0, 0, 0}});
    EXPECT_EQ(grid.find_pairs(points).size(), 3U);
}

TEST(NeighbourGrid, FindsNothingOnceAllBoxesAreRemoved) {
    const std::vector<Box3> two = {{{0, 0, 0}, {1, 1, 1}}, {{0.5, 0.5, 0.5}, {2, 2, 2}}};
    NeighbourGrid grid;
    EXPECT_EQ(grid.find_pairs(two).size(), 1U);
    const std::vector<Box3> none(1);
    EXPECT_TRUE(grid.find_pairs(none).empty());
    std::vector<std::uint32_t> found;
    grid.find_near(two[0], found);
    EXPECT_TRUE(found.empty());
}

TEST(NeighbourGrid, HasTheSamePairsInTheSameOrderForAnyNumberOfThreads) {
    const std::vector<Box3> boxes = random_balls(3, 30000, 1.0, {6, 6, 6}, {0, 0, 0});
    const ThreadLimit one(1);
    const std::vector<NeighbourPair> serial = NeighbourGrid().find_pairs(boxes);
    EXPECT_TRUE(std::is_sorted(serial.begin(), serial.end(), [](const NeighbourPair& a, const NeighbourPair& b) {
        return std::tie(a.first, a.second) < std::tie(b.first, b.second);
    }));
    for (const int threads : {2, 7}) {
        const ThreadLimit limit(threads);
        EXPECT_EQ(NeighbourGrid().find_pairs(boxes), serial);
    }
}

TEST(NeighbourGrid, UsesTheMemoryThatItReports) {
    const auto count = static_cast<std::size_t>(scaled(200000));
    const double side = 0.513 * std::cbrt(static_cast<double>(count));  // same density for any count
    const std::vector<Box3> boxes = random_balls(4, count, 0.1, side * Vec3{1, 1, 1}, {0, 0, 0});
    NeighbourGrid grid;
    const std::size_t pairs = grid.find_pairs(boxes).size();
    EXPECT_GT(pairs, count / 10);
    EXPECT_LE(static_cast<double>(grid.memory_bytes()), NeighbourGrid::kBytesPerBox * static_cast<double>(count) +
                                                            NeighbourGrid::kBytesPerPair * static_cast<double>(pairs) +
                                                            4096.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
