// What is planted beside and through a mesh that deforms is reported; what goes with it, or stays inside, is not.
#include <gtest/gtest.h>

#include <vector>

#include "ricochet/verify/verifier.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace {

struct Stop {
    Vec3 place;
    double time;
};

std::size_t count(const std::vector<Violation>& violations, ViolationKind kind) {
    std::size_t found = 0;
    for (const Violation& violation : violations) found += violation.kind == kind ? 1 : 0;
    return found;
}

std::vector<Violation> travel(const VerifiedDeformation& surface, const std::vector<Stop>& stops, double radius = 0.0) {
    const Verifier verifier({surface});
    std::vector<Segment> segments;
    for (std::size_t k = 1; k < stops.size(); ++k) {
        segments.push_back({stops[k - 1].place, stops[k].place, stops[k - 1].time, stops[k - 1].time, stops[k].time});
    }
    VerifiedParticle particle = verifier.watch(stops.front().place, radius, stops.front().time);
    std::vector<Violation> violations;
    const Stop& last = stops.back();
    verifier.check({7, stops.front().place, last.place, radius, last.time, segments, {}, last.time}, particle,
                   violations);
    return violations;
}

/// A triangle that rises from 0 to 1 m in the first second, and falls again in the next.
VerifiedDeformation plate() {
    return {{{0, 1, 2}},
            {0.0, 1.0, 2.0},
            {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
            false};
}

/// A box that grows to twice its size in a second.
VerifiedDeformation growing_box() {
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1, 1, 1});
    VerifiedDeformation surface{box.triangles, {0.0, 1.0}, {box.vertices, box.vertices}, false};
    for (Vec3& vertex : surface.vertices[1]) vertex = 2.0 * vertex;
    return surface;
}

TEST(ADeformingMesh, ThatHasPassedAParticleWhichStayedIsReported) {
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.5}, 0.0}, {{0.2, 0.2, 0.5}, 0.4}}), ViolationKind::crossing), 0U);
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.5}, 0.0}, {{0.2, 0.2, 0.5}, 0.6}}), ViolationKind::crossing), 1U);
    EXPECT_EQ(count(travel(plate(), {{{0.9, 0.9, 0.5}, 0.0}, {{0.9, 0.9, 0.5}, 0.6}}), ViolationKind::crossing), 0U);
}

TEST(ADeformingMesh, IsKnownToTheLastPlace) {
    EXPECT_TRUE(travel(plate(), {{{0.2, 0.2, 0x1p-60}, 0.0}, {{0.2, 0.2, 1.0 + 0x1p-52}, 1.0}}).empty());
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0x1p-60}, 0.0}, {{0.2, 0.2, 1.0}, 1.0}}), ViolationKind::crossing),
              1U);
}

// Both ends of the link are free, and the plate is where it was: at the key it was higher.
TEST(ADeformingMesh, WantsLinksToEndAtItsKeysUnlessTheyAreFarAway) {
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.6}, 0.5}, {{0.2, 0.2, 0.6}, 1.5}}), ViolationKind::crossing), 1U);
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 1.1}, 0.5}, {{0.2, 0.2, 1.1}, 1.5}}), ViolationKind::crossing), 0U);
}

TEST(ADeformingMesh, KeepsTheSideOfWhatItEncloses) {
    EXPECT_TRUE(travel(growing_box(), {{{0.9, 0, 0}, 0.0}, {{1.9, 0.1, 0}, 1.0}}).empty());
    const auto left = travel(growing_box(), {{{0.9, 0, 0}, 0.0}, {{2.1, 0.1, 0}, 1.0}});
    EXPECT_GE(count(left, ViolationKind::crossing), 1U);
    EXPECT_EQ(count(left, ViolationKind::wrong_side), 1U);
    const auto entered = travel(growing_box(), {{{1.5, 0, 0}, 0.0}, {{1.5, 0, 0}, 1.0}});
    EXPECT_EQ(count(entered, ViolationKind::wrong_side), 1U);
}

TEST(ADeformingMesh, SeesASphereThatItHasReached) {
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.6}, 0.0}, {{0.2, 0.2, 0.6}, 0.45}}, 0.1), ViolationKind::overlap),
              0U);
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.6}, 0.0}, {{0.2, 0.2, 0.6}, 0.55}}, 0.1), ViolationKind::overlap),
              1U);
}

}  // namespace
}  // namespace ricochet
