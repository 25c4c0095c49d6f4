// Persistent sliding, rolling and resting contact: over seams, in bowls, in grooves, and with friction that changes its
// direction.
#include <gtest/gtest.h>
#include <algorithm>
#include <utility>

#include <cmath>
#include <cstdint>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::floor_mesh;
using testing::mesh_collider;
using testing::plane_collider;

constexpr double kG = 9.81;
constexpr double kPi = 3.14159265358979323846;

MovingParticle particle_at(const Vec3& position, const Vec3& velocity, double radius = 0.0) {
    return {{position, velocity, 1.0, radius, 0.0}, {}, 0, 0};
}

TEST(SlidingOverSeams, CostsAFewContactsPerSeamAndNoSpeed) {
    Course course({mesh_collider(floor_mesh(50.0, 197))}, {"", 0.5, 0.0}, {0, 0, -kG});
    MovingParticle point = particle_at({-45, 0.1, 1e-14}, {30, 3.7, 0});
    std::uint64_t bounces = 0;
    for (int k = 0; k < 250; ++k) {
        const MoveOutcome outcome = course.move(point, 0.01);
        bounces += outcome.bounces;
        ASSERT_EQ(outcome.unsimulated_time, 0.0);
    }
    EXPECT_NEAR(point.state.velocity.x, 30.0, 1e-12);
    EXPECT_NEAR(point.state.position.x, 30.0, 1e-10);
    EXPECT_LT(bounces, 1500U);  // it crosses about 330 seams
}

/// Returns half a period of a swing that starts at rest beside the lowest point of a bowl. The half period ends when
/// the velocity changes its sign.
double half_period(Course& course, MovingParticle particle) {
    constexpr double kStep = 1.0 / 1024;
    for (int k = 1; k < 4096; ++k) {
        EXPECT_EQ(course.move(particle, kStep).unsimulated_time, 0.0);
        if (particle.state.velocity.x > 0.0) return k * kStep;
    }
    return 0.0;
}

// A sliding point swings with the period 2 pi sqrt(R / g). A rolling solid sphere swings with the period 2 pi sqrt(7/5
// (R - r) / g).
TEST(ABallFromInside, IsABowlInWhichPointsAndMarblesSwingLikePendulums) {
    const double angle = 0.05;
    const auto beside = [&](double r) { return (1.0 - r) * Vec3{std::sin(angle), 0, -std::cos(angle)}; };
    Course slippery({{"ball", BallShape{1.0, {}}, 0}}, {"", 0.0, 0.0}, {0, 0, -kG});
    EXPECT_NEAR(half_period(slippery, particle_at(0.9999999 * beside(0.0), {})), kPi * std::sqrt(1.0 / kG), 0.01);
    Course rough({{"ball", BallShape{1.0, {}}, 0}}, {"", 0.0, 0.5}, {0, 0, -kG});
    EXPECT_NEAR(half_period(rough, particle_at(0.9999999 * beside(0.1), {}, 0.1)), kPi * std::sqrt(1.4 * 0.9 / kG),
                0.01);
}

TEST(ABallFromInside, KeepsTheSpeedOfForceFreeSlidingAroundIt) {
    Course course({{"ball", BallShape{1.0, {}}, 0}}, {"", 0.0, 0.0}, {});
    MovingParticle point = particle_at({0, 0, -0.5}, {1, 0.2, -0.4});
    (void)course.move(point, 1.5);
    const double speed = length(point.state.velocity);
    for (int k = 0; k < 100; ++k) {
        ASSERT_EQ(course.move(point, 0.1).unsimulated_time, 0.0);
        ASSERT_NEAR(length(point.state.position), 1.0, 1e-12);
    }
    EXPECT_NEAR(length(point.state.velocity), speed, 1e-3);
}

// A point slides without friction for a hundred swings, in steps of 0.02 s. The bounds limit the energy error relative
// to the energy of the swing.
TEST(ABallFromInside, ConservesTheEnergyOfAHundredSwings) {
    for (const auto& [angle, bound] : {std::pair{1.0, 1e-10}, std::pair{0.1, 5e-10}}) {
        Course course({{"ball", BallShape{1.0, {}}, 0}}, {"", 0.0, 0.0}, {0, 0, -kG});
        MovingParticle point = particle_at((1.0 - 1e-13) * Vec3{std::sin(angle), 0, -std::cos(angle)}, {});
        double worst = 0.0;
        for (int k = 0; k < 11'000; ++k) {
            (void)course.move(point, 0.02);
            const double energy = 0.5 * length_squared(point.state.velocity) + kG * point.state.position.z;
            worst = std::max(worst, std::fabs(energy + kG * std::cos(angle)));
        }
        EXPECT_LT(worst, bound * kG * (1.0 - std::cos(angle))) << angle;
    }
}

// The walls have the inclination A, and the groove descends at 20 degrees. A sphere rolls down with the acceleration g
// sin(20 degrees) / (1 + 0.4 / cos^2 A).
TEST(AGroove, LetsASphereRollDownAsInClosedForm) {
    const double slope = 20.0 * kPi / 180.0;
    const auto tilted = [&](const Vec3& n) {
        return Vec3{n.x * std::cos(slope) + n.z * std::sin(slope), n.y, n.z * std::cos(slope) - n.x * std::sin(slope)};
    };
    for (const double degrees : {5.0, 45.0, 85.0}) {
        for (const double step : {0.001, 0.02, 0.1}) {
            const double a = degrees * kPi / 180.0;
            const std::vector<ColliderDescription> groove{plane_collider({}, tilted({0, std::sin(a), std::cos(a)})),
                                                          plane_collider({}, tilted({0, -std::sin(a), std::cos(a)}))};
            Course course(groove, {"", 0.5, 0.3}, {0, 0, -kG});
            const Vec3 start = 0.1 / std::cos(a) * tilted({0, 0, 1});
            MovingParticle sphere = particle_at(start, {}, 0.1);
            const int steps = static_cast<int>(std::lround(1.0 / step));
            for (int k = 0; k < steps; ++k) ASSERT_EQ(course.move(sphere, step).unsimulated_time, 0.0);
            const double rolled = dot(sphere.state.position - start, tilted({1, 0, 0}));
            const double expected = 0.5 * kG * std::sin(slope) / (1.0 + 0.4 / (std::cos(a) * std::cos(a)));
            EXPECT_NEAR(rolled / expected, 1.0, 1e-9) << degrees << " degrees, steps of " << step << " s";
        }
    }
}

TEST(AMarbleOnALargeBall, LosesNoTimeOnAnyPath) {
    Course course({{"ball", BallShape{10.0, {}}, 0}}, {"", 0.3, 0.4}, {0, 0, -kG});
    MovingParticle marble = particle_at(10.0010001 * normalized(Vec3{0.05, 0.02, 1.0}), {0.1, 0, 0}, 1e-3);
    for (int k = 0; k < 60; ++k) ASSERT_EQ(course.move(marble, 1.0 / 60.0).unsimulated_time, 0.0) << k;
}

// Both sides of the groove press on the particle. The friction is 2 * 10 / (2 cos 45) * 0.2.
TEST(AGroove, BrakesByTheSumOfItsNormalForces) {
    const std::vector<ColliderDescription> groove{plane_collider({0, 0, 0}, {1, 0, 1}),
                                                  plane_collider({0, 0, 0}, {-1, 0, 1})};
    Course course(groove, {"", 0.0, 0.2}, {0, 5, -10});
    MovingParticle point = particle_at({0, 0, 1e-14}, {0, 1, 0});
    for (int k = 0; k < 100; ++k) (void)course.move(point, 0.01);
    EXPECT_NEAR(point.state.velocity.y, 1.0 + 5.0 - 0.2 * 10.0 * std::sqrt(2.0), 1e-6);
}

TEST(ACorner, IsSupportedByEachSurfaceInItsOwnDirection) {
    const std::vector<ColliderDescription> corner{plane_collider({0, 0, 0}, {0, 0, 1}),
                                                  plane_collider({1, 0, 0}, {-1, 0, 0})};
    Course course(corner, {"", 0.0, 0.0}, {3, 0, -10});
    MovingParticle point = particle_at({1.0 - 1e-14, 0, 1e-14}, {});
    std::vector<Vec3> given(2);
    for (int k = 0; k < 500; ++k) {
        (void)course.move(point, 0.01);
        for (const SurfaceHit& hit : course.scratch.hits) given[hit.surface] += hit.impulse;
    }
    EXPECT_LT(length(given[0] - Vec3{0, 0, -50}), 1e-6);
    EXPECT_LT(length(given[1] - Vec3{15, 0, 0}), 1e-6);
}

// The direction of friction turns with the direction of motion. The result must not depend on the time step.
TEST(TurningFriction, StopsASlideAtTheSamePositionForAnyTimeStep) {
    const auto end = [](double time_step) {
        Course course({plane_collider({0, 0, 0}, {0, 0, 1})}, {"", 0.0, 0.3}, {2, 0, -10});
        MovingParticle point = particle_at({0, 0, 1e-15}, {0.3, 1, 0});
        bool resting = false;
        for (int k = 0; k * time_step < 1.999; ++k) resting = course.move(point, time_step).is_resting();
        EXPECT_TRUE(resting) << time_step;
        EXPECT_EQ(point.state.velocity, Vec3{});
        return point.state.position;
    };
    const Vec3 fine = end(1e-3);
    for (const double time_step : {0.01, 0.1, 0.5, 1.0}) EXPECT_LT(length(end(time_step) - fine), 0.02) << time_step;
}

TEST(RollingResistance, BrakesNoHarderThanFrictionAllows) {
    Material material{"", 0.0, 0.01};
    material.rolling_friction = 0.5;
    Course course({plane_collider({0, 0, 0}, {0, 0, 1})}, material, {0, 0, -10});
    MovingParticle sphere = particle_at({0, 0, 0.1 + 1e-15}, {1, 0, 0}, 0.1);
    sphere.spin = {0, 10, 0};
    for (int k = 0; k < 100; ++k) (void)course.move(sphere, 0.01);
    EXPECT_NEAR(sphere.state.velocity.x, 1.0 - 0.1, 1e-6);
}

// Slow bounces must end at rest for any mechanism of energy loss, and must not exhaust the bounce budget.
TEST(SlowBounces, EndInRestEvenIfOnlyTheThresholdOrPartialAbsorptionTakesEnergy) {
    Material fading{"fading", 1.0, 0.0};
    fading.restitution_threshold = 1.0;
    Material absorbing{"absorbing", 0.5, 0.0};
    absorbing.absorption = 1e-9;
    Material diffuse{"diffuse", 0.5, 0.0};
    diffuse.diffuse = 0.01;
    for (const Material& material : {fading, absorbing, diffuse}) {
        SCOPED_TRACE(material.name);
        Course course({plane_collider({0, 0, 0}, {0, 0, 1})}, material, {0, 0, -kG});
        MovingParticle point = particle_at({0, 0, 0.02}, {});
        bool resting = false;
        for (int k = 0; k < 400; ++k) {
            const MoveOutcome outcome = course.move(point, 0.01);
            ASSERT_EQ(outcome.unsimulated_time, 0.0) << k;
            resting = outcome.is_resting();
        }
        EXPECT_TRUE(resting);
    }
}

TEST(ASphereBornWithItsCentreOnASurface, LeavesAlongTheNormal) {
    for (const ColliderDescription& floor : {plane_collider({0, 0, 0}, {0, 0, 1}), mesh_collider(floor_mesh(2.0, 2))}) {
        Course course({floor}, {"", 0.5, 0.2}, {});
        MovingParticle sphere = particle_at({0.3, 0.1, 0}, {0.1, 0, 1}, 0.1);
        for (int k = 0; k < 10; ++k) EXPECT_EQ(course.move(sphere, 0.1).unsimulated_time, 0.0);
        EXPECT_NEAR(sphere.state.position.z, 1.0, 1e-12);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
