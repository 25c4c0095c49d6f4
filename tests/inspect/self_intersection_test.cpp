#include "inspect/self_intersections.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "support/counts.h"
#include "support/exact_oracle.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

std::size_t count(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
    return count_self_intersections({vertices, triangles});
}

const Vec3 kA{0, 0, 0};
const Vec3 kB{4, 0, 0};
const Vec3 kC{0, 4, 0};

TEST(SelfIntersection, IsNotFoundInAClosedConvexMesh) {
    EXPECT_EQ(count_self_intersections(testing::box_mesh({0, 0, 0}, {1, 2, 3})), 0U);
    EXPECT_EQ(count_self_intersections(testing::sphere_mesh({1, 2, 3}, 0.7, 4)), 0U);
}

TEST(SelfIntersection, CountsTrianglesThatCrossOrTouch) {
    EXPECT_EQ(count({kA, kB, kC, {1, 1, -1}, {1, 1, 1}, {9, 9, 0}}, {{0, 1, 2}, {3, 4, 5}}), 1U);
    EXPECT_EQ(count({kA, kB, kC, {1, 1, 0}, {1, 1, 1}, {9, 9, 1}}, {{0, 1, 2}, {3, 4, 5}}), 1U)
        << "touches with a corner";
    EXPECT_EQ(count({kA, kB, kC, {1, 1, 1e-80}, {1, 1, 1}, {9, 9, 1}}, {{0, 1, 2}, {3, 4, 5}}), 0U) << "a hair above";
    EXPECT_EQ(count({kA, kB, kC, {1, 1, 0}, {2, 1, 0}, {1, 2, 0}}, {{0, 1, 2}, {3, 4, 5}}), 1U) << "lies inside";
}

TEST(SelfIntersection, CountsACoincidentVertexWithAnotherIndex) {
    EXPECT_EQ(count({kA, kB, kC, kA, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {3, 4, 5}}), 1U);
    EXPECT_EQ(count({kA, kB, kC, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}}), 0U);
}

TEST(SelfIntersection, FindsIntersectionsBeyondACommonVertex) {
    EXPECT_EQ(count({kA, kB, kC, {2, 2, -1}, {1, 1, 1}}, {{0, 1, 2}, {0, 3, 4}}), 1U);
    EXPECT_EQ(count({kA, kB, kC, {2, 1, 0}, {1, 2, 0}}, {{0, 1, 2}, {3, 0, 4}}), 1U) << "in one plane";
}

TEST(SelfIntersection, FindsIntersectionsBeyondACommonEdge) {
    EXPECT_EQ(count({kA, kB, kC, {4, -4, 0}}, {{0, 1, 2}, {1, 0, 3}}), 0U);
    EXPECT_EQ(count({kA, kB, kC, {4, 4, 0}}, {{0, 1, 2}, {1, 0, 3}}), 1U) << "folded back, edges cross";
    EXPECT_EQ(count({kA, kB, kC, {1, 1, 0}}, {{0, 1, 2}, {1, 0, 3}}), 1U) << "folded back, one inside the other";
    EXPECT_EQ(count({kA, kB, kC, {1, 1, 1e-80}}, {{0, 1, 2}, {1, 0, 3}}), 0U);
}

TEST(SelfIntersection, CountsTrianglesOfTheSameVertices) {
    EXPECT_EQ(count({kA, kB, kC}, {{0, 1, 2}, {2, 1, 0}, {1, 2, 0}}), 3U);
}

TEST(SelfIntersection, SkipsDegenerateTriangles) {
    EXPECT_EQ(count({kA, kB, kC, {1, 1, -1}, {1, 1, 1}, {1, 1, 3}}, {{0, 1, 2}, {3, 4, 5}, {3, 3, 4}}), 0U);
}

// Tests a pair by rational arithmetic, without trees. The shared vertices are first cut off by a sufficient distance.
// The triangles intersect if an edge of one still intersects the other.
bool meet_exactly(const TriangleMesh& mesh, const Triangle& s, const Triangle& t) {
    std::vector<std::uint32_t> common;
    for (const std::uint32_t v : s) {
        if (std::find(t.begin(), t.end(), v) != t.end()) common.push_back(v);
    }
    const auto at = [&](std::uint32_t v) { return mesh.vertices[v]; };
    const auto edge_meets = [&](const Vec3& p, const Vec3& q, const Triangle& u) {
        return testing::exact_segment_intersects_triangle(p, q, at(u[0]), at(u[1]), at(u[2]));
    };
    const auto is_common = [&](std::uint32_t v) { return std::find(common.begin(), common.end(), v) != common.end(); };
    if (common.size() == 3) return true;
    for (const auto& [from, to] : {std::pair{s, t}, std::pair{t, s}}) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t p = from[k];
            const std::uint32_t q = from[(k + 1) % 3];
            if (is_common(p) && is_common(q)) continue;
            // All coordinates are small integers, so 2^-20 of an edge is less than any nonzero gap.
            const Vec3 start = is_common(p) ? at(p) + 0x1p-20 * (at(q) - at(p)) : at(p);
            const Vec3 end = is_common(q) ? at(q) + 0x1p-20 * (at(p) - at(q)) : at(q);
            if (edge_meets(start, end, to)) return true;
        }
    }
    return false;
}

TEST(SelfIntersection, AgreesWithRationalArithmeticOnRandomTriangles) {
    std::size_t found = 0;
    for (int seed = 0; seed < test::scaled(150); ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937_64 random(static_cast<std::uint64_t>(seed));
        std::uniform_int_distribution<int> grid(0, 3);
        TriangleMesh mesh;
        for (int i = 0; i < 7; ++i) {
            mesh.vertices.emplace_back(grid(random), grid(random), grid(random) / 2);
        }
        for (int i = 0; i < 5; ++i) {
            std::vector<std::uint32_t> names = {0, 1, 2, 3, 4, 5, 6};
            std::shuffle(names.begin(), names.end(), random);
            const Triangle t{names[0], names[1], names[2]};
            if (!are_collinear(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]))
                mesh.triangles.push_back(t);
        }
        std::size_t expected = 0;
        for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
            for (std::size_t j = i + 1; j < mesh.triangles.size(); ++j) {
                expected += meet_exactly(mesh, mesh.triangles[i], mesh.triangles[j]) ? 1 : 0;
            }
        }
        EXPECT_EQ(count_self_intersections(mesh), expected);
        found += expected;
    }
    EXPECT_GT(found, 0U);
}

TEST(SelfIntersection, IsFoundAcrossManyTriangles) {
    // In two spheres, every crossing pair has a triangle of each.
    const TriangleMesh one = testing::sphere_mesh({0, 0, 0}, 1.0, 3);
    const TriangleMesh other = testing::sphere_mesh({0.7, 0.1, 0.2}, 1.0, 3);
    const TriangleMesh both = testing::merged(one, other);
    const std::size_t pairs = [&] {
        std::size_t sum = 0;
        for (const Triangle& s : one.triangles) {
            for (const Triangle& t : other.triangles) {
                sum += count_self_intersections({{one.vertices[s[0]], one.vertices[s[1]], one.vertices[s[2]],
                                                  other.vertices[t[0]], other.vertices[t[1]], other.vertices[t[2]]},
                                                 {{0, 1, 2}, {3, 4, 5}}});
            }
        }
        return sum;
    }();
    EXPECT_GT(pairs, 0U);
    EXPECT_EQ(count_self_intersections(both), pairs);
}

// All triangles lie on each other. The number of pairs is quadratic, but the work of the search is not.
TEST(SelfIntersection, EndsEarlyIfNearlyAllPairsCross) {
    TriangleMesh mesh{{kA, kB, kC}, {}};
    mesh.triangles.assign(20000, {0, 1, 2});
    const SelfIntersections found = find_self_intersections(mesh);
    EXPECT_FALSE(found.are_all);
    EXPECT_GT(found.pairs, 256U * 20000U);
    EXPECT_LT(found.pairs, 10'000'000U);
    const ThreadLimit one(1);
    EXPECT_EQ(find_self_intersections(mesh).pairs, found.pairs);
    mesh.triangles.resize(1000);
    EXPECT_TRUE(find_self_intersections(mesh).are_all);
    EXPECT_EQ(count_self_intersections(mesh), 1000U * 999U / 2U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
