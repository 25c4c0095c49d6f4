#include "ricochet/geometry/mesh/triangle_mesh.h"

#include <gtest/gtest.h>

#include <numbers>

#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(TriangleMesh, HasTheBoundsAreaAndVolumeOfABox) {
    const TriangleMesh box = testing::box_mesh({-1, 0, 2}, {1, 3, 6});
    EXPECT_EQ(bounds(box).lower, (Vec3{-1, 0, 2}));
    EXPECT_EQ(bounds(box).upper, (Vec3{1, 3, 6}));
    EXPECT_DOUBLE_EQ(surface_area(box), 2 * (2 * 3 + 3 * 4 + 2 * 4));
    EXPECT_DOUBLE_EQ(signed_volume(box), 24.0);
    EXPECT_DOUBLE_EQ(signed_volume(testing::flipped(box)), -24.0);
}

TEST(TriangleMesh, VolumeAndAreaOfASphereConvergeFromBelowWithTheSquareOfTheEdge) {
    const double volume = 4.0 / 3.0 * std::numbers::pi;
    const double area = 4.0 * std::numbers::pi;
    const TriangleMesh coarse = testing::sphere_mesh({5, 6, 7}, 1.0, 4);
    const TriangleMesh fine = testing::sphere_mesh({5, 6, 7}, 1.0, 5);
    EXPECT_NEAR((volume - signed_volume(coarse)) / (volume - signed_volume(fine)), 4.0, 0.1);
    EXPECT_NEAR((area - surface_area(coarse)) / (area - surface_area(fine)), 4.0, 0.1);
}

TEST(TriangleMesh, VolumeKeepsItsDigitsFarFromTheOrigin) {
    const TriangleMesh box = testing::box_mesh({0, 0, 0}, {1, 2, 3});
    EXPECT_NEAR(signed_volume(testing::moved(box, {1e9, -1e9, 1e9})), 6.0, 1e-12);
}

TEST(TriangleMesh, BoundsExcludeUnusedVertices) {
    TriangleMesh box = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    box.vertices.push_back({100, 100, 100});
    EXPECT_EQ(bounds(box).upper, (Vec3{1, 1, 1}));
    EXPECT_TRUE(bounds(TriangleMesh{}).empty());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
