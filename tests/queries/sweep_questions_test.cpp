#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/queries/mesh_queries.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace {

using Points = std::vector<Vec3>;

Points random_points(std::uint64_t seed, int count) {
    RandomSequence random(seed, 0, 0);
    Points points;
    for (int k = 0; k < count; ++k) {
        points.push_back({4 * random.uniform() - 2, 4 * random.uniform() - 2, 4 * random.uniform() - 2});
    }
    return points;
}

TEST(MeshSweep, PointsAreStoppedByWhatTheirSegmentMeets) {
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

TEST(MeshSweep, ASphereIsStoppedARadiusBeforeAWall) {
    const MeshQueries box(testing::box_mesh({0, -4, -4}, {1, 4, 4}));
    const Points from(3, Vec3{-4, 0, 0});
    const Points to(3, Vec3{4, 0, 0});
    const std::vector<double> radii{0.5, 1.0, 0.0};
    EXPECT_EQ(box.sweep(from, to, radii).distance, (std::vector<double>{0.4375, 0.375, 0.5}));
    EXPECT_EQ(box.sweep(from, from, radii).triangle, std::vector<std::int64_t>(3, kNoHit));
}

// In the frame of a mesh that moves as a whole, the sphere moves the other way and the mesh rests.
TEST(MeshSweep, AMeshThatMovesIsMetWhereASphereThatMovesTheOtherWayMeetsIt) {
    const TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 2);
    const MeshQueries queries(mesh);
    const Vec3 shift{0.75, -0.5, 0.25};
    Points after = mesh.vertices;
    for (Vec3& v : after) v += shift;
    const int count = test::scaled(300);
    const Points from = random_points(3, count);
    const Points to = random_points(4, count);
    Points back = to;
    for (Vec3& p : back) p += -shift;
    for (const double radius : {0.0, 0.125}) {
        const std::vector<double> radii{radius};
        const MeshHits moving = queries.sweep_moving(from, to, radii, after);
        const MeshHits resting = queries.sweep(from, back, radii);
        const NearestPoints nearest = queries.closest_points(from);
        int met = 0;
        for (std::size_t i = 0; i < from.size(); ++i) {
            if (nearest.distance[i] <= radius + 1e-9) continue;  // in contact from the start
            if (moving.triangle[i] == kNoHit) {
                EXPECT_EQ(resting.triangle[i], kNoHit) << i;
            } else if (resting.triangle[i] != kNoHit) {
                EXPECT_NEAR(moving.distance[i], resting.distance[i], 1e-9) << i;
                ++met;
            }
        }
        EXPECT_GT(met, 10);
    }
}

}  // namespace
}  // namespace ricochet
