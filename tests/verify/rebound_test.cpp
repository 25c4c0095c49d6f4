#include "ricochet/verify/rebound.h"

#include <gtest/gtest.h>

namespace ricochet::verify {
namespace RICOCHET_FILE {

/// Along x into a wall of restitution 0.7, on a floor of 0.3 that is approached by rounding.
RecordedImpact impact_on_wall(double rebound, bool floor_holds) {
    RecordedImpact impact;
    impact.before.velocity = {2, 0, -1e-16};
    impact.after.velocity = {-2 * rebound, 0, 0};
    impact.surfaces = {{5, {-1, 0, 0}, {}, {}, 0.7, 0.0, false}, {3, {0, 0, 1}, {}, {}, 0.3, 0.0, floor_holds}};
    return impact;
}

TEST(ReboundCheck, AsksForTheRestitutionOfTheSurfaceThatIsHit) {
    EXPECT_FALSE(has_wrong_rebound(impact_on_wall(0.7, true)));
    EXPECT_TRUE(has_wrong_rebound(impact_on_wall(0.3, true)));
    EXPECT_TRUE(has_wrong_rebound(impact_on_wall(0.0, true)));
    EXPECT_TRUE(has_wrong_rebound(impact_on_wall(0.9, true)));
}

TEST(ReboundCheck, KnowsWhatHasHeldTheParticleFromTheRecordOfContact) {
    RecordedImpact wrong = impact_on_wall(0.3, false);
    EXPECT_FALSE(has_wrong_rebound(wrong));  // as if it had flown in
    wrong.held_by = {3};
    EXPECT_TRUE(has_wrong_rebound(wrong));
    RecordedImpact right = impact_on_wall(0.7, false);
    right.held_by = {3};
    EXPECT_FALSE(has_wrong_rebound(right));
}

TEST(ReboundCheck, SeesASurfaceThatIsTakenForHoldingThoughItIsApproached) {
    RecordedImpact impact = impact_on_wall(0.7, true);
    impact.before.velocity.z = -0.5;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

TEST(ReboundCheck, SeesASurfaceThatIsTakenForHoldingThoughItIsLeft) {
    RecordedImpact impact = impact_on_wall(0.7, true);
    impact.before.velocity.z = 0.01;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

TEST(ReboundCheck, LetsASurfaceThatWasLeftBeApproachedByItsRestitutionAtMost) {
    RecordedImpact impact = impact_on_wall(0.3, false);
    impact.held_by = {3};
    impact.before.velocity.z = 0.01;
    impact.after.velocity = {-0.7 * 2, 0, -0.7 * 0.01};  // Moreau's law; the floor is hit next
    EXPECT_FALSE(has_wrong_rebound(impact));
    impact.after.velocity.z = -0.02;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

// The normal speed on a surface that holds counts as zero: a wall that is not at right angles to it may miss as much.
TEST(ReboundCheck, AllowsForTheNormalSpeedOnWhatHolds) {
    RecordedImpact impact = impact_on_wall(0.7, true);
    impact.before.velocity.z = 1e-7;
    impact.after.velocity = {-0.7 * 2 + 1e-7, 0, -1e-7};
    EXPECT_FALSE(has_wrong_rebound(impact));
    impact.after.velocity.x += 1e-6;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

TEST(ReboundCheck, CountsTheThresholdAndTheMotionOfSurfaces) {
    RecordedImpact impact;
    impact.before.velocity = {0, 0, -1};
    impact.surfaces = {{0, {0, 0, 1}, {0, 0, 1}, {0, 0, 0.9}, 0.8, 4.0, false}};
    impact.after.velocity = {0, 0, 0.9 + 0.8 * 0.5 * 2.0};  // at half the threshold half the restitution
    EXPECT_FALSE(has_wrong_rebound(impact));
    impact.after.velocity.z += 1e-6;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

TEST(ReboundCheck, LetsASurfaceBeLeftFasterOnlyIfAnotherOneHasItsRebound) {
    RecordedImpact impact;
    impact.before.velocity = {1, 0, -1};
    impact.surfaces = {{0, {0, 0, 1}, {}, {}, 0.5, 0.0, false}, {1, {-1, 0, 0}, {}, {}, 0.5, 0.0, false}};
    impact.after.velocity = {-0.5, 0, 0.9};
    EXPECT_FALSE(has_wrong_rebound(impact));
    impact.after.velocity = {-0.6, 0, 0.9};
    EXPECT_TRUE(has_wrong_rebound(impact));
    impact.after.velocity = {-0.4, 0, 0.5};
    EXPECT_TRUE(has_wrong_rebound(impact));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::verify
