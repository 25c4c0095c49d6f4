#include "ricochet/response/flat_interval.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "ricochet/geometry/sweep/path.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;
constexpr double kAngle = 0.4;

const Vec3 kNormal{std::sin(kAngle), 0.0, std::cos(kAngle)};
const Vec3 kDownhill{std::cos(kAngle), 0.0, -std::sin(kAngle)};
const Vec3 kSideways{0.0, 1.0, 0.0};
const Vec3 kGravity{0.0, 0.0, -kG};

/// Returns the slip of a particle on the slope.
TurningSlip slip_on_slope(const Motion& motion, double radius, double friction) {
    return TurningSlip(motion, radius, SupportSurface{kNormal, friction}, kGravity, 1.0);
}

/// Follows the slip of a point in equal parts and returns its velocity at the end.
Vec3 velocity_after(Vec3 velocity, double friction, double duration, int parts) {
    for (int k = 0; k < parts; ++k)
        velocity = slip_on_slope({velocity, {}}, 0.0, friction).at(duration / parts).velocity;
    return velocity;
}

TEST(TurningSlip, StraightSlideHasTheClosedForm) {
    const double friction = 0.2;
    const double acceleration = kG * (std::sin(kAngle) - friction * std::cos(kAngle));
    const TurningSlip::State end = slip_on_slope({2.0 * kDownhill, {}}, 0.0, friction).at(0.7);
    EXPECT_LT(length(end.velocity - (2.0 + 0.7 * acceleration) * kDownhill), 1e-14);
    EXPECT_LT(length(end.displacement - (1.4 + 0.5 * 0.49 * acceleration) * kDownhill), 1e-14);
}

TEST(TurningSlip, SlideWithoutFrictionIsAParabola) {
    const TurningSlip::State end = slip_on_slope({3.0 * kSideways, {}}, 0.0, 0.0).at(0.7);
    EXPECT_LT(length(end.velocity - (3.0 * kSideways + (0.7 * kG * std::sin(kAngle)) * kDownhill)), 1e-14);
    EXPECT_EQ(end.friction, (Vec3{0.0, 0.0, 0.0}));
}

// On a slope at the angle of friction, speed plus downhill velocity are constant: a point that starts sideways keeps
// half its speed in the end.
TEST(TurningSlip, AtTheAngleOfFrictionThePointKeepsSpeedPlusDownhillVelocity) {
    const Vec3 velocity = velocity_after(3.0 * kSideways, std::tan(kAngle), 2.0, 400);
    EXPECT_NEAR(length(velocity) + dot(velocity, kDownhill), 3.0, 1e-9);
    const Vec3 last = velocity_after(3.0 * kSideways, std::tan(kAngle), 200.0, 20000);
    EXPECT_NEAR(length(last), 1.5, 1e-4);
}

// With an angle a between slip and downhill, speed * sin(a) / tan(a / 2)^(K / g) is constant, where K is friction's and
// g is the slope's acceleration.
TEST(TurningSlip, HodographKeepsItsFirstIntegral) {
    const double friction = 0.15;
    const double power = friction / std::tan(kAngle);
    const auto integral = [&](const Vec3& v) {
        const double angle = std::atan2(dot(v, kSideways), dot(v, kDownhill));
        return length(v) * std::sin(angle) / std::pow(std::tan(0.5 * angle), power);
    };
    const Vec3 start = 2.0 * kSideways - 1.0 * kDownhill;
    const Vec3 end = velocity_after(start, friction, 1.0, 200);
    EXPECT_NEAR(integral(end), integral(start), 1e-9);
    EXPECT_GT(dot(end, kDownhill), 1.0);
}

TEST(TurningSlip, ErrorsFallWithTheFourthPowerOfTheDuration) {
    const Vec3 start = 2.0 * kSideways;
    const Vec3 exact = velocity_after(start, 0.15, 0.4, 4096);
    const double coarse = length(velocity_after(start, 0.15, 0.4, 8) - exact);
    const double fine = length(velocity_after(start, 0.15, 0.4, 16) - exact);
    EXPECT_GT(coarse / fine, 13.0);
    EXPECT_LT(coarse / fine, 20.0);
}

TEST(TurningSlip, FrictionTurnsASphereAboutItsContact) {
    const double radius = 0.3;
    const Motion start{2.0 * kSideways, {1.0, -4.0, 2.0}};
    const TurningSlip slip = slip_on_slope(start, radius, 0.15);
    const double duration = 0.05;
    const TurningSlip::State end = slip.at(duration);
    const Vec3 spin = start.spin + duration * slip.spin_acceleration(end.friction);
    // Only gravity changes the angular momentum about the contact point.
    const auto momentum = [&](const Vec3& v, const Vec3& w) { return cross(kNormal, v) + (0.4 * radius) * w; };
    const Vec3 by_gravity = duration * cross(kNormal, kGravity);
    EXPECT_LT(length(momentum(end.velocity, spin) - momentum(start.velocity, start.spin) - by_gravity), 1e-14);
    EXPECT_NEAR(dot(spin, kNormal), dot(start.spin, kNormal), 1e-14);
    EXPECT_GT(dot(slip_velocity(start, radius, kNormal), -end.friction), 0.0);
}

TEST(TurningSlip, FrictionTakesTheEnergyOfItsPath) {
    constexpr int kParts = 64;
    const Vec3 start = 2.0 * kSideways;
    const TurningSlip slip = slip_on_slope({start, {}}, 0.0, 0.15);
    double length_of_path = 0.0;
    Vec3 before;
    TurningSlip::State end{};
    for (int k = 1; k <= kParts; ++k) {
        end = slip.at(0.01 * k / kParts);
        length_of_path += length(end.displacement - before);
        before = end.displacement;
    }
    const double gained = 0.5 * (length_squared(end.velocity) - length_squared(start));
    const double lost = dot(kGravity, end.displacement) - gained;
    EXPECT_NEAR(lost, 0.15 * kG * std::cos(kAngle) * length_of_path, 1e-7 * lost);
}

TEST(TurningSlip, PathOfAFlatIntervalEndsInItsState) {
    const std::array<SupportSurface, 1> slope{SupportSurface{kNormal, 0.15}};
    const ContactInterval plan = plan_interval({2.0 * kSideways, {}}, 0.0, kGravity, slope, {}, 0.02);
    const FlatInterval flat({plan, kGravity}, slip_on_slope({2.0 * kSideways, {}}, 0.0, 0.15));
    const Vec3 x{1.0, 2.0, 3.0};
    const Path path = flat.path(x, 0.01);
    const ContactInterval mean = flat.mean_until(0.01).interval;
    EXPECT_LT(length(path.velocity(0.01) - (plan.motion.velocity + 0.01 * mean.acceleration)), 1e-14);
    EXPECT_LT(length(path.velocity(0.0) - plan.motion.velocity), 1e-14);
    EXPECT_NEAR(dot(path.end - x, kNormal), 0.0, 1e-15);
}

TEST(TurningSlip, LastsUntilTheSlipHasChangedByATenth) {
    const TurningSlip slip = slip_on_slope({2.0 * kSideways, {}}, 0.0, 0.15);
    const double lasts = slip.longest(10.0);
    EXPECT_NEAR(length(slip.at(lasts).velocity - 2.0 * kSideways), 0.2, 0.01);
    EXPECT_EQ(slip.longest(0.5 * lasts), 0.5 * lasts);
}

TEST(TurningSlip, LeavesOtherMotionsToOtherPlans) {
    EXPECT_EQ(slip_on_slope({2.0 * kDownhill, {}}, 0.0, 0.15).longest(0.1), 0.0) << "it does not turn";
    EXPECT_EQ(slip_on_slope({2.0 * kSideways, {}}, 0.0, 0.0).longest(0.1), 0.0) << "it has no friction";
    EXPECT_EQ(slip_on_slope({{}, {}}, 0.0, 0.15).longest(0.1), 0.0) << "it does not slip";
    const Motion rolling{2.0 * kSideways, cross(kNormal, 2.0 * kSideways) / 0.3};
    EXPECT_EQ(slip_on_slope(rolling, 0.3, 0.15).longest(0.1), 0.0) << "it rolls";
}

// Friction that almost balances the slope changes the slip slowly, but turns it to its steady direction fast.
TEST(TurningSlip, FrictionNearBalanceEndsTheIntervalBeforeTheMethodIsUnstable) {
    const double friction = 0.999 * std::tan(kAngle);
    const Vec3 start = 1e-3 * kDownhill + 1e-5 * kSideways;
    const double lasts = slip_on_slope({start, {}}, 0.0, friction).longest(0.1);
    EXPECT_LT(lasts * friction * kG * std::cos(kAngle), 5.01e-3);
    Vec3 velocity = start;
    for (int k = 0; k < 20; ++k) {
        const TurningSlip slip = slip_on_slope({velocity, {}}, 0.0, friction);
        const double time = slip.longest(0.1);
        if (time == 0.0) break;
        velocity = slip.at(time).velocity;
        EXPECT_LE(std::fabs(dot(velocity, kNormal)), 1e-17);
        EXPECT_GE(dot(velocity, kSideways), 0.0);
    }
    EXPECT_LT(dot(velocity, kSideways), 1e-6);
}

// The rounding of a slow slip across the surface once pushed spheres into it.
TEST(TurningSlip, SlowSlipOfAFastSphereStaysOnTheSurface) {
    const Motion rolling{2.0 * kSideways, cross(kNormal, 2.0 * kSideways) / 0.3 + Vec3{3e-6, 1e-6, -2e-6}};
    const TurningSlip slip = slip_on_slope(rolling, 0.3, 0.15);
    const TurningSlip::State end = slip.at(1e-8);
    EXPECT_LE(std::fabs(dot(end.acceleration, kNormal)), 1e-14);
    EXPECT_LE(std::fabs(dot(end.friction, kNormal)), 1e-15);
}

TEST(TurningSlip, SurfacePressesAndBrakes) {
    const TurningSlip slip = slip_on_slope({2.0 * kSideways, {}}, 0.0, 0.15);
    const double pressing = kG * std::cos(kAngle);
    EXPECT_LT(length(slip.reaction() - pressing * (kNormal - 0.15 * kSideways)), 1e-14);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
