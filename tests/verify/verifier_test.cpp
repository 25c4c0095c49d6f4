#include "ricochet/verify/verifier.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ricochet/core/tolerances.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::box_mesh;

/// Returns the verifier of a box from 0 to 4.
Verifier box_verifier() { return Verifier({box_mesh({0, 0, 0}, {4, 4, 4})}); }

/// Checks one step of a particle along the given positions, from the first to the last.
std::vector<Violation> travel(const Verifier& verifier, VerifiedParticle& particle, const std::vector<Vec3>& places,
                              double radius = 0.0) {
    std::vector<Segment> segments;
    for (std::size_t k = 1; k < places.size(); ++k) segments.push_back({places[k - 1], places[k], 7.0});
    std::vector<Violation> violations;
    verifier.check({42, places.front(), places.back(), radius, 8.0, segments}, particle, violations);
    return violations;
}

std::vector<Violation> travel(const Verifier& verifier, const std::vector<Vec3>& places, double radius = 0.0) {
    VerifiedParticle particle = verifier.watch(places.front(), radius);
    return travel(verifier, particle, places, radius);
}

/// Returns the number of violations of a kind.
std::size_t count(const std::vector<Violation>& violations, ViolationKind kind) {
    std::size_t found = 0;
    for (const Violation& v : violations) found += v.kind == kind ? 1 : 0;
    return found;
}

TEST(Verifier, SegmentsInsideABoxPass) {
    EXPECT_TRUE(travel(box_verifier(), {{1, 1, 1}, {3, 3, 0x1p-60}, {1, 2, 3}}).empty());
    EXPECT_TRUE(travel(box_verifier(), {{1, 1, 1}, {3, 3, 1}}, 1.0).empty());
    EXPECT_TRUE(travel(box_verifier(), {{9, 1, 1}, {9, 9, 9}}).empty());
}

TEST(Verifier, CrossingHasParticlePositionTimeColliderAndTriangle) {
    const TriangleMesh far = testing::moved(box_mesh({0, 0, 0}, {1, 1, 1}), {50, 0, 0});
    const TriangleMesh box = box_mesh({0, 0, 0}, {4, 4, 4});
    // Both boxes have the same triangles. The expected number identifies the triangle hit on the box's side x = 4.
    const auto violations = travel(Verifier({far, box}), {{1, 1, 3}, {7, 1, 3}});
    ASSERT_EQ(violations.size(), 2U);
    const Violation& crossing = violations[0];
    EXPECT_EQ(crossing.kind, ViolationKind::crossing);
    EXPECT_EQ(crossing.particle, 42U);
    EXPECT_EQ(crossing.position, Vec3(4, 1, 3));
    EXPECT_EQ(crossing.time, 7.0);
    EXPECT_EQ(crossing.collider, 1U);
    ASSERT_TRUE(crossing.triangle);
    for (const std::uint32_t corner : box.triangles[*crossing.triangle]) EXPECT_EQ(box.vertices[corner].x, 4.0);
    EXPECT_EQ(violations[1].kind, ViolationKind::wrong_side);
    EXPECT_EQ(violations[1].position, Vec3(7, 1, 3));
    EXPECT_EQ(violations[1].time, 8.0);
    EXPECT_EQ(violations[1].collider, 1U);
}

TEST(Verifier, SegmentThroughAnEdgeAndACornerIsReported) {
    // Both triangles of an edge are reported. A corner has at most six triangles.
    EXPECT_EQ(count(travel(box_verifier(), {{3, 1, 3}, {5, 1, 5}}), ViolationKind::crossing), 2U);
    EXPECT_GE(count(travel(box_verifier(), {{3, 3, 3}, {5, 5, 5}}), ViolationKind::crossing), 3U);
}

TEST(Verifier, SegmentThatEndsOnATriangleIsReported) {
    const auto violations = travel(box_verifier(), {{1, 1, 3}, {4, 1, 3}});
    EXPECT_EQ(count(violations, ViolationKind::crossing), 1U);
    EXPECT_EQ(count(violations, ViolationKind::wrong_side), 1U);
}

TEST(Verifier, SegmentThatLeavesAndReturnsInOneStepIsReported) {
    const auto violations = travel(box_verifier(), {{1, 1, 3}, {5, 1, 3}, {5, 2, 3}, {1, 2, 3}});
    EXPECT_EQ(count(violations, ViolationKind::crossing), 2U);
    EXPECT_EQ(violations.size(), 2U);
}

TEST(Verifier, SegmentThroughAnOpenMeshIsReported) {
    TriangleMesh open = box_mesh({0, 0, 0}, {4, 4, 4});
    open.triangles.resize(2);  // the lower side only
    const Verifier verifier({open});
    EXPECT_TRUE(travel(verifier, {{1, 1, 1}, {9, 1, 1}, {9, 1, -1}, {1, 2, -1}}).empty());
    const auto violations = travel(verifier, {{1, 2, 1}, {1, 2, -1}});
    ASSERT_EQ(violations.size(), 1U);
    EXPECT_EQ(violations[0].kind, ViolationKind::crossing);
}

TEST(Verifier, GapsBetweenSegmentsAreReported) {
    const Verifier verifier = box_verifier();
    const Vec3 a{1, 1, 1}, b{2, 2, 2}, c{3, 3, 3};
    const Vec3 a_little_off{1, 1, std::nextafter(1.0, 2.0)};
    const auto gaps = [&](const Vec3& remembered, const Vec3& from, const std::vector<Segment>& segments,
                          const Vec3& to) {
        VerifiedParticle particle = verifier.watch(remembered, 0.0);
        std::vector<Violation> violations;
        verifier.check({1, from, to, 0.0, 8.0, segments}, particle, violations);
        EXPECT_EQ(count(violations, ViolationKind::gap), violations.size());
        return violations.size();
    };
    EXPECT_EQ(gaps(a, a, {{a, b}, {b, c}}, c), 0U);
    EXPECT_EQ(gaps(a, a, {}, a), 0U);
    EXPECT_EQ(gaps(a_little_off, a, {{a, b}}, b), 1U);          // since the last step
    EXPECT_EQ(gaps(a, a, {{a_little_off, b}}, b), 1U);          // at the start
    EXPECT_EQ(gaps(a, a, {{a, a_little_off}, {b, c}}, c), 1U);  // between
    EXPECT_EQ(gaps(a, a, {{a, b}}, c), 1U);                     // at the end
    EXPECT_EQ(gaps(a, a, {}, a_little_off), 1U);                // moved without a segment
    EXPECT_EQ(gaps({0, 1, 1}, {-0.0, 1, 1}, {}, {-0.0, 1, 1}), 1U);
}

TEST(Verifier, ParticleThatJumpsOutsideIsReported) {
    const Verifier verifier = box_verifier();
    VerifiedParticle particle = verifier.watch({1, 1, 1}, 0.0);
    std::vector<Violation> violations;
    verifier.check({5, {1, 1, 1}, {9, 1, 1}, 0.0, 8.0, {}}, particle, violations);
    ASSERT_EQ(violations.size(), 2U);
    EXPECT_EQ(violations[0].kind, ViolationKind::gap);
    EXPECT_EQ(violations[1].kind, ViolationKind::wrong_side);
    EXPECT_EQ(violations[1].collider, 0U);
    // The jump is reported once.
    EXPECT_TRUE(travel(verifier, particle, {{9, 1, 1}, {9, 2, 1}}).empty());
}

TEST(Verifier, SidesOfPlanesAndShapesAreKnown) {
    AffineMap far;
    far.translation = {10, 0, 0};
    const Verifier verifier({VerifiedPlane{{0, 0, 0}, {0, 0, 2}}, VerifiedShape{far, false}, VerifiedShape{{}, true}});
    EXPECT_TRUE(travel(verifier, {{10, 0, 0.5}, {10, 0.9, 0.25}}).empty());  // inside the ball, over the plane
    const auto through_plane = travel(verifier, {{14, 0, 5}, {15, 0, -5}});
    ASSERT_EQ(through_plane.size(), 2U);
    EXPECT_EQ(through_plane[0].kind, ViolationKind::crossing);
    EXPECT_EQ(through_plane[0].collider, 0U);
    EXPECT_FALSE(through_plane[0].triangle);
    EXPECT_EQ(through_plane[1].kind, ViolationKind::wrong_side);
    const auto through_ball = travel(verifier, {{8, 0, 0.5}, {12, 0, 0.5}});
    ASSERT_EQ(through_ball.size(), 1U);
    EXPECT_EQ(through_ball[0].collider, 1U);
    EXPECT_EQ(count(travel(verifier, {{0, 0, 0.5}, {0, 0, 3}}), ViolationKind::wrong_side), 1U);  // out of the cylinder
    EXPECT_EQ(count(travel(verifier, {{0, 0, 0.5}, {0, 0, 0}}), ViolationKind::crossing), 1U);    // ends on the plane
}

TEST(Verifier, SphereMovedIntoAWallByABillionthIsReported) {
    AffineMap far;
    far.translation = {20, 2, 2};
    const Verifier verifier({box_mesh({0, 0, 0}, {4, 4, 4}), VerifiedPlane{{0, 0, -9}, {0, 0, 1}},
                             VerifiedShape{far, false}, VerifiedShape{far, true}});
    const double off = 1e-9;
    struct Case {
        Vec3 from;
        Vec3 touching;
        Vec3 into;
        std::uint32_t collider;
    };
    const std::vector<Case> cases = {
        {{2, 2, 2}, {3.5, 2, 2}, {1, 0, 0}, 0},    {{2, 2, 2}, {2, 3.5, 2}, {0, 1, 0}, 0},
        {{9, 9, -2}, {9, 9, -8.5}, {0, 0, -1}, 1}, {{20, 2, 2}, {20.5, 2, 2}, {1, 0, 0}, 2},
        {{20, 9, 2}, {20, 3.5, 2}, {0, -1, 0}, 2}, {{20.9, 2, 9}, {20.9, 2, 3.5}, {0, 0, -1}, 3}};
    for (const Case& c : cases) {
        EXPECT_TRUE(travel(verifier, {c.from, c.touching}, 0.5).empty());
        EXPECT_TRUE(travel(verifier, {c.from, c.touching + 1e-13 * c.into}, 0.5).empty());  // within the tolerance
        const auto violations = travel(verifier, {c.from, c.touching + off * c.into}, 0.5);
        ASSERT_EQ(violations.size(), 1U);
        EXPECT_EQ(violations[0].kind, ViolationKind::overlap);
        EXPECT_EQ(violations[0].collider, c.collider);
        EXPECT_EQ(violations[0].triangle.has_value(), c.collider == 0);
    }
}

TEST(Verifier, SphereSpawnedInOverlapIsCheckedOnceItHasBeenFree) {
    const Verifier verifier = box_verifier();
    VerifiedParticle particle = verifier.watch({0.3, 2, 2}, 0.5);
    EXPECT_FALSE(particle.has_been_free);
    EXPECT_TRUE(travel(verifier, particle, {{0.3, 2, 2}, {0.2, 2, 2}}, 0.5).empty());
    EXPECT_TRUE(travel(verifier, particle, {{0.2, 2, 2}, {2, 2, 2}}, 0.5).empty());
    EXPECT_TRUE(particle.has_been_free);
    EXPECT_EQ(travel(verifier, particle, {{2, 2, 2}, {0.2, 2, 2}}, 0.5).size(), 1U);
}

TEST(Verifier, ParticleSpawnedOnASurfaceMayChooseItsSide) {
    const Verifier verifier({box_mesh({0, 0, 0}, {4, 4, 4}), VerifiedPlane{{0, 0, 0}, {0, 0, 1}}});
    const Vec3 birth{1, 2, 0};
    for (const double side : {1.0, -1.0}) {
        VerifiedParticle particle = verifier.watch(birth, 0.0);
        EXPECT_TRUE(particle.is_on_surface);
        EXPECT_TRUE(travel(verifier, particle, {birth, {1, 2, side}}).empty());
        EXPECT_TRUE(travel(verifier, particle, {{1, 2, side}, {2, 2, side}}).empty());
        // From then on the particle must stay on this side.
        EXPECT_EQ(count(travel(verifier, particle, {{2, 2, side}, {2, 2, -side}}), ViolationKind::wrong_side), 2U);
    }
    // The particle may leave the surface, but not cross another one or move along this one.
    EXPECT_EQ(count(travel(verifier, {birth, {1, 2, 5}}), ViolationKind::crossing), 1U);
    EXPECT_GE(count(travel(verifier, {birth, {1, 3, 0}}), ViolationKind::crossing), 1U);
}

TEST(Verifier, TrianglesWithoutAreaAreIgnored) {
    TriangleMesh mesh = box_mesh({0, 0, 0}, {4, 4, 4});
    mesh.triangles.push_back({0, 7, 7});  // a segment across the inside
    EXPECT_TRUE(travel(Verifier({mesh}), {{1, 1, 3}, {3, 3, 1}}).empty());
}

TEST(Verifier, ParticleThatIsNotFiniteIsNotChecked) {
    const Verifier verifier = box_verifier();
    const double nan = std::numeric_limits<double>::quiet_NaN();
    VerifiedParticle particle = verifier.watch({nan, 0, 0}, 1.0);
    std::vector<Violation> violations;
    verifier.check({1, {nan, 0, 0}, {nan, 0, 0}, 1.0, 1.0, {}}, particle, violations);
    EXPECT_TRUE(violations.empty());
    // Becoming non-finite is a violation, however.
    EXPECT_GE(count(travel(verifier, {{1, 1, 1}, {nan, 0, 0}}), ViolationKind::gap), 1U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
