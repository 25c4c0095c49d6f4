// Checks that the verifier reports energy gained from surfaces, and nothing else.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ricochet/verify/verifier.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

using Kind = MotionPart::Kind;

RecordedMotion motion(const Vec3& position, const Vec3& velocity, const Vec3& spin = {}) {
    return {position, velocity, spin};
}

/// Returns the violations in parts of the motion of a particle of this radius in a large box.
std::vector<Violation> found_in(const std::vector<MotionPart>& parts, const RecordedMotion& before,
                                const RecordedMotion& after) {
    const Verifier verifier({testing::box_mesh({-100, -100, -100}, {100, 100, 100})});
    VerifiedParticle particle = verifier.watch(before.position, 0.0);
    const Segment translation{before.position, after.position, 1.0};
    std::vector<Violation> violations;
    verifier.check({5, before.position, after.position, 0.0, 2.0, {&translation, 1}, {before, after, parts}}, particle,
                   violations);
    return violations;
}

std::vector<Violation> found_in(const std::vector<MotionPart>& parts) {
    return found_in(parts, parts.front().begin, parts.back().end);
}

bool gains(const MotionPart& part) {
    const std::vector<Violation> violations = found_in({part});
    EXPECT_LE(violations.size(), 1U);
    return !violations.empty() && violations[0].kind == ViolationKind::energy;
}

MotionPart impact(const Vec3& before, const Vec3& after) {
    return {Kind::impact, 1.0, 0.0, 0.0, motion({1, 2, 3}, before), motion({1, 2, 3}, after), {}, true};
}

TEST(EnergyOfImpacts, EnergyMayFallOrStayAndGrowByRoundingOnly) {
    EXPECT_FALSE(gains(impact({3, 0, -4}, {3, 0, 4})));
    EXPECT_FALSE(gains(impact({3, 0, -4}, {3, 0, 2})));
    EXPECT_FALSE(gains(impact({3, 0, -4}, {})));
    EXPECT_FALSE(gains(impact({3, 0, -4}, {3, 0, std::nextafter(4.0, 5.0)})));
    EXPECT_TRUE(gains(impact({3, 0, -4}, {3, 0, 4.0 * (1.0 + 1e-14)})));
    EXPECT_TRUE(gains(impact({}, {0, 0, 1e-9})));
}

TEST(EnergyOfImpacts, RotationOfASolidSphereCounts) {
    MotionPart part = impact({1, 0, 0}, {5.0 / 7.0, 0, 0});
    part.radius = 0.1;
    part.end.spin = {0, 50.0 / 7.0, 0};  // rolls: 5/7 of the energy is left
    EXPECT_FALSE(gains(part));
    part.end.spin *= 1.5;
    EXPECT_FALSE(gains(part));
    part.end.spin *= 1.1;  // 0.2 r^2 w^2 = (1.65^2) 0.2 (25/49) + 25/98 > 1/2
    EXPECT_TRUE(gains(part));
}

TEST(EnergyOfImpacts, EnergyMayGrowAtAWallWithItsOwnTemperature) {
    MotionPart part = impact({0, 0, -1}, {0, 0, 100});
    part.kind = Kind::driven;
    EXPECT_FALSE(gains(part));
}

/// Returns a frictionless slide down a slope for one second.
MotionPart slide() {
    const double a = kG * std::sin(0.3);
    const Vec3 down{std::cos(0.3), 0, -std::sin(0.3)};
    return {Kind::contact,
            1.0,
            1.0,
            0.0,
            motion({1, 2, 3}, 2.0 * down),
            motion(Vec3{1, 2, 3} + (2.0 + 0.5 * a) * down, (2.0 + a) * down),
            {Vec3{0, 0, -kG}, Vec3{0, 0, -kG}, Vec3{0, 0, -kG}},
            true};
}

TEST(EnergyOfContact, EnergyGrowsByTheWorkOfTheForcesOnly) {
    EXPECT_FALSE(gains(slide()));
    MotionPart pushed = slide();
    pushed.end.velocity *= 1.0 + 1e-11;
    EXPECT_TRUE(gains(pushed));
    MotionPart lifted = slide();
    lifted.end.position.z += 1e-11;
    EXPECT_TRUE(gains(lifted));
    lifted = slide();
    lifted.end.position.z += 1e-13;  // the contact offset is 7e-15 m here
    EXPECT_FALSE(gains(lifted));
}

TEST(EnergyOfContact, EnergyMayGrowWithGrowingForces) {
    MotionPart part = slide();
    part.forces_are_steady = false;
    part.forces[1] *= 1.005;
    part.forces[2] *= 1.01;
    part.end.velocity *= 1.0 + 1e-4;
    EXPECT_FALSE(gains(part));
    part.end.velocity *= 1.2;
    EXPECT_TRUE(gains(part));
}

// A spring oscillates within the part: its force half way is larger than at both ends.
TEST(EnergyOfContact, EnergyMayGrowWithForcesThatPeakHalfWay) {
    MotionPart part = slide();
    part.forces_are_steady = false;
    part.end.velocity *= 1.2;
    EXPECT_TRUE(gains(part));
    part.forces[1] *= 1.5;
    EXPECT_FALSE(gains(part));
    part.end.velocity *= 10.0;
    EXPECT_TRUE(gains(part));
}

TEST(RecordedParts, PartsMustConnectToEachOtherAndTheStep) {
    MotionPart flight = slide();
    flight.kind = Kind::flight;
    flight.end.velocity *= 5.0;  // not checked: the integrator is responsible for flight
    MotionPart then = impact(flight.end.velocity, {});
    then.begin.position = then.end.position = flight.end.position;
    EXPECT_TRUE(found_in({flight, then}).empty());
    EXPECT_EQ(found_in({flight, then}, flight.begin, motion(then.end.position, {0, 0, 1e-3})).size(), 1U);
    EXPECT_EQ(found_in({flight, then}, motion(flight.begin.position, {}), then.end).size(), 1U);
    then.begin.velocity *= 0.5;
    const auto violations = found_in({flight, then});
    ASSERT_EQ(violations.size(), 1U);
    EXPECT_EQ(violations[0].kind, ViolationKind::energy);
    EXPECT_EQ(violations[0].particle, 5U);
    EXPECT_EQ(violations[0].time, 1.0);
    EXPECT_EQ(violations[0].position, then.begin.position);
    EXPECT_FALSE(violations[0].collider);
}

TEST(RecordedParts, PartsThatAreNotFiniteAreReported) {
    MotionPart part = impact({1, 0, 0}, {NAN, 0, 0});
    EXPECT_FALSE(found_in({part}).empty());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
