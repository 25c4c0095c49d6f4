#include "cli/wall_clearance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "support/simple_meshes.h"

namespace ricochet::cli {
namespace RICOCHET_FILE {

struct Balls {
    std::vector<Vec3> centers;
    std::vector<double> radii;
    std::vector<double> own;

    Balls(std::vector<Vec3> at, double radius, double own_radius = 0.0)
        : centers(std::move(at)), radii(centers.size(), radius), own(centers.size(), own_radius) {}
    void clear(const WallClearance& walls) { walls.clear({centers, radii, own}); }
};

WallClearance box_of(const Vec3& size) {
    WallClearance walls({});
    walls.add(cuboid_mesh(size));
    return walls;
}

TEST(WallClearance, BallsRestOnThePlaneThatContainsTheirPoints) {
    const WallClearance walls({{{0, 0, 1}, {0, 0, 1}}});
    Balls balls({{3, 4, 1 + 1e-12}, {3, 4, 1 - 1e-12}, {0, 0, 1.05}, {0, 0, 5}}, 0.1);
    balls.clear(walls);
    EXPECT_NEAR(balls.centers[0].z, 1.1, 1e-3);
    EXPECT_NEAR(balls.centers[1].z, 0.9, 1e-3);  // each on its own side
    EXPECT_NEAR(balls.centers[2].z, 1.1, 1e-12);
    EXPECT_EQ(balls.centers[3], (Vec3{0, 0, 5}));
    for (const double radius : balls.radii) EXPECT_EQ(radius, 0.1);
}

TEST(WallClearance, BallsOfTheirOwnSizeAreNotMoved) {
    Balls balls({{0, 0, -0.45}, {0.49, 0.49, 0.49}}, 0.1, 0.1);
    const std::vector<Vec3> before = balls.centers;
    balls.clear(box_of({1, 1, 1}));
    EXPECT_EQ(balls.centers, before);
    EXPECT_EQ(balls.radii, (std::vector<double>{0.1, 0.1}));
}

// Points are inside a cube, also in its corners and edges, and outside of it. No ball may cross a face.
TEST(WallClearance, NoBallPokesThroughABox) {
    const WallClearance walls = box_of({1, 1, 1});
    RandomSequence random(5, 0, 0);
    std::vector<Vec3> points;
    for (int k = 0; k < 500; ++k) {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis) p[axis] = random.uniform_around(0, k % 2 == 0 ? 0.4999999 : 0.7);
        if (k % 3 == 0) p.x = 0.5 - 1e-10;
        if (k % 5 == 0) p.y = -0.5 + 1e-10;
        if (k % 7 == 0) p.z = 0.5 - 1e-10;
        points.push_back(p);
    }
    Balls balls(points, 0.12);
    balls.clear(walls);
    for (std::size_t i = 0; i < points.size(); ++i) {
        SCOPED_TRACE(std::to_string(i));
        const Vec3& c = balls.centers[i];
        EXPECT_EQ(max_abs(points[i]) < 0.5, max_abs(c) < 0.5);
        const double inner = 0.5 - max_abs(c);
        Vec3 outside;
        for (int axis = 0; axis < 3; ++axis) outside[axis] = std::max(0.0, std::fabs(c[axis]) - 0.5);
        EXPECT_GE((inner > 0.0 ? inner : length(outside)), 0.98 * balls.radii[i]);
        EXPECT_EQ(balls.radii[i], 0.12);  // there is enough space everywhere
        EXPECT_LT(length(c - points[i]), 2.0 * 0.12);
    }
}

TEST(WallClearance, BallsInAGapFillItsWidth) {
    WallClearance walls({{{0, 0, 0}, {0, 0, 1}}});
    walls.add({{{-9, -9, 0.1}, {9, -9, 0.1}, {0, 9, 0.1}}, {{0, 1, 2}}});
    Balls balls({{0, 0, 1e-9}, {0, 0, 0.03}, {0, 0, 0.1 - 1e-9}, {0, 0, 0.02}}, 0.5);
    balls.own = {0.0, 0.0, 0.0, 0.06};
    balls.clear(walls);
    for (std::size_t i = 0; i < 4; ++i) {
        SCOPED_TRACE(std::to_string(i));
        EXPECT_GT(balls.centers[i].z, 0.0);
        EXPECT_LT(balls.centers[i].z, 0.1);
        EXPECT_LE(balls.radii[i], i == 3 ? 0.06 : 0.0501);
        EXPECT_GE(balls.radii[i], i == 3 ? 0.06 : 0.025);
    }
}

TEST(WallClearance, RotatedAndShiftedScenesGiveRotatedAndShiftedBalls) {
    const TriangleMesh ball = testing::sphere_mesh({}, 1.0, 2);
    Placement placement;
    placement.position = {100, -20, 3};
    const AffineMap map = world_from_local(placement);
    TriangleMesh moved = ball;
    for (Vec3& vertex : moved.vertices) vertex = map.point(vertex);
    WallClearance here({});
    here.add(ball);
    WallClearance there({});
    there.add(moved);
    Balls at({{0.9, 0.1, 0.2}, {0, 0, -0.95}, {1.02, 0, 0}}, 0.2);
    Balls shifted = at;
    for (Vec3& center : shifted.centers) center = map.point(center);
    at.clear(here);
    shifted.clear(there);
    for (std::size_t i = 0; i < at.centers.size(); ++i) {
        EXPECT_LT(length(map.point(at.centers[i]) - shifted.centers[i]), 1e-9);
        EXPECT_NEAR(at.radii[i], shifted.radii[i], 1e-9);
    }
}

TEST(WallClearance, WithoutWallsNothingMoves) {
    Balls balls({{1, 2, 3}}, 0.5);
    balls.clear(WallClearance({}));
    EXPECT_EQ(balls.centers[0], (Vec3{1, 2, 3}));
    EXPECT_EQ(balls.radii[0], 0.5);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::cli
