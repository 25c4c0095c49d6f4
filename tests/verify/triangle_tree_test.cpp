#include "ricochet/verify/triangle_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "ricochet/core/random.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet::verify {
namespace RICOCHET_FILE {

constexpr std::uint64_t kSeed = 80;

std::vector<NamedTriangle> triangles_of(const TriangleMesh& mesh) {
    std::vector<NamedTriangle> triangles;
    for (const auto& [a, b, c] : mesh.triangles) {
        triangles.push_back(
            {{mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}, 3, static_cast<std::uint32_t>(triangles.size())});
    }
    return triangles;
}

// Uses small and large triangles, near the origin and far away, and segments through vertices, along axes, and points.
TEST(TriangleTree, SearchFindsEveryTriangleThatASegmentIntersects) {
    std::size_t met = 0;
    std::size_t visited = 0;
    for (const double distance : {0.0, 1e6}) {
        const Vec3 offset{distance, -distance, 0.5 * distance};
        const TriangleMesh mesh = testing::moved(
            testing::merged(testing::sphere_mesh({0, 0, 0}, 1.0, 3), testing::box_mesh({-3, -3, -3}, {3, 3, 3})),
            offset);
        const std::vector<NamedTriangle> triangles = triangles_of(mesh);
        const TriangleTree tree(triangles);
        for (int i = 0; i < test::scaled(2000); ++i) {
            RandomSequence random(kSeed, 0, static_cast<std::uint64_t>(i));
            Vec3 p = offset + 4.0 * random.in_unit_ball();
            Vec3 q = offset + 4.0 * random.in_unit_ball();
            if (i % 4 == 1) q = mesh.vertices[static_cast<std::size_t>(i) % mesh.vertices.size()];
            if (i % 4 == 2) q = p + Vec3{0, 0, 2};
            if (i % 4 == 3) p = q = mesh.vertices[static_cast<std::size_t>(i) % mesh.vertices.size()];
            std::set<std::uint32_t> near;
            tree.near_segment(p, q, [&](const NamedTriangle& t) {
                EXPECT_EQ(t.collider, 3U);
                EXPECT_TRUE(near.insert(t.triangle).second);
            });
            visited += near.size();
            for (const NamedTriangle& t : triangles) {
                if (!intersects(p, q, t.corners)) continue;
                ++met;
                ASSERT_TRUE(near.contains(t.triangle)) << "case " << i;
            }
        }
    }
    EXPECT_GT(met, 0U);
    EXPECT_LT(visited, 100 * met);
}

TEST(TriangleTree, SearchFindsTheTrianglesThatOverlapABox) {
    const TriangleTree tree(triangles_of(testing::box_mesh({0, 0, 0}, {2, 2, 2})));
    const auto count = [&](const Vec3& lower, const Vec3& upper) {
        int found = 0;
        tree.near_box({lower, upper}, [&](const NamedTriangle&) { ++found; });
        return found;
    };
    EXPECT_EQ(count({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}), 0);
    EXPECT_EQ(count({0.5, 0.5, 2}, {1.5, 1.5, 3}), 2);
    EXPECT_EQ(count({-1, -1, -1}, {3, 3, 3}), 12);
    TriangleTree().near_box({{0, 0, 0}, {1, 1, 1}}, [](const NamedTriangle&) { FAIL(); });
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::verify
