#include "python/merged_vertices.h"

#include <gtest/gtest.h>

#include <limits>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/closed_surface.h"
#include "ricochet/geometry/mesh/mesh_interior.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Gives each corner its own vertex, displaced by at most the given distance along each axis.
TriangleMesh loosened(const TriangleMesh& mesh, double most, RandomSequence& random) {
    TriangleMesh loose;
    for (const Triangle& t : mesh.triangles) {
        const auto first = static_cast<std::uint32_t>(loose.vertices.size());
        for (const std::uint32_t v : t) {
            const double x = most * (2.0 * random.uniform() - 1.0);
            const double y = most * (2.0 * random.uniform() - 1.0);
            loose.vertices.push_back(mesh.vertices[v] + Vec3{x, y, most * (2.0 * random.uniform() - 1.0)});
        }
        loose.triangles.push_back({first, first + 1, first + 2});
    }
    return loose;
}

TEST(MergedVertices, CloseNarrowGaps) {
    RandomSequence random(31, 0, 0);
    for (int variant = 0; variant < 12; ++variant) {
        SCOPED_TRACE(variant);
        const TriangleMesh sphere = testing::sphere_mesh({100.0 * random.uniform(), 0, -3}, 1.0 + random.uniform(), 2);
        const TriangleMesh loose = loosened(sphere, 1e-4, random);
        EXPECT_FALSE(is_closed(loose));
        const TriangleMesh merged = merged_within(loose, 4e-4);
        EXPECT_TRUE(is_closed(merged));
        EXPECT_EQ(merged.vertices.size(), sphere.vertices.size());
        ASSERT_EQ(merged.triangles.size(), loose.triangles.size());
        for (std::size_t t = 0; t < merged.triangles.size(); ++t) {
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec3 moved = merged.vertices[merged.triangles[t][k]] - loose.vertices[loose.triangles[t][k]];
                ASSERT_LE(length(moved), 4e-4);
            }
        }
    }
}

TEST(MergedVertices, JoinEqualPositionsForAToleranceOfZero) {
    RandomSequence random(32, 0, 0);
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1, 1, 1});
    const TriangleMesh merged = merged_within(loosened(box, 0.0, random), 0.0);
    EXPECT_EQ(merged.vertices.size(), 8U);
    EXPECT_TRUE(is_closed(merged));
    EXPECT_EQ(merged_within(loosened(box, 1e-9, random), 0.0).vertices.size(), 36U);
}

TEST(MergedVertices, DoNotAccumulateAlongAChain) {
    // 0, 0.6, 1.2, 1.8 with the tolerance 1: the second joins the first, the third is kept, the fourth joins the third.
    TriangleMesh chain;
    chain.vertices = {{0, 0, 0}, {0.6, 0, 0}, {1.2, 0, 0}, {1.8, 0, 0}, {0, 5, 0}};
    chain.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}};
    const TriangleMesh merged = merged_within(chain, 1.0);
    EXPECT_EQ(merged.vertices, (std::vector<Vec3>{{0, 0, 0}, {0, 5, 0}, {1.2, 0, 0}}));
    EXPECT_EQ(merged.triangles, (std::vector<Triangle>{{0, 0, 1}, {0, 2, 1}, {2, 2, 1}}));
}

TEST(MergedVertices, RefuseAToleranceBelowRounding) {
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1000, 1, 1});
    for (const double wrong : {-1.0, 1e-14, std::numeric_limits<double>::infinity(),
                               std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::denorm_min()}) {
        EXPECT_THROW((void)merged_within(box, wrong), InputError) << wrong;
    }
    EXPECT_EQ(merged_within(box, 1e-11).vertices.size(), 8U);
}

TEST(MergedVertices, RefuseAToleranceThatLeavesNoTriangle) {
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1, 1, 1});
    EXPECT_THROW((void)merged_within(box, 10.0), InputError);
    EXPECT_EQ(merged_within(box, 1.9).vertices.size(), 8U);
    // Triangles without area before the merge do not count against the tolerance.
    const TriangleMesh needle{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}};
    EXPECT_EQ(merged_within(needle, 10.0).vertices.size(), 1U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
