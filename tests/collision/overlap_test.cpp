#include "ricochet/collision/overlap.h"

#include <gtest/gtest.h>

#include <limits>

#include "collision/worlds.h"
#include "ricochet/core/random.h"
#include "ricochet/core/tolerances.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::mesh_collider;
using testing::plane_collider;
using testing::world_of;

ColliderDescription ball_collider(double radius) { return {"ball", BallShape{radius, {}}, 0}; }

TEST(DeepestOverlap, IsNoneForASphereThatTouches) {
    const CollisionWorld floor = world_of(plane_collider({}, {0, 0, 1}));
    EXPECT_FALSE(deepest_overlap(floor, {3, 4, 0.25}, 0.25));
    EXPECT_FALSE(deepest_overlap(floor, {3, 4, -0.25}, 0.25));
    const double tolerance = sphere_tolerance(0.25, 4.0);
    EXPECT_FALSE(deepest_overlap(floor, {3, 4, 0.25 - 0.9 * tolerance}, 0.25));
    EXPECT_TRUE(deepest_overlap(floor, {3, 4, 0.25 - 1.1 * tolerance}, 0.25));
}

TEST(DeepestOverlap, IsNoneForPointsAndForSpheresWhollyInsideASolid) {
    const CollisionWorld world = world_of(mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 1})), ball_collider(4));
    EXPECT_FALSE(deepest_overlap(world, {0.1, 0.2, 0.3}, 0.6));
    EXPECT_TRUE(deepest_overlap(world, {0.1, 0.2, 0.3}, 0.8));
    EXPECT_FALSE(deepest_overlap(world, {0, 0, 1}, 0.0));
    EXPECT_FALSE(deepest_overlap(world, {0, std::numeric_limits<double>::quiet_NaN(), 1}, 1.0));
    EXPECT_FALSE(deepest_overlap(CollisionWorld({}), {}, 1.0));
}

TEST(DeepestOverlap, IsWithTheNearestOfAllSurfaces) {
    constexpr std::uint64_t kSeed = 11;
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    const CollisionWorld world = world_of(plane_collider({0, 0, -1}, {0.1, 0, 1}), ball_collider(0.4),
                                          mesh_collider(testing::sphere_mesh({0.3, 0, 0}, 1.0, 3)));
    RandomSequence random(kSeed, 1, 0);
    int overlaps = 0;
    const int count = static_cast<int>(test::scaled(2000));
    for (int k = 0; k < count; ++k) {
        const Vec3 p = 1.6 * random.in_unit_ball();
        const double radius = 0.3 * random.uniform();
        double nearest = std::numeric_limits<double>::infinity();
        for (SurfaceId s = 0; s < world.surface_count(); ++s) nearest = std::min(nearest, world.nearest(s, p).distance);
        const auto found = deepest_overlap(world, p, radius);
        ASSERT_EQ(found.has_value(), nearest < radius) << k;
        if (!found) continue;
        ++overlaps;
        EXPECT_NEAR(found->distance, nearest, 1e-15) << k;
        EXPECT_NEAR(world.nearest(found->surface, p).distance, nearest, 1e-15) << k;
        EXPECT_LT(core_radius(*found, p, radius), found->distance) << k;
    }
    EXPECT_GT(overlaps, count / 10);
}

TEST(CoreRadius, IsZeroIfTheCentreIsOnTheSurface) {
    EXPECT_EQ(core_radius({0, 0.0}, {1, 2, 3}, 0.5), 0.0);
    EXPECT_EQ(core_radius({0, 1e-9}, {1, 2, 3}, 0.5), 0.0);
    EXPECT_NEAR(core_radius({0, 0.125}, {1, 2, 3}, 0.5), 0.125, 1e-14);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
