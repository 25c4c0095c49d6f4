// A solid sphere with Coulomb friction sticks or slips in an impact as the closed form predicts, and rolls afterwards.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "collision/worlds.h"
#include "response/course.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;

constexpr double kPi = 3.14159265358979323846;
constexpr double kG = 9.81;
constexpr double kRadius = 0.1;

struct Pair {
    double restitution, friction, limit_degrees;
};

class ObliqueImpact : public ::testing::TestWithParam<Pair> {};
INSTANTIATE_TEST_SUITE_P(Materials, ObliqueImpact, ::testing::Values(Pair{0.5, 0.2, 46.40}, Pair{0.8, 0.1, 32.21}),
                         [](const auto& pair) {
                             return "Friction" +
                                    std::to_string(static_cast<int>(std::lround(10.0 * pair.param.friction)));
                         });

/// Returns the state of a sphere after its impact on a meshed floor. The sphere arrives without spin at unit speed, at
/// an angle of `degrees` from the normal.
MovingParticle after_impact(const Pair& pair, double degrees) {
    Course course({testing::mesh_collider(testing::floor_mesh(4.0, 8))}, {"", pair.restitution, pair.friction}, {});
    const double angle = degrees * kPi / 180.0;
    const Vec3 v{std::sin(angle), 0, -std::cos(angle)};
    MovingParticle sphere{{Vec3{0.31, 0.17, kRadius} - 0.5 * v, v, 1.0, kRadius, 0.0}, {}, 0, 0};
    EXPECT_EQ(course.move(sphere, 1.0).bounces, 1U);
    EXPECT_NEAR(sphere.state.velocity.z, pair.restitution * std::cos(angle), 1e-14);
    return sphere;
}

// A solid sphere sticks in the impact if tan(theta) < 7/2 mu (1 + e). It then rolls at 5/7 of the tangential speed.
TEST_P(ObliqueImpact, SticksBelowTheLimitAngle) {
    const Pair& pair = GetParam();
    const double limit = std::atan(3.5 * pair.friction * (1.0 + pair.restitution)) * 180.0 / kPi;
    EXPECT_NEAR(limit, pair.limit_degrees, 0.005);
    for (const double degrees : {5.0, 20.0, limit - 1e-9}) {
        const MovingParticle after = after_impact(pair, degrees);
        const double tangential = std::sin(degrees * kPi / 180.0);
        EXPECT_NEAR(after.state.velocity.x, 5.0 / 7.0 * tangential, 1e-14);
        EXPECT_NEAR(after.spin.y, 5.0 / 7.0 * tangential / kRadius, 1e-12);  // rolling towards +x is a rotation about
                                                                             // +y
        EXPECT_EQ(after.spin.x, 0.0);
        EXPECT_EQ(after.spin.z, 0.0);
    }
}

TEST_P(ObliqueImpact, SlipsAboveTheLimitAngle) {
    const Pair& pair = GetParam();
    for (const double degrees : {pair.limit_degrees + 0.01, 60.0, 85.0}) {
        const MovingParticle after = after_impact(pair, degrees);
        const double angle = degrees * kPi / 180.0;
        const double lost = pair.friction * (1.0 + pair.restitution) * std::cos(angle);
        EXPECT_NEAR(after.state.velocity.x, std::sin(angle) - lost, 1e-14);
        EXPECT_NEAR(after.spin.y, 2.5 * lost / kRadius, 1e-12);
        EXPECT_GT(after.state.velocity.x, kRadius * after.spin.y);  // the contact point still slips
    }
}

// A sphere thrown onto a floor without spin slips for 2 v / (7 mu g), then rolls at 5/7 v.
TEST(ThrownSphere, RollsAtFiveSeventhsOfItsSpeedAfterTheTimeOfSlip) {
    const double friction = 0.2;
    Course course({testing::mesh_collider(testing::floor_mesh(8.0, 16))}, {"", 0.5, friction}, {0, 0, -kG});
    MovingParticle sphere{{{-7, 0.1, kRadius + 1e-14}, {2, 0, 0}, 1.0, kRadius, 0.0}, {}, 0, 0};
    const double slip_time = 2.0 * 2.0 / (7.0 * friction * kG);
    (void)course.move(sphere, 0.5 * slip_time);
    EXPECT_NEAR(sphere.state.velocity.x, 2.0 - friction * kG * 0.5 * slip_time, 1e-9);
    EXPECT_GT(sphere.state.velocity.x, kRadius * sphere.spin.y);
    for (int k = 0; k < 100; ++k) (void)course.move(sphere, 0.01 * slip_time);
    EXPECT_NEAR(sphere.state.velocity.x, 10.0 / 7.0, 1e-9);
    EXPECT_NEAR(kRadius * sphere.spin.y, 10.0 / 7.0, 1e-9);
}

// A solid sphere rolls down a slope with 5/7 g sin(theta) if tan(theta) < 7/2 mu.
TEST(RollingSphere, RunsDownASlopeWithFiveSeventhsOfGravity) {
    const double angle = 0.5;
    const Vec3 normal{std::sin(angle), 0, std::cos(angle)};
    const Vec3 downhill{std::cos(angle), 0, -std::sin(angle)};
    Course course({testing::plane_collider({0, 0, 0}, normal)}, {"", 0.0, 0.5}, {0, 0, -kG});
    MovingParticle sphere{{(kRadius + 1e-14) * normal, {}, 1.0, kRadius, 0.0}, {}, 0, 0};
    for (int k = 0; k < 50; ++k) (void)course.move(sphere, 0.02);
    EXPECT_NEAR(dot(sphere.state.velocity, downhill), 5.0 / 7.0 * kG * std::sin(angle), 1e-9);
    EXPECT_NEAR(dot(sphere.state.position, downhill), 0.5 * 5.0 / 7.0 * kG * std::sin(angle), 1e-9);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
