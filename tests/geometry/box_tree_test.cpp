#include "ricochet/geometry/acceleration/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "ricochet/core/box_tools.h"
#include "ricochet/core/random.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::vector<Box3> random_boxes(RandomSequence& random, int count, double size) {
    std::vector<Box3> boxes;
    for (int k = 0; k < count; ++k) {
        const Vec3 p{random.uniform(), random.uniform(), random.uniform()};
        boxes.push_back({p, p + size * Vec3{random.uniform(), random.uniform(), random.uniform()}});
    }
    return boxes;
}

// A refitted tree finds the boxes that a test of all boxes finds.
TEST(BoxTree, FindsTheBoxesThatOverlapABox) {
    RandomSequence random(3, 0, 0);
    BoxTree tree;
    for (const int count : {1, 2, 4, 5, 6, 16, 17, 28, 300, 300, 300, 1025, 0}) {
        const std::vector<Box3> boxes = random_boxes(random, count, 0.2);
        tree.fit(boxes);
        for (const Box3& query : random_boxes(random, 50, 0.3)) {
            std::vector<std::uint32_t> found;
            tree.near(query, [&](std::uint32_t k) { found.push_back(k); });
            std::sort(found.begin(), found.end());
            std::vector<std::uint32_t> expected;
            for (std::uint32_t k = 0; k < boxes.size(); ++k) {
                if (overlap(boxes[k], query)) expected.push_back(k);
            }
            EXPECT_EQ(found, expected);
            EXPECT_EQ(tree.has_near(query), !expected.empty());
        }
    }
    EXPECT_TRUE(tree.bounds().empty());
}

TEST(BoxTree, CountsACommonPointAsAnOverlap) {
    BoxTree tree;
    tree.fit(std::vector<Box3>{{{0, 0, 0}, {1, 1, 1}}});
    int found = 0;
    tree.near({{1, 1, 1}, {2, 2, 2}}, [&](std::uint32_t) { ++found; });
    EXPECT_EQ(found, 1);
    tree.near({{1.0000001, 1, 1}, {2, 2, 2}}, [&](std::uint32_t) { ++found; });
    EXPECT_EQ(found, 1);
}

// Covers coordinates above and below the range of single precision, and unbounded boxes.
TEST(BoxTree, FindsBoxesOfAnySize) {
    constexpr double kLargest = 1e75;
    constexpr double kSmallest = 1e-75;
    const std::vector<Box3> boxes{{{-kLargest, 0, 0}, {-0.5 * kLargest, 1, 1}},
                                  {{kSmallest, 0, 0}, {2 * kSmallest, 1, 1}},
                                  {{0.5 * kLargest, 0, 0}, {kLargest, 1, 1}}};
    BoxTree tree;
    tree.fit(boxes);
    const auto near = [&](double lower, double upper) {
        std::vector<std::uint32_t> found;
        tree.near({{lower, 0, 0}, {upper, 1, 1}}, [&](std::uint32_t k) { found.push_back(k); });
        std::sort(found.begin(), found.end());
        return found;
    };
    using Found = std::vector<std::uint32_t>;
    EXPECT_EQ(near(-kLargest, -0.9 * kLargest), Found{0});
    EXPECT_EQ(near(-0.4 * kLargest, 0.5 * kSmallest), Found{});
    EXPECT_EQ(near(1.5 * kSmallest, 1e30), Found{1});
    EXPECT_EQ(near(0.4 * kLargest, 0.5 * kLargest), Found{2});
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(near(-kInfinity, kInfinity), (Found{0, 1, 2}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
