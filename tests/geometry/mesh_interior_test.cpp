#include "ricochet/geometry/mesh/mesh_interior.h"

#include <gtest/gtest.h>

#include <memory>

#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_reader.h"
#include "ricochet/verify/parity.h"
#include "support/allocation_guard.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::shared_ptr<const TriangleMesh> shared(TriangleMesh mesh) {
    return std::make_shared<const TriangleMesh>(std::move(mesh));
}

TEST(MeshInterior, ExcludesTheSurfaceOfABox) {
    const MeshInterior box(shared(testing::box_mesh({0, 0, 0}, {2, 2, 2})));
    EXPECT_TRUE(box.contains({1, 1, 1}));
    EXPECT_TRUE(box.contains({1, 1, 0x1p-300}));  // below and above the diagonals of both caps
    EXPECT_FALSE(box.contains({1, 1, 0}));
    EXPECT_FALSE(box.contains({1, 1, 2}));
    EXPECT_FALSE(box.contains({1, 1, -1}));
    EXPECT_FALSE(box.contains({3, 1, 1}));
    EXPECT_FALSE(box.contains({0, 0, 0}));
    EXPECT_FALSE(box.contains({1, 1, std::numeric_limits<double>::quiet_NaN()}));
}

TEST(MeshInterior, AgreesWithAnIndependentOracleEverywhere) {
    TriangleMesh nested = testing::merged(testing::sphere_mesh({0, 0, 0}, 2.0, 3),
                                          testing::flipped(testing::sphere_mesh({0.3, 0, 0}, 1.0, 2)));
    for (const auto& mesh : {shared(std::move(nested)),
                             shared(read_mesh(std::string(RICOCHET_SOURCE_DIR) + "/meshes/torus_knot.obj").mesh),
                             shared(read_mesh(std::string(RICOCHET_SOURCE_DIR) + "/meshes/gear.obj").mesh)}) {
        const MeshInterior interior(mesh);
        const ParityOracle oracle(*mesh);
        const Box3 box = interior.box();
        RandomSequence random(5, 0, 0);
        int inside = 0;
        for (int k = 0; k < test::scaled(20000); ++k) {
            Vec3 p;
            for (int axis = 0; axis < 3; ++axis) {
                p[axis] = box.lower[axis] + (box.upper[axis] - box.lower[axis]) * random.uniform();
            }
            ASSERT_EQ(interior.contains(p), oracle.inside(p)) << p.x << " " << p.y << " " << p.z;
            inside += interior.contains(p) ? 1 : 0;
        }
        EXPECT_GT(inside, 0);
    }
}

// Integer points in a mesh with integer vertices give rays through vertices, along edges and in the planes of faces.
TEST(MeshInterior, CountsRaysThroughVerticesAndAlongEdgesCorrectly) {
    const TriangleMesh boxes =
        testing::merged(testing::box_mesh({0, 0, 0}, {4, 4, 4}), testing::box_mesh({4, 4, 5}, {8, 8, 8}));
    const MeshInterior interior(shared(boxes));
    const ParityOracle oracle(boxes);
    for (int x = -1; x <= 9; ++x) {
        for (int y = -1; y <= 9; ++y) {
            for (int z = -1; z <= 9; ++z) {
                const Vec3 p{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
                if (oracle.side(p) == Side::on_surface) {
                    ASSERT_FALSE(interior.contains(p));
                } else {
                    ASSERT_EQ(interior.contains(p), oracle.inside(p)) << x << " " << y << " " << z;
                }
            }
        }
    }
}

// Each of these large stacked triangles lies in every column. Both sides of a sheet count.
TEST(MeshInterior, UsesMemoryInProportionToTheTriangles) {
    TriangleMesh mesh = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    for (std::uint32_t k = 0; k < 10000; ++k) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        const double z = 0.25 + 1e-5 * k;
        mesh.vertices.insert(mesh.vertices.end(), {{0, 0, z}, {1, 0, z}, {0, 1, z}});
        mesh.triangles.insert(mesh.triangles.end(), 2, {first, first + 1, first + 2});
    }
    const auto many = shared(std::move(mesh));
    const test::AllocationGuard guard;
    const MeshInterior interior(many);
    EXPECT_LT(guard.peak_bytes(), 32'000'000U);
    EXPECT_TRUE(interior.contains({0.4, 0.5, 0.6}));
    EXPECT_FALSE(interior.contains({0.4, 0.5, 1.6}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
