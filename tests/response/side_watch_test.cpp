#include "ricochet/response/side_watch.h"

#include <gtest/gtest.h>

#include <vector>

#include "collision/worlds.h"
#include "response/solids.h"
#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/random_draws.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::floor_mesh;
using testing::mesh_collider;
using testing::plane_collider;
using testing::world_of;

/// A watched particle.
struct Watched {
    Watched(const SignedDistance& distance, std::size_t colliders, const Vec3& at, double radius = 0.0)
        : sides(colliders), position(at), watch(distance, sides, radius, lists) {
        set_first_sides(distance, at, sides);
    }
    Watched(const Watched&) = delete;
    Watched& operator=(const Watched&) = delete;
    /// Moves to a position and stays there.
    std::vector<Proximity> go(const Vec3& to, double margin = 0.01) {
        std::vector<Proximity> seen;
        watch.find_near(to, position, margin, seen);
        watch.settle(seen);
        position = to;
        return seen;
    }

    std::vector<SideMemory> sides;
    Vec3 position;
    SideScratch lists;
    SideWatch watch;
};

TEST(SideWatch, ParticleSpawnedOnASurfaceIsOnTheSideOfItsNormal) {
    const CollisionWorld world = world_of(plane_collider({0, 0, 0}, {0, 0, 1}), plane_collider({0, 0, 2}, {0, 0, 1}));
    const SignedDistance distance(world);
    Watched watched(distance, 2, {0, 0, 0});
    EXPECT_EQ(watched.sides[0].side, 1);
    EXPECT_EQ(watched.sides[1].side, 0);
    const auto seen = watched.go({0, 0, -0.1});
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_TRUE(seen[0].behind);
    Watched above(distance, 2, {0, 0, 0});
    EXPECT_TRUE(above.go({0, 0, 0.1}).empty());
}

TEST(SideWatch, NumberOfCrossedSurfacesDecidesTheSide) {
    // One mesh of two sheets, both facing up, and a ball. Between the sheets the nearest point alone could give either
    // side.
    TriangleMesh sheets = floor_mesh(4.0, 1);
    const auto count = static_cast<std::uint32_t>(sheets.vertices.size());
    const std::size_t triangles = sheets.triangles.size();
    for (std::uint32_t k = 0; k < count; ++k) sheets.vertices.push_back(sheets.vertices[k] + Vec3{0, 0, 1});
    for (std::size_t k = 0; k < triangles; ++k) {
        const Triangle t = sheets.triangles[k];
        sheets.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
    }
    const CollisionWorld world = world_of(mesh_collider(sheets));
    const SignedDistance distance(world);
    Watched between(distance, 1, {0.1, 0.2, 0.3});
    const auto seen = between.go({0.1, 0.2, 1.1});
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_TRUE(seen[0].behind);
    EXPECT_EQ(seen[0].normal, (Vec3{0, 0, -1}));
    // A path right through a ball ends on its original side.
    const CollisionWorld with_ball = world_of(ColliderDescription{"ball", BallShape{0.1, {}}, 0});
    const SignedDistance of_ball(with_ball);
    Watched through(of_ball, 1, {-0.5, 0, 0});
    for (const Proximity& view : through.go({0.15, 0, 0}, 0.1)) EXPECT_FALSE(view.behind);
    Watched into(of_ball, 1, {-0.5, 0, 0});
    EXPECT_TRUE(into.go({0.05, 0, 0}).at(0).behind);
}

TEST(SideWatch, DepthAndOriginOfACrossingParticleAreReported) {
    const CollisionWorld world = world_of(plane_collider({0, 0, 0}, {0, 0, 1}));
    const SignedDistance distance(world);
    for (const double side : {1.0, -1.0}) {
        for (const double radius : {0.0, 0.1}) {
            Watched watched(distance, 1, {0, 0, side}, radius);
            EXPECT_TRUE(watched.go({0, 0, 0.5 * side}).empty());
            for (const double depth : {0.2, 3.0, 0.01}) {  // the particle stays behind at any depth, until it returns
                const auto seen = watched.go({0.1, 0, -depth * side});
                ASSERT_EQ(seen.size(), 1U);
                EXPECT_TRUE(seen[0].behind);
                EXPECT_DOUBLE_EQ(seen[0].distance, -depth - radius);
                EXPECT_EQ(seen[0].normal, (Vec3{0, 0, side}));
                EXPECT_TRUE(watched.watch.in_contact());
            }
            EXPECT_TRUE(watched.go({0, 0, 0.5 * side}).empty());
            EXPECT_FALSE(watched.watch.in_contact());
        }
    }
}

TEST(SideWatch, SurfacesAreReportedWithinTheMarginOnly) {
    const CollisionWorld world = world_of(plane_collider({0, 0, 0}, {0, 0, 1}));
    const SignedDistance distance(world);
    Watched watched(distance, 1, {0, 0, 0.2}, 0.1);
    EXPECT_TRUE(watched.go({0, 0, 0.1101}).empty());
    const auto seen = watched.go({0, 0, 0.1099});
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_NEAR(seen[0].distance, 0.0099, 1e-15);
    EXPECT_FALSE(seen[0].behind);
    EXPECT_FALSE(watched.watch.in_contact());
}

TEST(SideWatch, SideChangesAroundAnOpenRimOnly) {
    const CollisionWorld world = world_of(mesh_collider(floor_mesh(1.0, 4)));
    const SignedDistance distance(world);
    Watched around(distance, 1, {0.5, 0.1, 0.2});
    for (const Vec3& position : {Vec3{1.3, 0.1, 0.2}, Vec3{1.3, 0.1, -0.2}})
        EXPECT_TRUE(around.go(position, 0.4).empty() || !around.watch.in_contact());
    (void)around.go({0.5, 0.1, -0.2}, 0.4);
    EXPECT_FALSE(around.watch.in_contact());
    EXPECT_EQ(around.sides[0].side, -1);
    // A particle last reported near the rim keeps the side it came from.
    Watched unseen(distance, 1, {0.5, 0.1, 0.2});
    for (const Vec3& position : {Vec3{1.3, 0.1, 0.2}, Vec3{1.3, 0.1, -0.2}, Vec3{0.5, 0.1, -0.2}}) {
        EXPECT_TRUE(unseen.go(position).empty());
    }
    const auto seen = unseen.go({0.5, 0.1, 0.3});
    ASSERT_EQ(seen.size(), 1U);
    EXPECT_TRUE(seen[0].behind);
    EXPECT_EQ(seen[0].normal, (Vec3{0, 0, -1}));
    EXPECT_EQ(unseen.sides[0].side, -1);
    EXPECT_TRUE(unseen.go({0.5, 0.1, 0.2})[0].behind);
    Watched through(distance, 1, {0.5, 0.1, 0.2});
    (void)through.go({0.5, 0.1, -0.2}, 0.4);
    EXPECT_TRUE(through.watch.in_contact());
    EXPECT_EQ(through.sides[0].side, 1);
}

TEST(SideWatch, ResultsAreTheSameAfterASurvey) {
    const CollisionWorld world =
        world_of(mesh_collider(testing::solid("torus")), plane_collider({0, 0, -0.7}, {0.1, 0, 1}));
    const SignedDistance distance(world);
    RandomSequence random(3, 0, 0);
    int seen_any = 0;
    for (int i = 0; i < test::scaled(2000); ++i) {
        const Vec3 start = testing::random_vector(random, 1.5);
        Watched plain(distance, 2, start, 0.05);
        Watched surveyed(distance, 2, start, 0.05);
        const double reach = 0.6 * random.uniform();
        surveyed.watch.survey(start, reach);
        for (int k = 0; k < 3; ++k) {
            const Vec3 to = start + testing::random_vector(random, 1.5 * reach);
            const auto a = plain.go(to);
            const auto b = surveyed.go(to);
            ASSERT_EQ(a.size(), b.size()) << i;
            for (std::size_t j = 0; j < a.size(); ++j) {
                EXPECT_EQ(a[j].collider, b[j].collider);
                EXPECT_EQ(a[j].distance, b[j].distance);
                EXPECT_EQ(a[j].normal, b[j].normal);
            }
            seen_any += a.empty() ? 0 : 1;
        }
    }
    EXPECT_GT(seen_any, test::scaled(2000) / 10);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
