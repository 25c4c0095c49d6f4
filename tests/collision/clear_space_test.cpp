#include "ricochet/collision/clear_space.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/counts.h"
#include "support/mesh_distance.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::distance_from;
using testing::mesh_collider;
using testing::plane_collider;
using testing::query;
using testing::world_of;

bool is_clear(const CollisionWorld& world, const Path& path, double radius) {
    return find_clear_ball(world, path.c[0], radius, 10.0).contains(path, 0.0, radius);
}

/// Returns a random path of degree 1, 2 or 3.
Path random_path(RandomSequence& random) {
    const Vec3 start = 3.0 * random.in_unit_ball();
    const double size = random.uniform();
    if (random.uniform() < 0.3) return line_path(start, size * random.in_unit_ball(), 1.0);
    if (random.uniform() < 0.5) return parabola_path(start, size * random.in_unit_ball(), random.in_unit_ball(), 1.0);
    return hermite_path(start, size * random.in_unit_ball(), start + size * random.in_unit_ball(),
                        size * random.in_unit_ball(), 1.0);
}

TEST(ClearSpace, PathInItStaysAwayFromEveryTriangle) {
    const TriangleMesh mesh = testing::sphere_mesh({0.2, 0, 0}, 1.0, 3);
    CollisionWorld world = world_of(mesh_collider(mesh));
    RandomSequence random(5, 0, 0);
    int clear = 0;
    for (int k = 0; k < test::scaled(2000); ++k) {
        SCOPED_TRACE("case " + std::to_string(k));
        const double radius = k % 2 == 0 ? 0.0 : 0.1 * random.uniform();
        const Path path = random_path(random);
        if (!is_clear(world, path, radius)) continue;
        ++clear;
        for (int s = 0; s <= 20; ++s) ASSERT_GT(distance_from(mesh, path.position(s / 20.0)), radius);
        ContactScratch scratch;
        world.prepare_radius(radius);
        const ContactQueryResult found = query(world, scratch, path, radius);
        EXPECT_FALSE(found.contact);
        EXPECT_TRUE(found.near.is_free(path.c[0], path.end));
    }
    EXPECT_GT(clear, test::scaled(2000) / 10);
}

TEST(ClearBall, ContainsNoTriangleAndLeavesTheParticleNearlyAllTheSpace) {
    const TriangleMesh mesh = testing::sphere_mesh({0.2, 0, 0}, 1.0, 3);
    const CollisionWorld world = world_of(mesh_collider(mesh));
    RandomSequence random(6, 0, 0);
    for (int k = 0; k < test::scaled(1000); ++k) {
        SCOPED_TRACE("case " + std::to_string(k));
        const Vec3 center = 2.0 * random.in_unit_ball();
        const double radius = k % 2 == 0 ? 0.0 : 0.3 * random.uniform();
        const double within = 2.0 * random.uniform();
        const double room = distance_from(mesh, center) - radius;
        const ClearSpace ball = find_clear_ball(world, center, radius, within);
        EXPECT_TRUE(ball.is_known());
        EXPECT_TRUE(ball.is_at_rest());
        EXPECT_LE(ball.reach, std::max(0.0, room + radius));
        if (room <= 0.0) continue;
        EXPECT_GE(ball.reach - radius, 0.799 * std::min(within, room) - 1e-9);
    }
}

// The distance from a triangle is rounded in proportion to the triangle's size. A ball beside its plane must not reach
// behind it, where the centre is much nearer to the plane than to the corners.
TEST(ClearBall, DoesNotReachThroughATriangleThatIsHugeBesideTheDistance) {
    RandomSequence random(7, 0, 0);
    for (int k = 0; k < test::scaled(40); ++k) {
        SCOPED_TRACE("case " + std::to_string(k));
        const double size = std::pow(10.0, 9.0 * random.uniform());
        const Vec3 normal = random.unit_vector();
        const auto [t, b] = tangent_frame(normal);
        const TriangleMesh mesh{{size * t, size * (-0.5 * t + 0.8 * b), size * (-0.5 * t - 0.8 * b)}, {{0, 1, 2}}};
        const CollisionWorld world = world_of(mesh_collider(mesh));
        const Vec3 center = (1e-16 * size * random.uniform()) * normal + (0.01 * random.uniform()) * t;
        const ClearSpace ball = find_clear_ball(world, center, 0.0, 1.0);
        for (int s = 0; s < 10; ++s) {
            const Vec3 p = center + ball.reach * random.unit_vector();
            const auto [a, c, d] = world.corners_of_triangle(0);
            EXPECT_FALSE(segment_intersects_triangle(center, p, a, c, d)) << ball.reach;
        }
    }
}

TEST(ClearBall, IsKnownWhereTheDistanceFieldKnowsNothing) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 3);
    const CollisionWorld world = world_of(mesh_collider(mesh));
    const Vec3 near{0.9, 0.0, 0.0};
    EXPECT_LE(world.distance_field().lower_bound(near), 0.0);
    EXPECT_GT(find_clear_ball(world, near, 0.0, 1.0).reach, 0.07);
    EXPECT_GT(find_clear_ball(world, near, 0.05, 1.0).reach, 0.08);
}

// Also if a step is a small part of the radius.
TEST(ClearBall, GivesRoomToAThickSphere) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 3);
    const CollisionWorld world = world_of(mesh_collider(mesh));
    EXPECT_GT(find_clear_ball(world, {}, 0.5, 0.04).reach, 0.53);
}

TEST(ClearSpace, KnowsNothingAtFirst) {
    const ClearSpace space;
    EXPECT_FALSE(space.is_known());
    EXPECT_FALSE(space.contains(line_path({}, {}, 1.0), 0.0, 0.0));
}

/// Returns a space that moves with a parabola, from a time to another, in s.
ClearSpace space_along(const Path& parabola, double begin, double end, double reach) {
    return {parabola.c[0], parabola.c[1], parabola.c[2], begin, end, reach};
}

// The reference samples the distance of the two curves at equal times.
TEST(ClearSpace, ContainsOnlyPathsThatFollowItWithinItsWidth) {
    RandomSequence random(8, 0, 0);
    int contained = 0;
    for (int k = 0; k < test::scaled(2000); ++k) {
        SCOPED_TRACE("case " + std::to_string(k));
        const Path expected = parabola_path(random.in_unit_ball(), random.in_unit_ball(), random.in_unit_ball(), 1.0);
        const double from = 0.5 * random.uniform();
        const double width = 0.1;
        const double radius = k % 2 == 0 ? 0.0 : 0.3;
        const auto near = [&](double time) { return expected.position(time) + 0.12 * random.in_unit_ball(); };
        const Path path = hermite_path(near(from), expected.velocity(from) + 0.1 * random.in_unit_ball(),
                                       near(from + 0.4), expected.velocity(from + 0.4), 0.4);
        double farthest = 0.0;
        for (int s = 0; s <= 40; ++s) {
            const double time = 0.01 * s;
            farthest = std::max(farthest, length(path.position(time) - expected.position(from + time)));
        }
        const bool is_contained = space_along(expected, 7.0, 8.0, radius + width).contains(path, 7.0 + from, radius);
        contained += is_contained ? 1 : 0;
        if (is_contained) {
            EXPECT_LT(farthest, width);
        }
    }
    EXPECT_GT(contained, test::scaled(2000) / 10);
}

// The core of a sphere in overlap is smaller than the sphere that leaves the overlap later.
TEST(ClearSpace, LeavesAParticleThatHasGrownLessRoom) {
    const Path expected = parabola_path({}, {1, 0, 0}, {}, 1.0);
    const ClearSpace space = space_along(expected, 0.0, 1.0, 0.3);
    const Path beside = parabola_path({0, 0.1, 0}, {1, 0, 0}, {}, 1.0);
    EXPECT_TRUE(space.contains(beside, 0.0, 0.1));
    EXPECT_TRUE(space.contains(beside, 0.0, 0.19));
    EXPECT_FALSE(space.contains(beside, 0.0, 0.21));
    EXPECT_FALSE(space.contains(expected, 0.0, 0.3));
}

TEST(ClearSpace, ContainsNoPathWithANumberThatIsNotFinite) {
    const Path expected = parabola_path({}, {1, 0, 0}, {}, 1.0);
    const ClearSpace space = space_along(expected, 0.0, 1.0, 0.3);
    for (std::size_t k = 0; k < expected.c.size(); ++k) {
        Path path = expected;
        path.c[k].y = std::numeric_limits<double>::quiet_NaN();
        EXPECT_FALSE(space.contains(path, 0.0, 0.0)) << k;
    }
}

TEST(ClearSpace, ContainsNoPathThatBeginsBeforeIt) {
    const Path expected = parabola_path({1, 2, 3}, {1, 0, 0}, {0, 0, -1}, 1.0);
    EXPECT_FALSE(space_along(expected, 2.0, 4.0, 10.0).contains(expected, 1.9, 0.0));
}

TEST(ClearSpace, ContainsNoPathThatEndsAfterIt) {
    const Path expected = parabola_path({1, 2, 3}, {1, 0, 0}, {0, 0, -1}, 1.0);
    const ClearSpace space = space_along(expected, 2.0, 3.0, 0.1);
    EXPECT_TRUE(space.contains(expected, 2.0, 0.0));
    EXPECT_FALSE(space.contains(expected, 2.1, 0.0));
    EXPECT_FALSE(space_along(expected, 2.0, 2.9, 0.1).contains(expected, 2.0, 0.0));
}

TEST(ClearSpace, PlanesAndShapesBoundThePath) {
    Placement at_five;
    at_five.position = {5, 0, 0};
    CollisionWorld world =
        world_of(plane_collider({0, 0, 0}, {0, 0, 1}), ColliderDescription{"ball", BallShape{1.0, at_five}, 0});
    const Path along = line_path({0, 0, 1}, {0.5, 0, 0}, 1.0);
    EXPECT_TRUE(is_clear(world, along, 0.4));
    EXPECT_FALSE(is_clear(world, along, 1.0));
    EXPECT_FALSE(is_clear(world, line_path({0, 0, 1}, {0, 0, -2}, 1.0), 0.0));
    EXPECT_FALSE(is_clear(world, line_path({3, 0, 1}, {3, 0, 0}, 1.0), 0.5));
}

TEST(ClearBall, IsAsLargeAsWantedInAWorldWithoutSurfaces) {
    const CollisionWorld world(std::vector<ColliderDescription>{});
    EXPECT_TRUE(find_clear_ball(world, {}, 1.0, 1e8).contains(line_path({0, 0, 0}, {1e6, 0, 0}, 10.0), 0.0, 1.0));
}

// A path may return to its start, so its end alone says nothing.
TEST(ClearSpace, ClosedPathIsBoundedByItsControlPoints) {
    const TriangleMesh wall = testing::floor_mesh(1.0, 8);
    CollisionWorld world = world_of(mesh_collider(wall));
    const Path path = parabola_path({0, 0, 1.0}, {0, 0, -6}, {0, 0, 12}, 1.0);
    EXPECT_LT(length(path.end - path.c[0]), 1e-12);
    EXPECT_FALSE(is_clear(world, path, 0.0));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
