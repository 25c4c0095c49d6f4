#include "lab/compare/tunnel_judge.h"

#include <gtest/gtest.h>

#include <set>

namespace ricochet {
namespace RICOCHET_FILE {

// Colliders 0 to 3, one of each kind.
constexpr std::uint32_t kPlane = 0;
constexpr std::uint32_t kBall = 1;
constexpr std::uint32_t kBody = 2;
constexpr std::uint32_t kSheet = 3;

Violation crossing(std::uint32_t collider, double time, const Vec3& place, std::uint32_t triangle = 0) {
    return {ViolationKind::crossing, 7, place, time, collider, triangle};
}

Violation wrong_side(std::uint32_t collider) { return {ViolationKind::wrong_side, 7, {}, 1.0, collider, std::nullopt}; }

// Returns a judge whose surfaces face away from the plane z = 0.
TunnelJudge make_judge() {
    return {{ColliderKind::plane, ColliderKind::shape, ColliderKind::closed_mesh, ColliderKind::open_mesh},
            [](const Violation& violation) {
                return Vec3{0.0, 0.0, violation.position.z};
            }};
}

TunnelCounts verdict_of(const std::vector<std::vector<Violation>>& steps, bool penetrating = false) {
    TunnelJudge judge = make_judge();
    for (const auto& step : steps) judge.add_step(step);
    return judge.verdict([penetrating](std::uint64_t) { return penetrating; });
}

TEST(TunnelJudge, FindsNothingWithoutViolations) {
    const TunnelCounts counts = verdict_of({{}, {}});
    EXPECT_EQ(counts.tunnelled + counts.wrong_side + counts.penetrating + counts.jumped + counts.passed, 0U);
}

TEST(TunnelJudge, AnOddNumberOfSideChangesCountsAsTheWrongSide) {
    for (const std::uint32_t collider : {kPlane, kBody}) {
        EXPECT_EQ(verdict_of({{wrong_side(collider)}}).tunnelled, 1U);
        EXPECT_EQ(verdict_of({{wrong_side(collider)}, {wrong_side(collider)}}).tunnelled, 0U);
        EXPECT_EQ(verdict_of({{wrong_side(collider)}, {wrong_side(collider)}, {wrong_side(collider)}}).wrong_side, 1U);
    }
}

TEST(TunnelJudge, AParticlePushedBackHasNotTunnelled) {
    const TunnelCounts counts = verdict_of({{wrong_side(kPlane)}}, true);
    EXPECT_EQ(counts.wrong_side, 1U);
    EXPECT_EQ(counts.penetrating, 1U);
    EXPECT_EQ(counts.tunnelled, 0U);
}

TEST(TunnelJudge, AParticleCountsOnceHoweverManySurfacesItIsBehind) {
    const TunnelCounts counts = verdict_of(
        {{wrong_side(kPlane), wrong_side(kBody), crossing(kBody, 0.0, {0, 0, 1}), crossing(kBody, 0.0, {0, 0, -1})}});
    EXPECT_EQ(counts.wrong_side, 1U);
    EXPECT_EQ(counts.jumped, 1U);
    EXPECT_EQ(counts.tunnelled, 1U);
}

TEST(TunnelJudge, ASegmentThroughBothFacesOfABodyIsAJump) {
    const TunnelCounts counts =
        verdict_of({{crossing(kBody, 0.0, {0, 0, 1}, 1), crossing(kBody, 0.0, {0, 0, -1}, 2)}}, true);
    EXPECT_EQ(counts.jumped, 1U);
    EXPECT_EQ(counts.wrong_side, 0U);
    EXPECT_EQ(counts.tunnelled, 1U);  // pushed back or not
}

TEST(TunnelJudge, CrossingsOfNeighboursAtOnePointCountOnce) {
    const Vec3 place{100.0, 0.0, 1.0};
    const Vec3 beside{100.0, 1e-12, 1.0};
    EXPECT_EQ(verdict_of({{crossing(kBody, 0.0, place, 1), crossing(kBody, 0.0, beside, 2)}}).jumped, 0U);
    EXPECT_EQ(verdict_of({{crossing(kSheet, 0.0, place, 1), crossing(kSheet, 0.0, beside, 2)}}).tunnelled, 1U);
    EXPECT_EQ(verdict_of({{crossing(kSheet, 0.0, place, 1), crossing(kSheet, 0.0, {100.0, 1e-3, 1.0}, 2)}}).tunnelled,
              0U);
}

TEST(TunnelJudge, CrossingsOfAnOpenSheetCountOverTheWholeChain) {
    EXPECT_EQ(verdict_of({{crossing(kSheet, 0.0, {0, 0, 1})}}).wrong_side, 1U);
    EXPECT_EQ(verdict_of({{crossing(kSheet, 0.0, {0, 0, 1})}, {}, {crossing(kSheet, 2.0, {0, 0, 1})}}).wrong_side, 0U);
    EXPECT_EQ(verdict_of({{crossing(kSheet, 0.0, {0, 0, 1}), crossing(kSheet, 0.1, {0, 0, 1})}}).wrong_side, 0U);
}

TEST(TunnelJudge, EnteringAndLeavingByTheSameFaceIsNoPassage) {
    const TunnelCounts counts = verdict_of(
        {{crossing(kBody, 0.0, {0, 0, 1}), wrong_side(kBody)}, {crossing(kBody, 1.0, {5, 0, 1}), wrong_side(kBody)}});
    EXPECT_EQ(counts.tunnelled, 0U);
    EXPECT_EQ(counts.passed, 0U);
}

TEST(TunnelJudge, EnteringAndLeavingByOppositeFacesIsAPassage) {
    for (const std::uint32_t collider : {kBall, kBody}) {
        const TunnelCounts counts = verdict_of({{crossing(collider, 0.0, {0, 0, 1}), wrong_side(collider)},
                                                {crossing(collider, 1.0, {5, 0, -1}), wrong_side(collider)}});
        EXPECT_EQ(counts.passed, 1U);
        EXPECT_EQ(counts.tunnelled, 1U);
        EXPECT_EQ(counts.wrong_side, 0U);
    }
}

TEST(TunnelJudge, APassageMayBeginAndEndInOneStep) {
    EXPECT_EQ(verdict_of({{crossing(kBody, 0.1, {0, 0, -1}), crossing(kBody, 0.0, {0, 0, 1})}}).passed, 1U);
    EXPECT_EQ(verdict_of({{crossing(kBody, 0.1, {0, 0, 1}), crossing(kBody, 0.0, {0, 0, 1})}}).passed, 0U);
}

TEST(TunnelJudge, ASegmentThroughABallIsAJumpAndOneIntoItIsNot) {
    EXPECT_EQ(verdict_of({{crossing(kBall, 0.0, {0, 0, -1})}}).jumped, 1U);
    EXPECT_EQ(verdict_of({{crossing(kBall, 0.0, {0, 0, 1}), wrong_side(kBall)}}).jumped, 0U);
    EXPECT_EQ(verdict_of({{crossing(kBall, 0.0, {0, 0, 1}), crossing(kBall, 0.1, {0, 0, 1})}}).tunnelled, 0U);
    EXPECT_EQ(
        verdict_of({{crossing(kBall, 0.0, {0, 0, 1}), crossing(kBall, 0.1, {0, 0, 1}), wrong_side(kBall)}}).jumped, 1U);
}

TEST(TunnelJudge, ParticlesAreJudgedSeparately) {
    TunnelJudge judge = make_judge();
    Violation other = wrong_side(kPlane);
    other.particle = 8;
    judge.add_step(std::vector{wrong_side(kPlane), other});
    judge.add_step(std::vector{other});
    const TunnelCounts counts = judge.verdict([](std::uint64_t id) { return id == 8; });
    EXPECT_EQ(counts.tunnelled, 1U);
    EXPECT_EQ(counts.penetrating, 0U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
