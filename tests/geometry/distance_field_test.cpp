#include "ricochet/geometry/acceleration/distance_field.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/mesh_distance.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::distance_from;

DistanceField grid_of(const TriangleMesh& mesh) {
    Box3 box;
    for (const Vec3& v : mesh.vertices) box.include(v);
    return {mesh.vertices, mesh.triangles, box};
}

/// Returns triangles of any shape and size, including slivers and points.
TriangleMesh soup(std::uint32_t count, RandomSequence& random) {
    TriangleMesh mesh;
    for (std::uint32_t k = 0; k < count; ++k) {
        const Vec3 corner = random.in_unit_ball();
        const double size = std::pow(10.0, -3.0 * random.uniform());
        const double width = k % 4 == 0 ? 0.0 : (k % 4 == 1 ? 1e-6 * size : size);
        mesh.vertices.insert(mesh.vertices.end(),
                             {corner, corner + size * random.unit_vector(), corner + width * random.unit_vector()});
        mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    return mesh;
}

TEST(DistanceField, NeverExceedsTheDistanceFromTheNearestTriangle) {
    RandomSequence random(41, 0, 0);
    int told = 0;
    for (int i = 0; i < test::scaled(30); ++i) {
        SCOPED_TRACE("case " + std::to_string(i));
        TriangleMesh mesh = soup(1U + static_cast<std::uint32_t>(40.0 * random.uniform()), random);
        const Vec3 scale{1.0, i % 3 == 0 ? 1e-3 : 1.0, i % 5 == 0 ? 0.0 : 1.0};
        const Vec3 origin = i % 2 == 0 ? Vec3{} : 1e5 * random.in_unit_ball();
        for (Vec3& v : mesh.vertices) v = origin + Vec3{scale.x * v.x, scale.y * v.y, scale.z * v.z};
        const DistanceField grid = grid_of(mesh);
        ASSERT_GT(grid.cell(), 0.0);
        for (int k = 0; k < 100; ++k) {
            const Vec3 p = origin + (k % 4 == 0 ? 10.0 : 1.5) * random.in_unit_ball();
            const double clearance = grid.lower_bound(p);
            ASSERT_GE(clearance, 0.0);
            ASSERT_LE(clearance, distance_from(mesh, p) * (1.0 + 1e-12)) << k;
            told += clearance > 0.0 ? 1 : 0;
        }
        for (const Vec3& v : mesh.vertices) ASSERT_EQ(grid.lower_bound(v), 0.0);
    }
    EXPECT_GT(told, test::scaled(30) * 50);
}

TEST(DistanceField, IsCloseToTheDistanceInOpenSpaceOfMeshesCoarseAndFine) {
    for (const int levels : {0, 3, 6}) {
        SCOPED_TRACE("levels " + std::to_string(levels));
        const TriangleMesh mesh = testing::sphere_mesh({3, 4, 5}, 1.0, levels);
        const DistanceField grid = grid_of(mesh);
        EXPECT_LT(grid.cell(), 0.1);
        EXPECT_LE(grid.memory_bytes(), DistanceField::kMaxCells);
        RandomSequence random(42, 0, 0);
        for (int k = 0; k < test::scaled(200); ++k) {
            const bool is_inside = k % 2 == 0;
            const Vec3 p = Vec3{3, 4, 5} + (is_inside ? 0.8 : 4.0) * random.in_unit_ball();
            // A distance along one axis can be short by the square root of three. Outside the box, the bound is the
            // distance from the box or from the entry point.
            const double least = distance_from(mesh, p) / std::sqrt(3.0) / (is_inside ? 1.0 : 2.0);
            EXPECT_GT(grid.lower_bound(p) + 3.0 * grid.cell(), least);
        }
    }
}

TEST(DistanceField, IsZeroWithoutTrianglesOrIfRoundingExceedsItsCells) {
    EXPECT_EQ(DistanceField().lower_bound({1, 2, 3}), 0.0);
    EXPECT_EQ(DistanceField({}, {}, {}).lower_bound({1, 2, 3}), 0.0);
    const TriangleMesh far = testing::moved(testing::sphere_mesh({}, 1.0, 2), {1e12, 0, 0});
    EXPECT_EQ(grid_of(far).cell(), 0.0);
    EXPECT_EQ(grid_of(far).lower_bound({1e12, 5, 0}), 0.0);
    TriangleMesh point;
    point.vertices.assign(3, {1, 1, 1});
    point.triangles.push_back({0, 1, 2});
    EXPECT_EQ(grid_of(point).lower_bound({5, 5, 5}), 0.0);
}

TEST(DistanceField, UsesCoarserCellsForStacksOfLargeTriangles) {
    RandomSequence random(43, 0, 0);
    TriangleMesh heap;
    for (std::uint32_t k = 0; k < 100'000; ++k) {
        heap.vertices.insert(heap.vertices.end(), {random.unit_vector(), random.unit_vector(), random.unit_vector()});
        heap.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
    }
    const DistanceField grid = grid_of(heap);
    EXPECT_LT(grid.memory_bytes(), 10'000U);  // two cells per triangle
    EXPECT_GT(grid.lower_bound({4, 0, 0}), 2.9);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
