#include "ricochet/verify/triangle_tests.h"

#include <gtest/gtest.h>

#include "support/counts.h"
#include "support/exact_oracle.h"
#include "support/segment_triangle_cases.h"

namespace ricochet::verify {
namespace RICOCHET_FILE {

constexpr std::uint64_t kSeed = 78;
const Corners kTriangle{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};

TEST(Meeting, InsideEdgesCornersAndMissesAreDecided) {
    EXPECT_TRUE(intersects({1, 1, 1}, {1, 1, -1}, kTriangle));
    EXPECT_TRUE(intersects({2, 2, 1}, {2, 2, -1}, kTriangle));  // an edge
    EXPECT_TRUE(intersects({4, 0, 1}, {4, 0, -1}, kTriangle));  // a corner
    EXPECT_TRUE(intersects({1, 1, 1}, {1, 1, 0}, kTriangle));   // ends on the triangle
    EXPECT_TRUE(intersects({1, 1, 0}, {1, 1, 0}, kTriangle));   // a point of the triangle
    EXPECT_FALSE(intersects({1, 1, 1}, {1, 1, 0x1p-60}, kTriangle));
    EXPECT_FALSE(intersects({2, 2 + 0x1p-50, 1}, {2, 2 + 0x1p-50, -1}, kTriangle));
    EXPECT_FALSE(intersects({5, 5, 0}, {5, 5, 0}, kTriangle));
}

TEST(Meeting, SegmentsInTheTrianglesPlaneAreDecided) {
    EXPECT_TRUE(intersects({-1, 1, 0}, {5, 1, 0}, kTriangle));   // through
    EXPECT_TRUE(intersects({1, 1, 0}, {1.5, 1, 0}, kTriangle));  // within
    EXPECT_TRUE(intersects({3, -1, 0}, {5, 1, 0}, kTriangle));   // through a corner
    EXPECT_TRUE(intersects({5, -1, 0}, {-1, 5, 0}, kTriangle));  // along an edge
    EXPECT_FALSE(intersects({5, 0, 0}, {6, 0, 0}, kTriangle));   // on an edge's line, beyond the edge
    EXPECT_FALSE(intersects({3, 2, 0}, {2, 3, 0}, kTriangle));   // beside the triangle
    EXPECT_FALSE(intersects({5, 0, 0}, {5, 0, 0}, kTriangle));   // a point on an edge's line
}

TEST(Meeting, ResultsMatchTheEliminationOfInequalities) {
    int met = 0;
    int compared = 0;
    for (int i = 0; i < test::scaled(20000); ++i) {
        const auto s = testing::segment_triangle_case(kSeed, static_cast<std::uint64_t>(i));
        const auto area = testing::exact_area_vector(s.a, s.b, s.c);
        if (area[0] == 0 && area[1] == 0 && area[2] == 0) continue;
        SCOPED_TRACE(testing::description(s));
        ++compared;
        const bool expected = testing::exact_segment_intersects_triangle(s.p, s.q, s.a, s.b, s.c);
        ASSERT_EQ(intersects(s.p, s.q, {s.a, s.b, s.c}), expected);
        met += expected ? 1 : 0;
    }
    EXPECT_GT(met, 0);
    EXPECT_LT(met, compared);
}

TEST(Meeting, SegmentMayLeaveATriangleToEitherSideButNotAlongIt) {
    EXPECT_FALSE(intersects_after_start({1, 1, 0}, {1, 1, 1}, kTriangle));
    EXPECT_FALSE(intersects_after_start({1, 1, 0}, {3, 3, -1}, kTriangle));
    EXPECT_TRUE(intersects_after_start({1, 1, 0}, {2, 1, 0}, kTriangle));
    EXPECT_TRUE(intersects_after_start({1, 1, 1}, {1, 1, -1}, kTriangle));
}

TEST(Meeting, CrossingPointIsReturned) {
    EXPECT_EQ(crossing_point({1, 1, 3}, {1, 1, -1}, kTriangle), Vec3(1, 1, 0));
    EXPECT_EQ(crossing_point({-1, 1, 0}, {5, 1, 0}, kTriangle), Vec3(-1, 1, 0));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::verify
