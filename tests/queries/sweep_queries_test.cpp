#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/queries/mesh_queries.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Points = std::vector<Vec3>;

Points random_points(std::uint64_t seed, int count) {
    RandomSequence random(seed, 0, 0);
    Points points;
    for (int k = 0; k < count; ++k) {
        points.push_back({4 * random.uniform() - 2, 4 * random.uniform() - 2, 4 * random.uniform() - 2});
    }
    return points;
}

TEST(MeshSweep, PointsStopAtTheTrianglesTheirSegmentMeets) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 3);
    const int count = test::scaled(2000);
    const Points from = random_points(1, count);
    const Points to = random_points(2, count);
    const MeshHits hits = MeshQueries(mesh).sweep(from, to, {});
    for (std::size_t i = 0; i < from.size(); ++i) {
        bool meets = false;
        for (const Triangle& t : mesh.triangles) {
            meets = meets || segment_intersects_triangle(from[i], to[i], mesh.vertices[t[0]], mesh.vertices[t[1]],
                                                         mesh.vertices[t[2]]);
        }
        ASSERT_EQ(hits.triangle[i] != kNoHit, meets) << i;
    }
}

Points shifted(Points points, const Vec3& by) {
    for (Vec3& p : points) p += by;
    return points;
}

TEST(MeshSweep, SphereStopsARadiusBeforeAWall) {
    const MeshQueries box(testing::box_mesh({0, -4, -4}, {1, 4, 4}));
    const Points from(3, Vec3{-4, 0, 0});
    const Points to(3, Vec3{4, 0, 0});
    const std::vector<double> radii{0.5, 1.0, 0.0};
    EXPECT_EQ(box.sweep(from, to, radii).distance, (std::vector<double>{0.4375, 0.375, 0.5}));
    EXPECT_EQ(box.sweep(from, from, radii).triangle, std::vector<std::int64_t>(3, kNoHit));
}

// In the frame of a translating mesh, the sphere moves the opposite way and the mesh rests.
TEST(MeshSweep, SweepAgainstAMovingMeshMatchesTheSweepInItsFrame) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 2);
    const MeshQueries queries(mesh);
    const Vec3 shift{0.75, -0.5, 0.25};
    const Points after = shifted(mesh.vertices, shift);
    const int count = test::scaled(300);
    const Points from = random_points(3, count);
    const Points to = random_points(4, count);
    const Points back = shifted(to, -shift);
    for (const double radius : {0.0, 0.125}) {
        const std::vector<double> radii{radius};
        const MeshHits moving = queries.sweep_moving(from, to, radii, after);
        const MeshHits resting = queries.sweep(from, back, radii);
        const NearestPoints nearest = queries.closest_points(from);
        int met = 0;
        for (std::size_t i = 0; i < from.size(); ++i) {
            if (nearest.distance[i] <= radius + 1e-9) continue;  // overlaps from the start
            if (moving.triangle[i] == kNoHit) {
                EXPECT_EQ(resting.triangle[i], kNoHit) << i;
            } else if (resting.triangle[i] != kNoHit) {
                EXPECT_NEAR(moving.distance[i], resting.distance[i], 1e-9) << i;
                ++met;
            }
        }
        EXPECT_GE(met, test::scaled(11));
    }
}

// Spheres that overlap at the start follow the same rule for static and translating meshes.
TEST(MeshSweep, OverlappingSpheresStopAlikeAtMovedAndStaticMeshes) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 2);
    const MeshQueries queries(mesh);
    const Vec3 shift{0.75, -0.5, 0.25};
    const Points after = shifted(mesh.vertices, shift);
    const std::vector<double> radii{0.25};
    const int count = test::scaled(1000);
    Points from = random_points(5, count);
    for (std::size_t i = 0; i < from.size(); ++i)
        from[i] = from[i] * ((0.8 + 0.4 * static_cast<double>(i) / count) / length(from[i]));
    Points to = random_points(6, count);
    const Points back = shifted(to, -shift);
    const MeshHits moving = queries.sweep_moving(from, to, radii, after);
    const MeshHits resting = queries.sweep(from, back, radii);
    int stopped = 0;
    int free = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        ASSERT_EQ(moving.triangle[i] == kNoHit, resting.triangle[i] == kNoHit) << i;
        if (moving.triangle[i] == kNoHit) {
            ++free;
            continue;
        }
        EXPECT_NEAR(moving.distance[i], resting.distance[i], 1e-9) << i;
        ++stopped;
    }
    EXPECT_GT(stopped, count / 2);
    EXPECT_GT(free, count / 50);
}

/// Sweeps a sphere against a wall that moves from height 0 to the given height.
MeshHits beside_a_wall(const Vec3& from, const Vec3& to, double height, double radius) {
    const TriangleMesh wall{{{-8, -8, 0}, {8, -8, 0}, {0, 8, 0}}, {{0, 1, 2}}};
    Points after = wall.vertices;
    for (Vec3& v : after) v.z = height;
    const std::vector<double> radii{radius};
    return MeshQueries(wall).sweep_moving(std::span(&from, 1), std::span(&to, 1), radii, after);
}

TEST(MeshSweep, OverlappingSphereIsFreeUnlessTheDistanceShrinks) {
    const Vec3 inside{0, 0, 0.5};
    EXPECT_EQ(beside_a_wall(inside, inside, 0.0, 1.0).triangle[0], kNoHit);             // both rest
    EXPECT_EQ(beside_a_wall(inside, {1, 0, 0.5}, 0.0, 1.0).triangle[0], kNoHit);        // along the wall
    EXPECT_EQ(beside_a_wall(inside, {1, 0, 2.5}, 2.0, 1.0).triangle[0], kNoHit);        // carried along
    EXPECT_EQ(beside_a_wall(inside, inside, -1.0, 1.0).triangle[0], kNoHit);            // the wall recedes
    EXPECT_EQ(beside_a_wall(inside, {0, 0, 4}, 3.0, 1.0).triangle[0], kNoHit);          // the wall follows, but slower
    EXPECT_EQ(beside_a_wall(inside, {0, 0, -4}, 0.0, 1.0).distance[0], 0.0);            // the sphere sinks in
    EXPECT_EQ(beside_a_wall(inside, inside, 0.25, 1.0).distance[0], 0.0);               // the wall approaches
    EXPECT_EQ(beside_a_wall({0, 0, 1}, {0, 0, 2}, 0.5, 1.0).triangle[0], kNoHit);       // touches and separates
    EXPECT_EQ(beside_a_wall({0, 0, 1}, {0, 0, 2}, 1.5, 1.0).distance[0], 0.0);          // the wall catches up
    EXPECT_EQ(beside_a_wall({0, 0, 0.5}, {0, 0, 0.5}, 0.25, 0.0).triangle[0], kNoHit);  // a point beside the wall
    EXPECT_EQ(beside_a_wall({0, 0, 0}, {0, 0, 1}, 0.0, 0.0).distance[0], 0.0);  // a point that starts on the wall
}

// A seesaw whose height at x is x t. A sphere below it moves from the rising side to the falling side.
TEST(MeshSweep, SphereStopsAtRecontactAndAtTheOverlapOfItsStart) {
    const MeshQueries seesaw({{{-4, -9, 0}, {-4, 9, 0}, {4, 0, 0}}, {{0, 1, 2}}});
    const Points after{{-4, -9, -4}, {-4, 9, -4}, {4, 0, 4}};
    const std::vector<double> radii{0.5};
    const auto stopped_at = [&](const Vec3& from, const Vec3& to) {
        return seesaw.sweep_moving(std::span(&from, 1), std::span(&to, 1), radii, after).distance[0];
    };
    const auto gap = [](double from, double to, double t) {
        return ((from + t * (to - from)) * t + 0.4) / std::sqrt(1.0 + t * t);
    };
    const double left = stopped_at({2, 0, -0.4}, {-3, 0, -0.4});
    EXPECT_GT(gap(2, -3, 0.2), 0.5);
    EXPECT_GT(left, 0.25);
    EXPECT_NEAR(gap(2, -3, left), 0.5, 1e-9);
    const double sunk = stopped_at({1, 0, -0.4}, {-3, 0, -0.4});
    EXPECT_GT(sunk, 0.2);
    EXPECT_NEAR(gap(1, -3, sunk), 0.4, 1e-9);
    EXPECT_EQ(stopped_at({-1, 0, -0.4}, {-1, 0, -0.4}), 0.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
