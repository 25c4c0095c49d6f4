#include "ricochet/geometry/mesh/mass_moments.h"

#include <gtest/gtest.h>

#include <numbers>

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kPi = std::numbers::pi;

void expect_near(const SymmetricMatrix& found, const SymmetricMatrix& expected, double within) {
    EXPECT_NEAR(found.xx, expected.xx, within);
    EXPECT_NEAR(found.yy, expected.yy, within);
    EXPECT_NEAR(found.zz, expected.zz, within);
    EXPECT_NEAR(found.xy, expected.xy, within);
    EXPECT_NEAR(found.xz, expected.xz, within);
    EXPECT_NEAR(found.yz, expected.yz, within);
}

// The moments are m (b^2 + c^2) / 12 about the axes through the centre, for any position of the box.
TEST(MassMoments, MatchTextbookValuesForABox) {
    const Placement placement{{3, -2, 7}};
    const MassMoments moments = moments_of(transformed(cuboid_mesh({1.0, 2.0, 0.5}), placement));
    EXPECT_NEAR(moments.volume, 1.0, 1e-14);
    EXPECT_LT(length(moments.center() - placement.position), 1e-14);
    expect_near(moments.inertia(), {4.25 / 12.0, 1.25 / 12.0, 5.0 / 12.0, 0, 0, 0}, 1e-13);
}

// A rotation by 90 degrees about z exchanges x and y.
TEST(MassMoments, RotateWithTheBody) {
    const MassMoments moments = moments_of(transformed(cuboid_mesh({1.0, 2.0, 0.5}), {{}, {0, 0, 1}, 90.0}));
    expect_near(moments.inertia(), {1.25 / 12.0, 4.25 / 12.0, 5.0 / 12.0, 0, 0, 0}, 1e-14);
}

// For the tetrahedron with corners at the origin and the three unit points, the integral of x y is 1/120.
TEST(MassMoments, MatchTheProductsOfATetrahedron) {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
    const MassMoments moments = moments_of(mesh);
    EXPECT_NEAR(moments.volume, 1.0 / 6.0, 1e-16);
    EXPECT_LT(length(moments.first - Vec3{1.0, 1.0, 1.0} / 24.0), 1e-16);
    expect_near(moments.second, {1.0 / 60.0, 1.0 / 60.0, 1.0 / 60.0, 1.0 / 120.0, 1.0 / 120.0, 1.0 / 120.0}, 1e-16);
    mesh.triangles = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
    EXPECT_NEAR(moments_of(mesh).volume, -1.0 / 6.0, 1e-16);
}

TEST(MassMoments, MatchTextbookValuesForBallsAndCylinders) {
    AffineMap ball;
    ball.row_x *= 2.0, ball.row_y *= 2.0, ball.row_z *= 2.0;
    ball.translation = {1, 1, 0};
    const MassMoments of_ball = moments_of_ball(ball);
    EXPECT_NEAR(of_ball.volume, 32.0 * kPi / 3.0, 1e-13);
    expect_near((1.0 / of_ball.volume) * of_ball.inertia(), diagonal_matrix(1.6), 1e-13);
    AffineMap cylinder;
    cylinder.row_z *= 3.0;  // radius 1, height 6
    const MassMoments of_cylinder = moments_of_cylinder(cylinder);
    EXPECT_NEAR(of_cylinder.volume, 6.0 * kPi, 1e-13);
    expect_near((1.0 / of_cylinder.volume) * of_cylinder.inertia(),
                {(3.0 + 36.0) / 12.0, (3.0 + 36.0) / 12.0, 0.5, 0, 0, 0}, 1e-13);
}

// Two halves of a box side by side equal the box.
TEST(MassMoments, AddUpOverParts) {
    const MassMoments whole = moments_of(cuboid_mesh({2, 1, 1}));
    const MassMoments parts = moments_of(transformed(cuboid_mesh({1, 1, 1}), {{-0.5, 0, 0}})) +
                              moments_of(transformed(cuboid_mesh({1, 1, 1}), {{0.5, 0, 0}}));
    EXPECT_NEAR(parts.volume, whole.volume, 1e-15);
    expect_near(parts.inertia(), whole.inertia(), 1e-15);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
