#include "view/render/preview.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ricochet {
namespace RICOCHET_FILE {

// Returns two triangles that share an edge along y, each inclined away from it by the given angle.
TriangleMesh roof(double lean) {
    return {{{0, 0, 0}, {0, 1, 0}, {-std::cos(lean), 0, -std::sin(lean)}, {std::cos(lean), 0, -std::sin(lean)}},
            {{0, 1, 2}, {0, 3, 1}}};
}

TEST(CornerNormals, GentleEdgesAreSmooth) {
    const auto normals = corner_normals(roof(0.2), 40.0);
    EXPECT_NEAR(normals[0][0].z, 1.0, 1e-12);
    EXPECT_EQ(normals[0][0], normals[1][0]);
    EXPECT_NEAR(normals[0][2].z, std::cos(0.2), 1e-12);
}

TEST(CornerNormals, SharpEdgesStaySharp) {
    const auto normals = corner_normals(roof(0.5), 40.0);
    EXPECT_NEAR(normals[0][0].x, -std::sin(0.5), 1e-12);
    EXPECT_NEAR(normals[1][0].x, std::sin(0.5), 1e-12);
}

TEST(CornerNormals, TrianglesWithoutAreaDoNoHarm) {
    const TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 1}}};
    const auto normals = corner_normals(mesh, 40.0);
    EXPECT_EQ(normals[0][1], Vec3(0, 0, 1));
    EXPECT_TRUE(is_finite(normals[1][0]));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
