#include "ricochet/geometry/acceleration/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "ricochet/core/random.h"

namespace ricochet {
namespace {

std::vector<Box3> random_boxes(RandomSequence& random, int count, double size) {
    std::vector<Box3> boxes;
    for (int k = 0; k < count; ++k) {
        const Vec3 p{random.uniform(), random.uniform(), random.uniform()};
        boxes.push_back({p, p + size * Vec3{random.uniform(), random.uniform(), random.uniform()}});
    }
    return boxes;
}

// Fitted anew, it finds what going through all of them finds.
TEST(BoxTree, FindsTheBoxesThatMeetABox) {
    RandomSequence random(3, 0, 0);
    BoxTree tree;
    for (const int count : {1, 5, 300, 300, 300, 17, 0}) {
        const std::vector<Box3> boxes = random_boxes(random, count, 0.2);
        tree.fit(boxes);
        for (const Box3& query : random_boxes(random, 50, 0.3)) {
            std::vector<std::uint32_t> found;
            tree.near(query, [&](std::uint32_t k) { found.push_back(k); });
            std::sort(found.begin(), found.end());
            std::vector<std::uint32_t> expected;
            for (std::uint32_t k = 0; k < boxes.size(); ++k) {
                if (BoxTree::meet(boxes[k], query)) expected.push_back(k);
            }
            EXPECT_EQ(found, expected);
        }
    }
    EXPECT_TRUE(tree.bounds().empty());
}

TEST(BoxTree, CountsACommonPointAsMeeting) {
    BoxTree tree;
    tree.fit(std::vector<Box3>{{{0, 0, 0}, {1, 1, 1}}});
    int found = 0;
    tree.near({{1, 1, 1}, {2, 2, 2}}, [&](std::uint32_t) { ++found; });
    EXPECT_EQ(found, 1);
    tree.near({{1.0000001, 1, 1}, {2, 2, 2}}, [&](std::uint32_t) { ++found; });
    EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace ricochet
