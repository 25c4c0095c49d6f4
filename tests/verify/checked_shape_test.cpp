#include "ricochet/verify/checked_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/shape_oracle.h"

namespace ricochet::verify {
namespace RICOCHET_FILE {

using testing::Real;
using testing::real;

constexpr std::uint64_t kSeed = 81;

/// Returns a map to a ball, ellipsoid or cylinder: rotated, mirrored, or far away.
AffineMap random_map(RandomSequence& random) {
    Placement placement;
    const double size = std::pow(10.0, 4.0 * random.uniform() - 2.0);
    placement.scale = {size, size, size};
    if (random.uniform() < 0.6) placement.scale.z *= 0.2 + 3.0 * random.uniform();
    if (random.uniform() < 0.4) placement.scale.y *= -(0.2 + 3.0 * random.uniform());
    if (random.uniform() < 0.6) {
        placement.rotation_axis = random.unit_vector();
        placement.rotation_degrees = 360.0 * random.uniform();
    }
    if (random.uniform() < 0.5) placement.position = 100.0 * random.unit_vector();
    return world_from_local(placement);
}

/// Returns a position at a distance of any scale from the surface.
Vec3 random_place(const AffineMap& map, RandomSequence& random) {
    Vec3 local = random.unit_vector();
    if (random.uniform() < 0.5) local.z = local.z < 0.0 ? -1.0 : 1.0;
    const double off = random.uniform() < 0.5 ? std::pow(10.0, -15.0 * random.uniform()) : 2.0 * random.uniform();
    return map.point((random.uniform() < 0.5 ? 1.0 + off : 1.0 - off) * local);
}

TEST(CheckedShape, SidesSegmentsAndDistancesMatchFiftyDigits) {
    int met = 0;
    int free = 0;
    for (int i = 0; i < test::scaled(4000); ++i) {
        RandomSequence random(kSeed, 0, static_cast<std::uint64_t>(i));
        const AffineMap map = random_map(random);
        const bool is_cylinder = i % 2 == 1;
        const CheckedShape shape(map, is_cylinder);
        const testing::ShapeOracle oracle(map, is_cylinder);
        const Vec3 p = random_place(map, random);
        const Vec3 q = random_place(map, random);
        SCOPED_TRACE(i);
        ASSERT_EQ(shape.side(p), oracle.value(real(p)).sign());
        const bool meets = oracle.intersects(real(p), real(q));
        ASSERT_EQ(shape.intersects(p, q), meets);
        (meets ? met : free) += 1;
        const auto& half = oracle.half_axes();
        const double distance = std::fabs(static_cast<double>(oracle.nearest(real(p)).distance));
        if (distance == 0.0) continue;
        const double below = (1.0 - 1e-12) * distance - 1e-15 * *std::max_element(half.begin(), half.end());
        ASSERT_FALSE(below > 0.0 && shape.is_nearer(p, below)) << distance;
        ASSERT_TRUE(shape.is_nearer(p, (1.0 + 1e-12) * distance)) << distance;
    }
    EXPECT_GT(met, 0);
    EXPECT_GT(free, 0);
}

TEST(CheckedShape, SegmentMayLeaveTheSurfaceButNotPassThrough) {
    const CheckedShape ball(AffineMap{}, false);
    EXPECT_EQ(ball.side({1, 0, 0}), 0);
    EXPECT_TRUE(ball.intersects({1, 0, 0}, {2, 0, 0}));
    EXPECT_FALSE(ball.intersects_after_start({1, 0, 0}, {2, 0, 0}));
    EXPECT_FALSE(ball.intersects_after_start({1, 0, 0}, {1, 1, 0}));    // along the tangent
    EXPECT_FALSE(ball.intersects_after_start({1, 0, 0}, {0.5, 0, 0}));  // inward
    EXPECT_TRUE(ball.intersects_after_start({1, 0, 0}, {-2, 0, 0}));
    EXPECT_TRUE(ball.intersects_after_start({1, 0, 0}, {0.999, 2, 0}));
    EXPECT_TRUE(ball.intersects_after_start({1, 0, 0}, {-1, 0, 0}));
    const CheckedShape cylinder(AffineMap{}, true);
    EXPECT_FALSE(cylinder.intersects_after_start({0, 0, 1}, {5, 0, 2}));
    EXPECT_TRUE(cylinder.intersects_after_start({0, 0, 1}, {5, 0, 0.5}));
    EXPECT_FALSE(cylinder.intersects_after_start({0, 0, 1}, {0, 0, 0}));
    // A segment that barely touches the inside, and one that just misses.
    EXPECT_TRUE(ball.intersects({-1, 1 - 0x1p-40, 0}, {1, 1 - 0x1p-40, 0}));
    EXPECT_FALSE(ball.intersects({-1, 1 + 0x1p-52, 0}, {1, 1 + 0x1p-52, 0}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::verify
