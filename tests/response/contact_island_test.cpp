#include "ricochet/response/contact_solver/contact_island.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "collision/worlds.h"
#include "response/pile.h"
#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::floor_mesh;
using testing::mesh_collider;
using testing::Pile;
using testing::plane_collider;

constexpr double kRadius = 0.005;
constexpr double kStep = 1e-3;
const Material kRough{"", 0.5, 0.5};
const PairMaterial kLaw{0.5, 0.5, 0.0};

double largest_way(const std::vector<Vec3>& from, const std::vector<Vec3>& to) {
    double most = 0.0;
    for (std::size_t i = 0; i < from.size(); ++i) most = std::max(most, length(to[i] - from[i]));
    return most;
}

TEST(ContactIsland, ColumnOfTwentyStandsForTenSeconds) {
    Pile pile({mesh_collider(floor_mesh(1.0, 8))}, kRough, kLaw);
    for (int i = 0; i < 20; ++i) pile.add({0, 0, kRadius * (2 * i + 1)}, kRadius);
    const std::vector<Vec3> start = pile.centers();
    pile.run(test::is_long_run() ? 10.0 : 1.0, kStep);
    EXPECT_LT(largest_way(start, pile.centers()), 1e-3 * kRadius);
    EXPECT_LT(pile.overlap, 1e-3);
    EXPECT_LT(pile.fastest(), 5e-6);
    EXPECT_EQ(pile.unsimulated, 0.0);
}

/// The tray has a rim, because friction alone would otherwise have to hold the foot.
TEST(ContactIsland, PyramidStandsInATray) {
    const int rows = test::is_long_run() ? 14 : 6;  // rows x rows balls at its foot
    const double rim = (2 * rows - 1) * kRadius;
    Pile pile({plane_collider({0, 0, 0}, {0, 0, 1}), plane_collider({-kRadius, 0, 0}, {1, 0, 0}),
               plane_collider({rim, 0, 0}, {-1, 0, 0}), plane_collider({0, -kRadius, 0}, {0, 1, 0}),
               plane_collider({0, rim, 0}, {0, -1, 0})},
              kRough, kLaw);
    const double rise = std::sqrt(2.0) * kRadius;
    for (int z = 0; z < rows; ++z) {
        for (int y = 0; y < rows - z; ++y) {
            for (int x = 0; x < rows - z; ++x) {
                pile.add({kRadius * (2 * x + z), kRadius * (2 * y + z), kRadius + z * rise}, kRadius);
            }
        }
    }
    const std::vector<Vec3> start = pile.centers();
    pile.run(test::is_long_run() ? 10.0 : 0.5, kStep);
    EXPECT_LT(largest_way(start, pile.centers()), 1e-3 * kRadius);
    EXPECT_LT(pile.overlap, 1e-3);
}

TEST(ContactIsland, LooseCloudSettlesInABoxAndGainsNoEnergy) {
    const double side = 12.0 * kRadius;
    Pile pile({mesh_collider(testing::flipped(testing::box_mesh({0, 0, 0}, {side, side, 1.0})))}, kRough, kLaw);
    RandomSequence random(1, 0, 0);
    for (int k = 0; k < test::scaled(256); ++k) {
        const double radius = kRadius * (0.8 + 0.4 * random.uniform());
        const double pitch = 3.0 * kRadius;
        const Vec3 place{pitch * (k % 4 + 0.5), pitch * (k / 4 % 4 + 0.5), pitch * (k / 16 + 0.5)};
        pile.add(place + (0.2 * kRadius) * random.unit_vector(), radius);
    }
    double energy = pile.energy();
    double overlap = 0.0;
    const double fall = 0.5 * kStep * Pile::kGravity * kStep * Pile::kGravity;  // energy of one kick, over the mass
    double mass = 0.0;
    for (const MovingParticle& particle : pile.particles()) mass += particle.state.mass;
    for (int k = 0; k < 600; ++k) {
        pile.step(kStep);
        EXPECT_LE(pile.energy(), energy + mass * fall) << k;
        energy = pile.energy();
        overlap = std::max(overlap, pile.overlap);
        for (const MovingParticle& particle : pile.particles()) {
            const Vec3& p = particle.state.position;
            const double r = particle.state.radius * (1.0 - 1e-12);
            ASSERT_TRUE(p.x >= r && p.y >= r && p.z >= r && p.x <= side - r && p.y <= side - r) << k;
        }
    }
    EXPECT_LT(overlap, 5e-3);
    EXPECT_LT(pile.overlap, 1e-3);
    EXPECT_LT(pile.fastest(), 0.05);
    EXPECT_EQ(pile.unsimulated, 0.0);
}

/// A flat floor of triangles must act like one plane when a ball rolls over its edges.
TEST(ContactIsland, BallRollsOverTheEdgesOfAFlatMeshAsOverAPlane) {
    std::vector<Vec3> ends;
    for (const bool is_mesh : {false, true}) {
        Pile pile({is_mesh ? mesh_collider(floor_mesh(1.0, 64)) : plane_collider({0, 0, 0}, {0, 0, 1})}, kRough, kLaw);
        pile.add({-0.3, 0.013, 0.05}, 0.05, {1.0, 0.21, 0.0});
        pile.run(0.5, kStep);
        ends.push_back(pile.centers().front());
    }
    EXPECT_LT(length(ends[0] - ends[1]), 1e-9);
    EXPECT_NEAR(ends[1].z, 0.05, 1e-12);
    EXPECT_GT(ends[1].x, 0.0);
}

TEST(ContactIsland, BeltMovesTheBallsOnIt) {
    Material belt{"", 0.5, 0.5};
    belt.motion.velocity = {0.3, 0, 0};
    Pile pile({plane_collider({0, 0, 0}, {0, 0, 1})}, belt, kLaw);
    pile.add({0, 0, kRadius}, kRadius);
    pile.add({0, 0, 3 * kRadius}, kRadius);
    for (MovingParticle& particle : pile.particles()) particle.state.velocity = {0.3, 0, 0};
    pile.run(0.2, kStep);
    EXPECT_NEAR(pile.centers()[0].x, 0.06, 1e-6);
    EXPECT_NEAR(pile.centers()[1].x, 0.06, 1e-6);
}

TEST(WallContacts, FlatFloorGivesOneContactAndACornerThree) {
    CollisionWorld box(
        std::vector<ColliderDescription>{mesh_collider(testing::flipped(testing::box_mesh({0, 0, 0}, {1, 1, 1})))});
    ContactScratch scratch;  // for the planes of triangles
    std::vector<WallContact> found;
    CollisionWorld floor(std::vector<ColliderDescription>{mesh_collider(floor_mesh(1.0, 8))});
    for (const Vec3& place : {Vec3{0.1, 0.05, 0.11}, Vec3{0.25, 0.25, 0.11}, Vec3{0.2, 0.2, 0.11}}) {
        found.clear();
        find_wall_contacts(SurfaceGeometry(floor, scratch.plane_cache), place, 0.1, 0.05, found);
        ASSERT_EQ(found.size(), 1U);
        EXPECT_LT(length(found[0].normal - Vec3{0, 0, 1}), 1e-12);
        EXPECT_NEAR(found[0].gap, 0.01, 1e-12);
    }
    found.clear();
    find_wall_contacts(SurfaceGeometry(box, scratch.plane_cache), {0.12, 0.13, 0.14}, 0.1, 0.05, found);
    ASSERT_EQ(found.size(), 3U);
    double gaps = 0.0;
    for (const WallContact& wall : found) gaps += wall.gap;
    EXPECT_NEAR(gaps, 0.02 + 0.03 + 0.04, 1e-12);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
