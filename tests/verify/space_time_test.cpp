// Compares the verifier's test of a moving point and a moving triangle with the library's, which shares no code with
// it.
#include "ricochet/verify/space_time.h"

#include <gtest/gtest.h>

#include "ricochet/core/random.h"
#include "ricochet/geometry/sweep/moving_triangle.h"
#include "support/counts.h"

namespace ricochet::verify {
namespace RICOCHET_FILE {

Vec3 in_cube(RandomSequence& random) {
    return {random.uniform_around(0, 1), random.uniform_around(0, 1), random.uniform_around(0, 1)};
}

TEST(SpaceTime, ResultMatchesTheLibrarysMethod) {
    RandomSequence random(29, 0, 0);
    int apart = 0;
    const int count = test::scaled(400);
    for (int k = 0; k < count; ++k) {
        const MovingPoint point{in_cube(random), in_cube(random)};
        MovingTriangle triangle;
        for (MovingPoint& corner : triangle.corners) corner = {in_cube(random), in_cube(random)};
        const auto& [a, b, c] = triangle.corners;
        const auto contact = first_contact(point, 0.0, triangle);
        if (contact && contact->distance > 1e-12) continue;
        const bool is_apart = are_apart({point.from, point.to}, {{a.from, b.from, c.from}, {a.to, b.to, c.to}});
        EXPECT_EQ(is_apart, !contact.has_value()) << k;
        apart += is_apart ? 1 : 0;
    }
    EXPECT_GT(apart, count / 4);
    EXPECT_LT(apart, count);
}

// A touch at one end, a touch in the middle, and a miss by the last bit.
TEST(SpaceTime, TouchCountsAsContact) {
    const Corners flat{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const Corners risen{{0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    const MovingCorners rising{flat, risen};
    EXPECT_FALSE(are_apart({{0.2, 0.2, 0.5}, {0.2, 0.2, 0.5}}, rising));
    EXPECT_FALSE(are_apart({{0.2, 0.2, 1.0}, {0.2, 0.2, 1.0}}, rising));
    EXPECT_TRUE(are_apart({{0.2, 0.2, 1.0 + 0x1p-52}, {0.2, 0.2, 1.0 + 0x1p-52}}, rising));
    EXPECT_FALSE(are_apart({{0.2, 0.2, 0.0}, {0.2, 0.2, 2.0}}, rising));
    EXPECT_TRUE(are_apart({{0.2, 0.2, 0x1p-60}, {0.2, 0.2, 2.0}}, rising));
    EXPECT_TRUE(are_apart({{0.6, 0.6, 0.5}, {0.6, 0.6, 0.5}}, rising));
    EXPECT_FALSE(are_apart({{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}}, rising));  // on the rim
}

// Two corners always coincide, so the triangle is a segment. The path is far longer than its distance from the segment.
TEST(SpaceTime, PathMissesATriangleThatNeverHasAnArea) {
    const Corners before{{0.34, 0.12, 0.31}, {-1.58, -0.39, -1.06}, {0.34, 0.12, 0.31}};
    const Corners after{{0.32, 0.11, 0.28}, {-1.59, -0.39, -1.08}, {0.32, 0.11, 0.28}};
    EXPECT_TRUE(are_apart({{-1.49, -0.46, -0.10}, {-1.34, -0.05, -0.49}}, {before, after}));
    const Corners edge{{0, 0, 0}, {2, 0, 0}, {0, 0, 0}};
    EXPECT_FALSE(are_apart({{1, -1, 0}, {1, 1, 0}}, {edge, edge}));
}

// The path resembles a particle that slides over a seam of a scaled face: at a height of 16 ulp, beside a triangle with
// collinear corners. The third corner coincides with others or lies between them.
TEST(SpaceTime, PathMissesAFlatTriangleThatItPassesClosely) {
    RandomSequence random(31, 0, 0);
    const int count = test::scaled(200);
    for (int k = 0; k < count; ++k) {
        SCOPED_TRACE(k);
        const Vec3 half = in_cube(random);
        const Vec3 grown = 1.01 * half;
        const double third = k % 2 == 0 ? 0.0 : random.uniform_around(0, 1);
        const Corners before{-half, half, third * half};
        const Corners after{-grown, grown, third * grown};
        const Vec3 to_side = normalized(cross(half, in_cube(random)));
        const Vec3 up = normalized(cross(half, to_side));
        const Vec3 middle = random.uniform_around(0, 0.9) * half + 0x1p-48 * up;
        const double speed = random.uniform_around(0, 1);
        EXPECT_TRUE(are_apart({middle - speed * to_side, middle + speed * to_side}, {before, after}));
    }
    const Corners edge{{-1, 0, 0}, {1, 0, 0}, {0.5, 0, 0}};
    EXPECT_TRUE(are_apart({{0, -1, 0x1p-50}, {0, 1, 0x1p-50}}, {edge, edge}));
    EXPECT_FALSE(are_apart({{0, -1, 0}, {0, 1, 0}}, {edge, edge}));
    EXPECT_FALSE(are_apart({{0, -1, 0x1p-50}, {0, 1, -0x1p-50}}, {edge, edge}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::verify
