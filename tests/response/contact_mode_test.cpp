#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_interval.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;
const std::array<Vec3, 1> kFloor{Vec3{0, 0, 1}};

std::array<Vec3, 1> slope(double angle) { return {Vec3{std::sin(angle), 0, std::cos(angle)}}; }

ContactInterval plan_slide(const Vec3& velocity, const Vec3& a, std::span<const Vec3> normals, double friction,
                           double duration) {
    std::vector<SupportSurface> surfaces;
    for (const Vec3& normal : normals) surfaces.push_back({normal, friction});
    return plan_interval({velocity, {}}, 0.0, a, surfaces, {}, duration);
}

TEST(ContactMode, ParticleWithoutTangentialForceRestsOnAFloor) {
    const ContactInterval slide = plan_slide({}, {0, 0, -kG}, kFloor, 0.0, 2.0);
    EXPECT_TRUE(slide.at_rest);
    EXPECT_EQ(slide.duration, 2.0);
}

TEST(ContactMode, ParticleSlidesFreelyWithoutFriction) {
    const ContactInterval slide = plan_slide({3, 0, -1}, {0, 0, -kG}, kFloor, 0.0, 2.0);
    EXPECT_FALSE(slide.at_rest);
    EXPECT_FALSE(slide.stuck[0].to_slip);
    EXPECT_EQ(slide.motion.velocity, (Vec3{3, 0, 0}));
    EXPECT_EQ(slide.acceleration, (Vec3{0, 0, 0}));
}

TEST(ContactMode, FrictionStopsASlideAfterTheClosedFormTime) {
    const ContactInterval slide = plan_slide({3, 4, 0}, {0, 0, -kG}, kFloor, 0.5, 10.0);
    EXPECT_TRUE(slide.stuck[0].to_slip);
    EXPECT_NEAR(slide.duration, 5.0 / (0.5 * kG), 1e-15);
    EXPECT_NEAR(slide.acceleration.x, -0.5 * kG * 0.6, 1e-15);
    EXPECT_NEAR(slide.acceleration.y, -0.5 * kG * 0.8, 1e-15);
    const ContactInterval shorter = plan_slide({3, 4, 0}, {0, 0, -kG}, kFloor, 0.5, 0.1);
    EXPECT_FALSE(shorter.stuck[0].to_slip);
    EXPECT_EQ(shorter.duration, 0.1);
}

TEST(ContactMode, StaticFrictionHoldsUpToItsLimit) {
    const double angle = 0.4;
    EXPECT_TRUE(plan_slide({}, {0, 0, -kG}, slope(angle), std::tan(angle) * 1.001, 1.0).at_rest);
    const ContactInterval slips = plan_slide({}, {0, 0, -kG}, slope(angle), std::tan(angle) * 0.5, 1.0);
    EXPECT_FALSE(slips.at_rest);
    EXPECT_NEAR(length(slips.acceleration), 0.5 * kG * std::sin(angle), 1e-14);
    EXPECT_GT(slips.acceleration.x, 0.0);
    EXPECT_LT(slips.acceleration.z, 0.0);
}

TEST(ContactMode, SlideAcceleratesDownhillAgainstFriction) {
    const double angle = 0.6;
    const Vec3 downhill{std::cos(angle), 0, -std::sin(angle)};
    const ContactInterval slide = plan_slide(2.0 * downhill, {0, 0, -kG}, slope(angle), 0.2, 1.0);
    EXPECT_NEAR(dot(slide.acceleration, downhill), kG * (std::sin(angle) - 0.2 * std::cos(angle)), 1e-14);
    EXPECT_FALSE(slide.stuck[0].to_slip);
}

TEST(ContactMode, ValleyOfThreeWallsHoldsWithoutFriction) {
    const std::array<Vec3, 3> valley{normalized(Vec3{1, 0, 1}), normalized(Vec3{-1, 1, 1}),
                                     normalized(Vec3{-1, -1, 1})};
    EXPECT_TRUE(plan_slide({0, 0, -3}, {0, 0, -kG}, valley, 0.0, 1.0).at_rest);
}

TEST(ContactMode, ValleyOfTwoWallsLeavesTheMotionAlongIt) {
    const std::array<Vec3, 2> valley{normalized(Vec3{1, 0, 1}), normalized(Vec3{-1, 0, 1})};
    const ContactInterval slide = plan_slide({0, 2, -3}, {0, 0, -kG}, valley, 0.0, 1.0);
    EXPECT_FALSE(slide.at_rest);
    EXPECT_NEAR(length(slide.motion.velocity - Vec3{0, 2, 0}), 0.0, 1e-15);
    EXPECT_NEAR(length(slide.acceleration), 0.0, 1e-14);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
