#include "inspect/mesh_openings.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns a rectangular tube about z, open at the bottom and the top.
TriangleMesh tube(double x, double y) {
    TriangleMesh mesh = testing::box_mesh({0, 0, 0}, {x, y, 1});
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
        const double z = mesh.vertices[t[0]].z;
        return mesh.vertices[t[1]].z == z && mesh.vertices[t[2]].z == z;
    });
    return mesh;
}

TEST(MeshOpenings, AreTheEndsOfATube) {
    const auto openings = openings_of(tube(2.0, 0.5));
    ASSERT_EQ(openings.size(), 2U);
    for (const MeshOpening& opening : openings) {
        EXPECT_NEAR(opening.width, 0.5, 1e-12);
        EXPECT_NEAR(opening.diameter, std::hypot(2.0, 0.5), 1e-12);
    }
}

TEST(MeshOpenings, AreAbsentInAClosedMesh) { EXPECT_TRUE(openings_of(testing::sphere_mesh({}, 1.0, 2)).empty()); }

}  // namespace RICOCHET_FILE
}  // namespace ricochet
