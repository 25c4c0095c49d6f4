// Checks that planted faults beside and through a deforming mesh are reported, and that particles moving with it or
// staying inside are not.
#include <gtest/gtest.h>

#include <vector>

#include "ricochet/verify/checked_deformation.h"
#include "ricochet/verify/verifier.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

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

/// Returns a triangle that rises from 0 to 1 m in the first second and falls again in the next.
VerifiedDeformation plate() {
    return {{{0, 1, 2}},
            {0.0, 1.0, 2.0},
            {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},
            false};
}

/// Returns a box that grows to twice its size in a second.
VerifiedDeformation growing_box() {
    const TriangleMesh box = testing::box_mesh({-1, -1, -1}, {1, 1, 1});
    VerifiedDeformation surface{box.triangles, {0.0, 1.0}, {box.vertices, box.vertices}, false};
    for (Vec3& vertex : surface.vertices[1]) vertex = 2.0 * vertex;
    return surface;
}

TEST(ADeformingMesh, MeshThatPassesARestingParticleIsReported) {
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.5}, 0.0}, {{0.2, 0.2, 0.5}, 0.4}}), ViolationKind::crossing), 0U);
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.5}, 0.0}, {{0.2, 0.2, 0.5}, 0.6}}), ViolationKind::crossing), 1U);
    EXPECT_EQ(count(travel(plate(), {{{0.9, 0.9, 0.5}, 0.0}, {{0.9, 0.9, 0.5}, 0.6}}), ViolationKind::crossing), 0U);
}

TEST(ADeformingMesh, PositionIsExactToTheLastBit) {
    EXPECT_TRUE(travel(plate(), {{{0.2, 0.2, 0x1p-60}, 0.0}, {{0.2, 0.2, 1.0 + 0x1p-52}, 1.0}}).empty());
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0x1p-60}, 0.0}, {{0.2, 0.2, 1.0}, 1.0}}), ViolationKind::crossing),
              1U);
}

// Both ends of the segment are free. At the key between them the plate was higher.
TEST(ADeformingMesh, SegmentsMustEndAtItsKeysUnlessTheyAreFarAway) {
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.6}, 0.5}, {{0.2, 0.2, 0.6}, 1.5}}), ViolationKind::crossing), 1U);
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 1.1}, 0.5}, {{0.2, 0.2, 1.1}, 1.5}}), ViolationKind::crossing), 0U);
}

/// Checks one step in which the particle's time stalls until `now`, and one in which it advances to a stop.
std::vector<Violation> wait_and_go(const VerifiedDeformation& surface, const Stop& from, double now, const Stop& to) {
    const Verifier verifier({surface});
    VerifiedParticle particle = verifier.watch(from.place, 0.0, from.time);
    std::vector<Violation> violations;
    verifier.check({7, from.place, from.place, 0.0, now, {}, {}, from.time}, particle, violations);
    const std::vector<Segment> segments{{from.place, to.place, from.time, from.time, to.time}};
    verifier.check({7, from.place, to.place, 0.0, to.time, segments, {}, to.time}, particle, violations);
    return violations;
}

// The plate was above or below the particle in the meantime.
TEST(ADeformingMesh, SegmentsOfAStalledParticleMaySpanKeys) {
    const Vec3 above{0.2, 0.2, 0.6};
    EXPECT_TRUE(wait_and_go(plate(), {above, 0.5}, 1.4, {above, 1.5}).empty());
    EXPECT_EQ(count(wait_and_go(plate(), {above, 0.5}, 1.2, {above, 1.3}), ViolationKind::crossing), 1U);
    EXPECT_TRUE(wait_and_go(plate(), {above, 0.5}, 1.2, {{0.2, 0.2, 0.8}, 1.3}).empty());
    // The particle was not stalled in any step.
    EXPECT_EQ(count(wait_and_go(plate(), {above, 0.5}, 0.5, {above, 1.5}), ViolationKind::crossing), 1U);
}

TEST(ADeformingMesh, MeshThatPassesAStalledParticleIsReportedAtTheEndOfTheRun) {
    const Verifier verifier({growing_box()});
    const VerifiedParticle waiting = verifier.watch({1.5, 0, 0}, 0.0, 0.25);
    std::vector<Violation> violations;
    verifier.check_end(7, 0.45, waiting, violations);
    EXPECT_TRUE(violations.empty());
    verifier.check_end(7, 1.0, waiting, violations);
    ASSERT_EQ(violations.size(), 1U);
    EXPECT_EQ(violations[0].kind, ViolationKind::wrong_side);
    EXPECT_EQ(violations[0].particle, 7U);
}

// The position is known in closed form: a plate at the height t^2 at 4097 keys, uneven in time, with linear
// interpolation between keys.
TEST(ADeformingMesh, PositionIsFoundAmongThousandsOfKeys) {
    constexpr int kKeys = 4096;
    for (const bool repeats : {false, true}) {
        VerifiedDeformation surface{{{0, 1, 2}}, {}, {}, repeats};
        for (int k = 0; k <= kKeys; ++k) {
            const double time = static_cast<double>(k) * k / (1.0 * kKeys * kKeys);
            const double z = time * time;
            surface.times.push_back(time);
            surface.vertices.push_back({{0, 0, z}, {1, 0, z}, {0, 1, z}});
        }
        for (const int k : {0, 1, 2, 1000, 2047, 2048, 3333, kKeys - 2, kKeys - 1}) {
            SCOPED_TRACE(k);
            const auto at = static_cast<std::size_t>(k);
            const double end = surface.times[at + 1];
            const double time = 0.5 * (surface.times[at] + end);
            const double height = 0.5 * (surface.times[at] * surface.times[at] + end * end);
            const double off = 1e-12;
            const auto met_by = [&](double z) {
                return count(travel(surface, {{{0.2, 0.2, z}, time}, {{0.2, 0.2, height + 2 * off}, time}}),
                             ViolationKind::crossing);
            };
            EXPECT_EQ(met_by(height + off), 0U);
            EXPECT_EQ(met_by(height - off), 1U);
        }
    }
}

TEST(ADeformingMesh, EnclosedParticlesMustStayInside) {
    EXPECT_TRUE(travel(growing_box(), {{{0.9, 0, 0}, 0.0}, {{1.9, 0.1, 0}, 1.0}}).empty());
    const auto left = travel(growing_box(), {{{0.9, 0, 0}, 0.0}, {{2.1, 0.1, 0}, 1.0}});
    EXPECT_GE(count(left, ViolationKind::crossing), 1U);
    EXPECT_EQ(count(left, ViolationKind::wrong_side), 1U);
    const auto entered = travel(growing_box(), {{{1.5, 0, 0}, 0.0}, {{1.5, 0, 0}, 1.0}});
    EXPECT_EQ(count(entered, ViolationKind::wrong_side), 1U);
}

TEST(ADeformingMesh, SphereReachedByTheMeshIsReported) {
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.6}, 0.0}, {{0.2, 0.2, 0.6}, 0.45}}, 0.1), ViolationKind::overlap),
              0U);
    EXPECT_EQ(count(travel(plate(), {{{0.2, 0.2, 0.6}, 0.0}, {{0.2, 0.2, 0.6}, 0.55}}, 0.1), ViolationKind::overlap),
              1U);
}

/// Each triangle has its own vertices, as exporters write seams.
TEST(DeformingVerifier, SeamsThatStayTogetherCloseAMeshAndOpeningSeamsDoNot) {
    const TriangleMesh box = testing::box_mesh({0, 0, 0}, {1, 1, 1});
    VerifiedDeformation seamed;
    seamed.times = {0.0, 1.0};
    seamed.vertices.resize(2);
    for (const Triangle& t : box.triangles) {
        const auto first = static_cast<std::uint32_t>(seamed.vertices[0].size());
        for (const std::uint32_t v : t) {
            seamed.vertices[0].push_back(box.vertices[v]);
            seamed.vertices[1].push_back(2.0 * box.vertices[v]);
        }
        seamed.triangles.push_back({first, first + 1, first + 2});
    }
    const verify::CheckedDeformation closed(0, seamed);
    ASSERT_TRUE(closed.is_closed());
    EXPECT_EQ(closed.side({0.5, 0.25, 0.5}, 0.5), Side::inside);
    EXPECT_EQ(closed.side({1.75, 1.75, 1.8}, 0.5), Side::outside);
    seamed.vertices[1][7].z += 0.5;
    EXPECT_FALSE(verify::CheckedDeformation(0, seamed).is_closed());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
