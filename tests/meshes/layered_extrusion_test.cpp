#include "generators/layered_extrusion.h"

#include <array>

#include <gtest/gtest.h>

#include "meshes/mesh_checks.h"

namespace ricochet::meshes {
namespace RICOCHET_FILE {

TEST(Extrusion, UnitSquareBecomesACubeOfTwelveTriangles) {
    const TriangleMesh cube = extrusion(rectangle_region(1.0, 1.0, 2.0), 1.0, 2.0);
    EXPECT_EQ(cube.vertices.size(), 8U);
    EXPECT_EQ(cube.triangles.size(), 12U);
    EXPECT_EQ(unpaired_edges(cube), 0U);
    EXPECT_DOUBLE_EQ(signed_volume(cube), 1.0);
}

// Returns a square ring: the band between two squares whose corners lie on the same rays.
PlanarRegion square_target() {
    const std::vector<Point2> square{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    std::vector<Point2> outer = square;
    for (Point2& p : outer) p = {2.0 * p.x, 2.0 * p.y};
    const std::array bands{Band{2, 1}};
    return nested_region({square, outer}, bands, 0);
}

TEST(LayeredExtrusion, SlabsLeaveOutThePartsTheyDoNotName) {
    const std::array cup{Slab{0.5, 0b11, 1}, Slab{3.0, 0b10, 4}};
    const TriangleMesh mesh = layered_extrusion(square_target(), cup);
    EXPECT_EQ(unpaired_edges(mesh), 0U);
    EXPECT_EQ(euler_characteristic(mesh), 2);
    EXPECT_DOUBLE_EQ(signed_volume(mesh), 16.0 * 0.5 + 12.0 * 3.0);
}

TEST(LayeredExtrusion, PartInNoSlabBecomesATunnel) {
    const std::array tube{Slab{1.0, 0b10, 2}};
    const TriangleMesh mesh = layered_extrusion(square_target(), tube);
    EXPECT_EQ(unpaired_edges(mesh), 0U);
    EXPECT_EQ(euler_characteristic(mesh), 0);
    EXPECT_DOUBLE_EQ(signed_volume(mesh), 12.0);
}

TEST(LayeredExtrusion, PartLeftOutBetweenLidsBecomesAnInnerShell) {
    const std::array can{Slab{1.0, 0b11, 1}, Slab{2.0, 0b10, 2}, Slab{1.0, 0b11, 1}};
    const TriangleMesh mesh = layered_extrusion(square_target(), can);
    EXPECT_EQ(unpaired_edges(mesh), 0U);
    EXPECT_EQ(shells(mesh), 2U);
    EXPECT_EQ(euler_characteristic(mesh), 4);
    EXPECT_DOUBLE_EQ(signed_volume(mesh), 16.0 * 4.0 - 4.0 * 2.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::meshes
