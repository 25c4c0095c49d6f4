#include "ricochet/response/penalty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"
#include "response/fitted_slope.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::fitted_slope;
using testing::floor_mesh;
using testing::mesh_collider;
using testing::plane_collider;

constexpr double kG = 9.81;
constexpr double kPi = 3.14159265358979323846;
const Vec3 kGravity{0, 0, -kG};

ColliderDescription ground() { return plane_collider({0, 0, 0}, {0, 0, 1}); }

/// Each move is one substep of a spring of 10 kN/m under 1 kg: omega = 100 / s.
constexpr double kStiffness = 1e4;
constexpr double kOmega = 100.0;

ResponseSettings settings_with(IntegratorKind integrator, double substep) {
    ResponseSettings settings;
    settings.integrator = integrator;
    settings.time_step = substep;
    settings.penalty.substeps = 1;
    settings.penalty.stiffness = kStiffness;
    settings.penalty.friction_speed = 0.05;
    return settings;
}

Course course_of(const Material& material, const Vec3& gravity, const ResponseSettings& settings) {
    return {{ground()}, material, gravity, ResponseKind::penalty, settings};
}

MovingParticle particle_at(const Vec3& position, const Vec3& velocity = {}, double radius = 0.0, double mass = 1.0) {
    return {{position, velocity, mass, radius, 0.0}, {}, 0, 0};
}

/// Returns a particle inside the floor that came from its upper side.
MovingParticle sunk(Course& course, const Vec3& position, const Vec3& velocity = {}, double radius = 0.0) {
    MovingParticle particle = particle_at(position, velocity, radius);
    course.enrol(particle);
    particle.sides[0] = {1, radius == 0.0, true, 1e3F};
    return particle;
}

class Penalty : public ::testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, Penalty,
                         ::testing::Values(IntegratorKind::ballistic, IntegratorKind::symplectic_euler,
                                           IntegratorKind::midpoint, IntegratorKind::rk4),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

TEST_P(Penalty, WeightRestsAtTheEquilibriumDepthOfItsSpring) {
    for (const double mass : {0.1, 1.0, 20.0}) {
        for (const double stiffness : {200.0, 1e5}) {
            for (const double radius : {0.0, 0.3}) {
                for (const bool is_mesh : {false, true}) {
                    SCOPED_TRACE(::testing::Message() << mass << " kg, " << stiffness << " N/m, radius " << radius);
                    const double sag = mass * kG / stiffness;
                    ResponseSettings settings = settings_with(GetParam(), 1.0 / std::sqrt(stiffness / mass));
                    settings.penalty.substeps = 10;
                    settings.penalty.stiffness = stiffness;
                    Course course({is_mesh ? mesh_collider(floor_mesh(3.0, 2)) : ground()}, {"", 0.2, 0.0}, kGravity,
                                  ResponseKind::penalty, settings);
                    MovingParticle block = particle_at({0.1, 0.2, radius + 0.5 * sag}, {}, radius, mass);
                    for (int k = 0; k < 60; ++k) (void)course.move(block, settings.time_step);
                    EXPECT_NEAR((radius - block.state.position.z) / sag, 1.0, 1e-6);
                    EXPECT_NEAR(block.state.velocity.z, 0.0, 1e-6 * std::sqrt(kG * sag));
                }
            }
        }
    }
}

/// Returns the ratio of the speeds after and before a contact, without gravity. The contact begins at the given
/// fraction of a substep.
double measured_restitution(IntegratorKind integrator, double restitution, double substep, double phase) {
    Course course = course_of({"", restitution, 0.0}, {}, settings_with(integrator, substep));
    MovingParticle ball = particle_at({0, 0, (1.0 + phase) * substep}, {0, 0, -1});
    for (int k = 0; k < 100000; ++k) {
        (void)course.move(ball, substep);
        if (ball.state.velocity.z > 0.0 && ball.state.position.z > 0.0) break;
    }
    return ball.state.velocity.z;
}

struct Convergence {
    std::vector<double> steps;
    std::vector<double> errors;  ///< largest over start phases

    Convergence(IntegratorKind integrator, double restitution, int halvings) {
        for (int k = 0; k <= halvings; ++k) {
            const double substep = 0.2 / kOmega / std::pow(2.0, k);
            double largest = 0.0;
            for (int p = 0; p < 16; ++p) {
                const double after = measured_restitution(integrator, restitution, substep, (p + 0.5) / 16.0);
                largest = std::max(largest, std::fabs(after - restitution));
            }
            steps.push_back(substep);
            errors.push_back(largest);
        }
    }
};

// The damper's force jumps at the start of contact. The substep with the jump takes a wrong fraction of it, off by up
// to all of it. The velocity error is at most 2 zeta omega h, which is first order.
TEST_P(Penalty, RestitutionConvergesToTheMaterialsInTheFirstOrder) {
    for (const double restitution : {0.3, 0.6, 0.9}) {
        SCOPED_TRACE(restitution);
        const Convergence measured(GetParam(), restitution, 6);
        EXPECT_NEAR(fitted_slope(measured.steps, measured.errors), 1.0, 0.15);
        for (std::size_t k = 2; k < measured.steps.size(); ++k) {
            EXPECT_LT(measured.errors[k], 2.0 * damping_ratio(restitution) * kOmega * measured.steps[k]);
        }
    }
}

// Without a damper the force has only a kink. The integrators' energies oscillate or drift by less than the kink's
// second order.
TEST_P(Penalty, EnergyOfAnUndampedBounceConvergesInTheSecondOrder) {
    const Convergence measured(GetParam(), 1.0, 6);
    EXPECT_NEAR(fitted_slope(measured.steps, measured.errors), 2.0, 0.2);
    const double first = kOmega * measured.steps.front();
    EXPECT_LT(measured.errors.front(), first * first);
}

TEST_P(Penalty, UndampedContactLastsHalfAPeriod) {
    const double substep = 0.05 / kOmega;
    Course course = course_of({}, {}, settings_with(GetParam(), substep));
    course.scratch.record_segments = true;
    MovingParticle ball = particle_at({0, 0, 0.4 * substep}, {0, 0, -1});
    double begin = 0.0;
    double end = 0.0;
    while (end == 0.0) {
        (void)course.move(ball, substep);
        for (const Segment& segment : course.scratch.segments) {
            const double at = segment.time + substep * segment.from.z / (segment.from.z - segment.to.z);
            if (segment.from.z > 0.0 && segment.to.z <= 0.0) begin = at;
            if (segment.from.z <= 0.0 && segment.to.z > 0.0) end = at;
        }
    }
    EXPECT_NEAR((end - begin) * kOmega, kPi, 0.05 * 0.05);
}

TEST_P(Penalty, ContactWithoutAStiffnessLastsTheGivenNumberOfSubsteps) {
    for (const double time_step : {0.1, 0.001}) {
        for (const double contact_steps : {10.0, 20.0, 50.0}) {
            ResponseSettings settings = settings_with(GetParam(), time_step);
            settings.penalty.substeps = 5;
            settings.penalty.stiffness.reset();
            settings.penalty.contact_steps = contact_steps;
            Course course = course_of({}, {}, settings);
            course.scratch.record_segments = true;
            MovingParticle ball = particle_at({0, 0, 0.3 * time_step}, {0, 0, -1}, 0.0, 3.0);
            int inside = 0;
            for (int k = 0; k < 20; ++k) {
                (void)course.move(ball, time_step);
                for (const Segment& segment : course.scratch.segments) inside += segment.to.z < 0.0 ? 1 : 0;
            }
            EXPECT_GT(ball.state.velocity.z, 0.9);
            EXPECT_NEAR(inside, contact_steps, 1.0);
        }
    }
}

// Without a stiffness everything scales with the substep. A smaller substep does not help, but more substeps per
// contact do.
TEST_P(Penalty, RestitutionErrorDependsOnlyOnTheSubstepsPerContact) {
    const auto largest_error = [&](double time_step, double contact_steps) {
        double largest = 0.0;
        for (int p = 0; p < 16; ++p) {
            ResponseSettings settings = settings_with(GetParam(), time_step);
            settings.penalty.stiffness.reset();
            settings.penalty.contact_steps = contact_steps;
            Course course = course_of({"", 0.6, 0.0}, {}, settings);
            MovingParticle ball = particle_at({0, 0, (1.0 + (p + 0.5) / 16.0) * time_step}, {0, 0, -1});
            for (int k = 0; k < 10.0 + 2.0 * contact_steps; ++k) (void)course.move(ball, time_step);
            largest = std::max(largest, std::fabs(ball.state.velocity.z - 0.6));
        }
        return largest;
    };
    std::vector<double> contact_steps;
    std::vector<double> errors;
    for (const double n : {10.0, 20.0, 40.0, 80.0, 160.0, 320.0, 640.0}) {
        contact_steps.push_back(n);
        errors.push_back(largest_error(1e-3, n));
        EXPECT_NEAR(largest_error(1e-6, n) / errors.back(), 1.0, 1e-6) << n;
    }
    EXPECT_NEAR(fitted_slope(contact_steps, errors), -1.0, 0.15);
}

TEST_P(Penalty, UndampedImpactSinksBySpeedOverFrequency) {
    const double substep = 0.02 / kOmega;
    for (const double speed : {0.01, 1.0, 30.0}) {
        for (const double radius : {0.0, 0.1}) {
            Course course = course_of({}, {}, settings_with(GetParam(), substep));
            MovingParticle ball = particle_at({0, 0, radius + 0.3 * substep * speed}, {0, 0, -speed}, radius);
            double deepest = 0.0;
            for (int k = 0; k < 200; ++k) deepest = std::max(deepest, course.move(ball, substep).depth);
            EXPECT_NEAR(deepest * kOmega / speed, 1.0, 0.02);
        }
    }
}

TEST_P(Penalty, SlidingBlockIsBrakedByCoulombsForce) {
    Course course = course_of({"", 0.5, 0.3}, kGravity, settings_with(GetParam(), 1e-3));
    MovingParticle block = sunk(course, {0, 0, -kG / kStiffness}, {2, 0, 0});
    for (int k = 0; k < 500; ++k) (void)course.move(block, 1e-3);
    EXPECT_NEAR(block.state.velocity.x, 2.0 - 0.3 * kG * 0.5, 1e-9);
    EXPECT_NEAR(block.state.position.z, -kG / kStiffness, 1e-12);
}

constexpr double kAngle = 0.5;
const Vec3 kNormal{std::sin(kAngle), 0, std::cos(kAngle)};
const Vec3 kDownhill{std::cos(kAngle), 0, -std::sin(kAngle)};

/// Returns the speed downhill after a second on a slope. The particle starts at rest at the equilibrium depth.
double speed_on_a_slope(IntegratorKind integrator, double friction) {
    Course course({plane_collider({0, 0, 0}, kNormal)}, {"", 0.5, friction}, kGravity, ResponseKind::penalty,
                  settings_with(integrator, 1e-3));
    MovingParticle block = sunk(course, (-kG * std::cos(kAngle) / kStiffness) * kNormal);
    for (int k = 0; k < 1000; ++k) (void)course.move(block, 1e-3);
    EXPECT_NEAR(dot(block.state.velocity, kNormal), 0.0, 1e-9);
    return dot(block.state.velocity, kDownhill);
}

// Regularised friction needs slip: mu N (v / friction_speed) = m g sin(theta).
TEST_P(Penalty, CreepBelowTheAngleOfFrictionHasTheRegularisedSpeed) {
    for (const double part : {1.05, 1.5, 4.0}) {
        const double friction = part * std::tan(kAngle);
        EXPECT_NEAR(speed_on_a_slope(GetParam(), friction), 0.05 * std::tan(kAngle) / friction, 1e-5) << part;
    }
}

// If the friction of a substep exceeds the amount that stops the slip, the slip oscillates by at most one substep's
// change.
TEST_P(Penalty, CreepWithStiffFrictionIsBoundedByTheChangeOfASubstep) {
    constexpr double kSubstep = 1.0 / 600.0;
    for (const double part : {1.1, 2.0}) {
        const double friction = part * std::tan(kAngle);
        ResponseSettings settings = settings_with(GetParam(), kSubstep);
        settings.penalty.friction_speed = 1e-3;
        const double kick = friction * kG * std::cos(kAngle) * kSubstep;
        const double fastest = settings.penalty.friction_speed + kick + kG * std::sin(kAngle) * kSubstep;
        EXPECT_GT(kick, 2.0 * settings.penalty.friction_speed);
        Course course({plane_collider({0, 0, 0}, kNormal)}, {"", 0.5, friction}, kGravity, ResponseKind::penalty,
                      settings);
        MovingParticle block = sunk(course, (-kG * std::cos(kAngle) / kStiffness) * kNormal);
        for (int k = 0; k < 3000; ++k) {
            (void)course.move(block, kSubstep);
            ASSERT_LT(length(block.state.velocity), fastest) << k;
        }
        const double creep = dot(block.state.position, kDownhill) / (3000 * kSubstep);
        EXPECT_GT(creep, 1.2 * settings.penalty.friction_speed / part);  // more than the regularisation predicts
        EXPECT_LT(creep, fastest);
    }
}

TEST_P(Penalty, SlideAboveTheAngleOfFrictionMatchesCoulombsLaw) {
    for (const double part : {0.0, 0.5, 0.9}) {
        const double friction = part * std::tan(kAngle);
        const double expected = kG * (std::sin(kAngle) - friction * std::cos(kAngle));
        const double speed = speed_on_a_slope(GetParam(), friction);
        // Below a slip of friction_speed the braking is weaker: v' = g sin(theta) (1 - v / (friction_speed / part)).
        const double pull = kG * std::sin(kAngle);
        const double start = part > 0.0 ? -0.05 / (part * pull) * std::log(1.0 - part) : 0.05 / pull;
        EXPECT_NEAR(speed, 0.05 + (1.0 - start) * expected, 2e-3) << part;
    }
}

TEST_P(Penalty, ThrownSphereRollsAtFiveSeventhsOfItsSpeed) {
    Course course = course_of({"", 0.5, 0.3}, kGravity, settings_with(GetParam(), 1e-3));
    const double radius = 0.1;
    MovingParticle sphere = sunk(course, {0, 0, radius - kG / kStiffness}, {2, 0, 0}, radius);
    for (int k = 0; k < 2000; ++k) (void)course.move(sphere, 1e-3);
    EXPECT_NEAR(sphere.state.velocity.x, 10.0 / 7.0, 1e-6);
    EXPECT_NEAR(sphere.spin.y * radius, 10.0 / 7.0, 1e-6);
}

/// Returns the deviation from the equilibrium depth, relative to that depth, of a weight that started one hundredth
/// away. It is the largest deviation in the last hundred of 10000 steps.
double swing(IntegratorKind integrator, double restitution, double part_of_bound) {
    ResponseSettings settings = settings_with(integrator, 1.0);
    const double bound = longest_stable_step(contact_spring(settings, 1.0, restitution), 1.0);
    settings.time_step = part_of_bound * bound;
    const double sag = kG / kStiffness;
    Course course = course_of({"", restitution, 0.0}, kGravity, settings);
    MovingParticle block = sunk(course, {0, 0, -1.01 * sag});
    double largest = 0.0;
    for (int k = 0; k < 10000; ++k) {
        (void)course.move(block, settings.time_step);
        if (k >= 9900) largest = std::max(largest, std::fabs(block.state.position.z / sag + 1.0));
    }
    return largest;
}

// The bound is exact for central differences with lagging damping, that is, for symplectic Euler. Beyond the bound an
// undamped particle is thrown off. A damped one oscillates forever, because the force never pulls.
TEST(PenaltyStability, StabilityEndsExactlyAtTheBoundForSymplecticEuler) {
    EXPECT_LT(swing(IntegratorKind::symplectic_euler, 1.0, 1.0 / 1.02), 0.1);
    EXPECT_GT(swing(IntegratorKind::symplectic_euler, 1.0, 1.02), 1e3);
    for (const double restitution : {0.9, 0.6, 0.2, 0.05}) {
        EXPECT_LT(swing(IntegratorKind::symplectic_euler, restitution, 1.0 / 1.02), 1e-9) << restitution;
    }
    for (const double restitution : {0.9, 0.6}) {  // stronger dampers are limited to the change that a step can take
        EXPECT_GT(swing(IntegratorKind::symplectic_euler, restitution, 1.02), 0.02) << restitution;
    }
}

TEST(PenaltyStability, MotionIsStableUpToTheBoundForVelocityVerletAndRungeKutta) {
    for (const IntegratorKind integrator : {IntegratorKind::ballistic, IntegratorKind::rk4}) {
        for (const double part : {1.0 / 1.02, 0.7, 0.3}) {
            EXPECT_LT(swing(integrator, 1.0, part), 0.1) << part;
            for (const double restitution : {0.9, 0.6, 0.2, 0.05}) {
                EXPECT_LT(swing(integrator, restitution, part), 1e-9) << restitution << ' ' << part;
            }
        }
    }
}

// The explicit midpoint rule amplifies an undamped spring by sqrt(1 + (omega h)^4 / 4) per step. It has no stable step
// unless there is damping.
TEST(PenaltyStability, BoundDoesNotApplyToTheMidpointRule) {
    EXPECT_GT(swing(IntegratorKind::midpoint, 1.0, 0.5), 1.0);
    EXPECT_GT(swing(IntegratorKind::midpoint, 0.9, 1.0 / 1.02), 1.0);
    EXPECT_LT(swing(IntegratorKind::midpoint, 0.2, 1.0 / 1.02), 1e-9);
}

Material random_wall(double absorption, double diffuse) {
    Material material;
    material.absorption = absorption;
    material.diffuse = diffuse;
    return material;
}

TEST(PenaltyAtWallsOfChance, ParticlesAreAbsorbedAtTheBeginningOfAContact) {
    const double substep = 1e-3;
    Course course = course_of(random_wall(1.0, 0.0), {}, settings_with(IntegratorKind::ballistic, substep));
    for (int i = 0; i < test::scaled(100); ++i) {
        MovingParticle molecule = particle_at({0, 0, 0.01 + 1e-5 * i}, {1, 0, -3});
        molecule.id = static_cast<std::uint64_t>(i);
        MoveOutcome outcome;
        while (molecule.state.position.z > 0.0) outcome = course.move(molecule, substep);
        EXPECT_TRUE(outcome.is_absorbed());
        EXPECT_EQ(outcome.bounces, 1U);
    }
    Course some = course_of(random_wall(0.3, 0.0), {}, settings_with(IntegratorKind::ballistic, substep));
    const int count = test::scaled(5000);
    int absorbed = 0;
    for (int i = 0; i < count; ++i) {
        MovingParticle molecule = particle_at({0, 0, 0.01}, {1, 0, -3});
        molecule.id = static_cast<std::uint64_t>(i);
        for (int k = 0; k < 10 && molecule.state.position.z > 0.0; ++k) {
            absorbed += some.move(molecule, substep).is_absorbed() ? 1 : 0;
        }
    }
    EXPECT_NEAR(absorbed, 0.3 * count, 5.0 * std::sqrt(0.21 * count) + 1.0);
}

TEST(PenaltyAtWallsOfChance, ParticlesAreReflectedDiffuselyOncePerContact) {
    const double substep = 1e-3;
    Course course = course_of(random_wall(0.0, 1.0), {}, settings_with(IntegratorKind::ballistic, substep));
    const int count = test::scaled(2000);
    double cosines = 0.0;
    double energy = 0.0;
    for (int i = 0; i < count; ++i) {
        MovingParticle molecule = particle_at({0, 0, 0.01 + 3e-3 * i / count}, {1, 0, -3});
        molecule.id = static_cast<std::uint64_t>(i);
        std::uint32_t impacts = 0;
        for (int k = 0; k < 60; ++k) impacts += course.move(molecule, substep).bounces;
        EXPECT_EQ(impacts, 1U);
        EXPECT_GT(molecule.state.velocity.z, 0.0);
        cosines += molecule.state.velocity.z / length(molecule.state.velocity) / count;
        energy += length_squared(molecule.state.velocity) / 10.0 / count;
    }
    EXPECT_NEAR(cosines, 2.0 / 3.0, 5.0 * std::sqrt(1.0 / 18.0 / count) + 0.01);  // the mean of the cosine law
    // The direction changes at some depth, after some work of the spring. The energy error is second order in omega
    // times the substep.
    EXPECT_NEAR(energy, 1.0, 0.5 * kOmega * substep * kOmega * substep);
}

TEST(PenaltyRest, ParticleComesToRestWithinTheResponsesTolerance) {
    ResponseSettings settings;
    Course course({mesh_collider(floor_mesh(1.0, 2))}, {"", 0.3, 0.5}, kGravity, ResponseKind::penalty, settings);
    MovingParticle ball = particle_at({0.1, 0.2, 0.5}, {}, 0.05);
    bool resting = false;
    for (int k = 0; k < 240; ++k) resting = course.move(ball, settings.time_step).is_resting();
    EXPECT_TRUE(resting);
    EXPECT_EQ(ball.state.position.x, 0.1);
    EXPECT_EQ(ball.state.position.y, 0.2);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
