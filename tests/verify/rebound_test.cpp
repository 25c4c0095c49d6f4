#include "ricochet/verify/rebound.h"

#include <gtest/gtest.h>

namespace ricochet::verify {
namespace RICOCHET_FILE {

/// Returns an impact along x on a wall of restitution 0.7. The particle is on a floor of restitution 0.3, which it
/// approaches only by rounding.
RecordedImpact impact_on_wall(double rebound, bool floor_holds) {
    RecordedImpact impact;
    impact.before.velocity = {2, 0, -1e-16};
    impact.after.velocity = {-2 * rebound, 0, 0};
    impact.surfaces = {{5, {-1, 0, 0}, {}, {}, 0.7, 0.0, false}, {3, {0, 0, 1}, {}, {}, 0.3, 0.0, floor_holds}};
    return impact;
}

TEST(ReboundCheck, SurfaceThatIsHitDeterminesTheRestitution) {
    EXPECT_FALSE(has_wrong_rebound(impact_on_wall(0.7, true)));
    EXPECT_TRUE(has_wrong_rebound(impact_on_wall(0.3, true)));
    EXPECT_TRUE(has_wrong_rebound(impact_on_wall(0.0, true)));
    EXPECT_TRUE(has_wrong_rebound(impact_on_wall(0.9, true)));
}

TEST(ReboundCheck, SupportingSurfacesAreKnownFromTheContactRecord) {
    RecordedImpact wrong = impact_on_wall(0.3, false);
    EXPECT_FALSE(has_wrong_rebound(wrong));  // as if the particle had flown in
    wrong.supported_by = {3};
    EXPECT_TRUE(has_wrong_rebound(wrong));
    RecordedImpact right = impact_on_wall(0.7, false);
    right.supported_by = {3};
    EXPECT_FALSE(has_wrong_rebound(right));
}

TEST(ReboundCheck, ApproachedSurfaceTakenAsSupportIsReported) {
    RecordedImpact impact = impact_on_wall(0.7, true);
    impact.before.velocity.z = -0.5;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

TEST(ReboundCheck, SeparatingSurfaceTakenAsSupportIsReported) {
    RecordedImpact impact = impact_on_wall(0.7, true);
    impact.before.velocity.z = 0.01;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

TEST(ReboundCheck, SeparatingSurfaceMayBeApproachedByItsRestitutionAtMost) {
    RecordedImpact impact = impact_on_wall(0.3, false);
    impact.supported_by = {3};
    impact.before.velocity.z = 0.01;
    impact.after.velocity = {-0.7 * 2, 0, -0.7 * 0.01};  // Moreau's law; the floor is hit next
    EXPECT_FALSE(has_wrong_rebound(impact));
    impact.after.velocity.z = -0.02;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

// The normal speed on a supporting surface counts as zero. A wall that is not at right angles to it may err by that
// speed.
TEST(ReboundCheck, NormalSpeedOnASupportIsTolerated) {
    RecordedImpact impact = impact_on_wall(0.7, true);
    impact.before.velocity.z = 1e-7;
    impact.after.velocity = {-0.7 * 2 + 1e-7, 0, -1e-7};
    EXPECT_FALSE(has_wrong_rebound(impact));
    impact.after.velocity.x += 1e-6;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

TEST(ReboundCheck, ThresholdAndMotionOfSurfacesCount) {
    RecordedImpact impact;
    impact.before.velocity = {0, 0, -1};
    impact.surfaces = {{0, {0, 0, 1}, {0, 0, 1}, {0, 0, 0.9}, 0.8, 4.0, false}};
    impact.after.velocity = {0, 0, 0.9 + 0.8 * 0.5 * 2.0};  // at half the threshold half the restitution
    EXPECT_FALSE(has_wrong_rebound(impact));
    impact.after.velocity.z += 1e-6;
    EXPECT_TRUE(has_wrong_rebound(impact));
}

TEST(ReboundCheck, SurfaceMayBeLeftFasterOnlyIfAnotherOneHasItsRebound) {
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
