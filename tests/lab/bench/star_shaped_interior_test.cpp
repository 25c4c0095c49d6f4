#include "lab/bench/case_run.h"

#include <gtest/gtest.h>

#include "ricochet/core/random.h"
#include "support/simple_meshes.h"

namespace ricochet::bench {
namespace RICOCHET_FILE {

TEST(StarShapedInterior, MatchTheCoordinatesOfABox) {
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1, 2, 3});
    const StarShapedInterior interior(box, {0, 0, 0});
    RandomSequence random(5, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p{random.uniform_around(0, 4), random.uniform_around(0, 4), random.uniform_around(0, 4)};
        const bool inside = p.x > -1 && p.y > -1 && p.z > -1 && p.x < 1 && p.y < 2 && p.z < 3;
        EXPECT_EQ(interior.contains(p), inside) << p.x << ' ' << p.y << ' ' << p.z;
    }
}

TEST(StarShapedInterior, ExcludeTheSurface) {
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1, 1, 1});
    const StarShapedInterior interior(box, {0, 0, 0});
    EXPECT_FALSE(interior.contains({1, 0.25, 0.5}));
    EXPECT_TRUE(interior.contains({1 - 0x1p-50, 0.25, 0.5}));
}

TEST(StarShapedInterior, ContainABallIfTheBoxShrunkByItsRadiusContainsItsCentre) {
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1, 2, 3});
    const StarShapedInterior interior(box, {0, 0, 0});
    RandomSequence random(6, 0, 0);
    for (int i = 0; i < 1000; ++i) {
        const Vec3 p{random.uniform_around(0, 4), random.uniform_around(0, 4), random.uniform_around(0, 4)};
        const double r = random.uniform();
        const bool inside = p.x > r - 1 && p.y > r - 1 && p.z > r - 1 && p.x < 1 - r && p.y < 2 - r && p.z < 3 - r;
        EXPECT_EQ(interior.contains_ball(p, r), inside) << p.x << ' ' << p.y << ' ' << p.z << " radius " << r;
    }
    EXPECT_TRUE(interior.contains_ball({0.5, 0.5, 0.5}, 0.0));
    EXPECT_TRUE(interior.contains_ball({0.5, 0.5, 0.5}, 0.5));  // the ball is in contact
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
