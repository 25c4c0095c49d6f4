// Inside tests by parity and by winding number, for nested and overlapping shells.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "inspect/shells.h"
#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/queries/mesh_queries.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Points = std::vector<Vec3>;
using Flags = std::vector<std::uint8_t>;

constexpr int kVariants = 12;

Vec3 drawn(const Vec3& lower, const Vec3& upper, RandomSequence& random) {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) p[axis] = lower[axis] + (upper[axis] - lower[axis]) * random.uniform();
    return p;
}

Points drawn_points(RandomSequence& random) {
    Points points;
    for (int k = 0; k < test::scaled(400); ++k) points.push_back(drawn({-2, -2, -2}, {2, 2, 2}, random));
    return points;
}

/// Returns a box or a ball around a random point of the box of side 2.
TriangleMesh drawn_shell(RandomSequence& random) {
    const Vec3 center = drawn({-1, -1, -1}, {1, 1, 1}, random);
    if (random.uniform() < 0.5) return testing::sphere_mesh(center, 0.3 + random.uniform(), 2);
    return testing::box_mesh(center - drawn({0.1, 0.1, 0.1}, {1, 1, 1}, random),
                             center + drawn({0.1, 0.1, 0.1}, {1, 1, 1}, random));
}

TEST(InsideRules, AgreeForOneShell) {
    RandomSequence random(21, 0, 0);
    for (int variant = 0; variant < kVariants; ++variant) {
        const TriangleMesh shell = drawn_shell(random);
        const Points points = drawn_points(random);
        for (const MeshQueries& mesh : {MeshQueries(shell), MeshQueries(testing::flipped(shell))}) {
            EXPECT_EQ(mesh.inside(points, InsideRule::winding), mesh.inside(points, InsideRule::parity)) << variant;
        }
    }
}

TEST(InsideRules, WindingJoinsShellsAndParityExcludesTheirOverlaps) {
    RandomSequence random(22, 0, 0);
    for (int variant = 0; variant < kVariants; ++variant) {
        SCOPED_TRACE(variant);
        std::vector<TriangleMesh> shells{drawn_shell(random), drawn_shell(random), drawn_shell(random)};
        TriangleMesh all;
        for (const TriangleMesh& shell : shells) all = testing::merged(all, shell);
        const Points points = drawn_points(random);
        const MeshQueries mesh(all);
        const Flags joined = mesh.inside(points, InsideRule::winding);
        const Flags odd = mesh.inside(points);
        const std::vector<double> distance = mesh.signed_distances(points, InsideRule::winding);
        std::vector<int> count(points.size(), 0);
        for (const TriangleMesh& shell : shells) {
            const Flags inside = MeshQueries(shell).inside(points);
            for (std::size_t i = 0; i < points.size(); ++i) count[i] += inside[i];
        }
        for (std::size_t i = 0; i < points.size(); ++i) {
            ASSERT_EQ(joined[i], count[i] > 0 ? 1 : 0);
            ASSERT_EQ(odd[i], count[i] % 2);
            ASSERT_EQ(distance[i]<0.0, count[i]> 0);
        }
    }
}

TEST(InsideRules, InnerShellIsAHoleByParityAndIfFlippedByWinding) {
    const TriangleMesh outer = testing::sphere_mesh({0, 0, 0}, 2.0, 2);
    const TriangleMesh inner = testing::sphere_mesh({0.2, 0, 0}, 1.0, 2);
    const Points points{{0, 0, 0}, {1.7, 0, 0}, {3, 0, 0}};
    const MeshQueries alike(testing::merged(outer, inner));
    EXPECT_EQ(alike.inside(points, InsideRule::winding), (Flags{1, 1, 0}));
    EXPECT_EQ(alike.inside(points, InsideRule::parity), (Flags{0, 1, 0}));
    const MeshQueries hollow(testing::merged(outer, testing::flipped(inner)));
    EXPECT_EQ(hollow.inside(points, InsideRule::winding), (Flags{0, 1, 0}));
    EXPECT_EQ(hollow.inside(points, InsideRule::parity), (Flags{0, 1, 0}));
}

TEST(InsideRules, WindingRuleRefusesInconsistentlyWoundMeshes) {
    TriangleMesh box = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    std::swap(box.triangles[3][0], box.triangles[3][1]);
    const MeshQueries mesh(box);
    EXPECT_TRUE(mesh.is_closed());
    const Points points{{0.5, 0.25, 0.5}};
    EXPECT_EQ(mesh.inside(points), Flags{1});
    try {
        (void)mesh.inside(points, InsideRule::winding);
        FAIL();
    } catch (const InputError& error) {
        EXPECT_NE(std::string(error.what()).find("choose the rule parity"), std::string::npos) << error.what();
    }
}

TEST(InsideRules, RepeatedTriangleChangesNeitherRule) {
    TriangleMesh box = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    box.triangles.push_back(box.triangles[5]);
    std::swap(box.triangles.back()[0], box.triangles.back()[1]);
    const Points points{{0.5, 0.25, 0.5}, {0.5, 0.25, 1.5}};
    EXPECT_EQ(MeshQueries(box).inside(points, InsideRule::winding), (Flags{1, 0}));
    EXPECT_EQ(MeshQueries(box).inside(points, InsideRule::parity), (Flags{1, 0}));
}

// docs/python-queries.md states these sums.
TEST(InsideRules, CrossingsAddUpToTheWindingNumber) {
    const auto sum = [](const TriangleMesh& shells, const Vec3& origin) {
        const Points origins{origin};
        const Points directions{{0.3, 0.2, 1}};
        int crossings = 0;
        for (const std::int8_t crossing : MeshQueries(shells).all_hits({origins, directions}).crossing) {
            crossings += crossing;
        }
        return crossings;
    };
    const TriangleMesh box = testing::box_mesh({0, 0, 0}, {2, 2, 2});
    const TriangleMesh other = testing::box_mesh({1, 0.5, 0.25}, {3, 2.5, 2.25});
    const TriangleMesh both = testing::merged(box, other);
    EXPECT_EQ(sum(box, {1, 1, 1}), 1);
    EXPECT_EQ(sum(box, {-1, 1, 1}), 0);
    EXPECT_EQ(sum(testing::flipped(box), {1, 1, 1}), -1);
    EXPECT_EQ(sum(both, {1.5, 1, 1}), 2);
    EXPECT_EQ(sum(both, {0.5, 1, 1}), 1);
    EXPECT_EQ(sum(testing::merged(box, testing::box_mesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5})), {1, 1, 1}), 2);
    EXPECT_EQ(
        sum(testing::merged(box, testing::flipped(testing::box_mesh({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}))), {1, 1, 1}), 0);
}

TEST(ShellsOverlap, AreFoundOnlyIfAPointIsWithinTwoOfThem) {
    const auto box = [](const Vec3& lower, const Vec3& upper) { return testing::box_mesh(lower, upper); };
    const TriangleMesh unit = box({0, 0, 0}, {1, 1, 1});
    const std::vector<TriangleMesh> overlapping = {
        box({0.5, 0.25, 0.125}, {1.5, 1.25, 1.125}),  // corner in corner
        box({0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}),        // edges through the diagonals of faces
        box({0.5, 0, 0}, {1.5, 1, 1}),                // edges in faces, faces in one plane
        box({0.5, 0, 0}, {1.5, 1, 2}),
        box({-1, 0.25, 0.25}, {2, 0.75, 0.75}),  // a rod through the box
        box({-1, 0, 0.25}, {2, 1, 0.75}),
        box({0, 0, 0.5}, {1, 1, 1.5}),
        box({-1, -1, 0.5}, {2, 2, 0.75}),
        box({0.25, 0.25, -1}, {0.75, 0.75, 2}),
        testing::sphere_mesh({1, 1, 1}, 0.5, 2),
        testing::sphere_mesh({0.5, 0.5, 1}, 0.4, 1),
    };
    for (std::size_t k = 0; k < overlapping.size(); ++k) {
        EXPECT_TRUE(shells_overlap(testing::merged(unit, overlapping[k]))) << k;
        EXPECT_TRUE(shells_overlap(testing::merged(testing::flipped(overlapping[k]), unit))) << k;
    }
    const std::vector<TriangleMesh> apart = {
        box({2, 0, 0}, {3, 1, 1}),                      // beside the box
        box({1, 0, 0}, {2, 1, 1}),                      // a common face
        box({1, 0.25, 0.25}, {2, 0.75, 0.75}),          // a part of a face
        box({1, 0.5, 0.5}, {2, 2, 2}),                  // parts of faces
        box({1, 1, 0}, {2, 2, 1}),                      // a common edge
        box({1, 1, 1}, {2, 2, 2}),                      // a common corner
        box({0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}),    // inside the box
        box({-1, -1, -1}, {2, 2, 2}),                   // around the box
        box({0, 0.25, 0.25}, {0.5, 0.75, 0.75}),        // inside the box, against a face
        box({0, 0, 0}, {0.5, 0.75, 0.75}),              // inside the box, in a corner
        box({0, 0, 0.25}, {1, 1, 0.75}),                // a slice of the box
        box({-1, 0, 0}, {2, 2, 1}),                     // around the box, with common faces
        box({0.25, 0.25, 1}, {0.75, 0.75, 1.5}),        // standing on the box
        testing::sphere_mesh({0.5, 0.5, 1.5}, 0.5, 1),  // a vertex on a face
        testing::sphere_mesh({0.5, 0.5, 0.5}, 0.4, 2),
    };
    for (std::size_t k = 0; k < apart.size(); ++k) {
        EXPECT_FALSE(shells_overlap(testing::merged(unit, apart[k]))) << k;
        EXPECT_FALSE(shells_overlap(testing::merged(testing::flipped(apart[k]), unit))) << k;
    }
    EXPECT_FALSE(shells_overlap(unit));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
