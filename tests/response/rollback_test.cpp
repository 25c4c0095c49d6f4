#include "ricochet/response/rollback.h"
#include "ricochet/dynamics/forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "response/course.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/random_draws.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::Course;
using testing::floor_mesh;
using testing::mesh_collider;
using testing::plane_collider;

constexpr double kG = 9.81;
constexpr double kPi = 3.14159265358979323846;

ForceInput at(const Vec3& position, const Vec3& velocity = {}) { return {position, velocity, 1.0, 0.0, 0.0}; }

ColliderDescription ground() { return plane_collider({0, 0, 0}, {0, 0, 1}); }

ResponseSettings settings_with(double time_tolerance, IntegratorKind integrator = IntegratorKind::ballistic) {
    ResponseSettings settings;
    settings.integrator = integrator;
    settings.rollback.time_tolerance = time_tolerance;
    return settings;
}

Course course_of(ColliderDescription collider, const Material& material, double time_tolerance,
                 IntegratorKind integrator = IntegratorKind::ballistic) {
    return {{std::move(collider)},
            material,
            {0, 0, -kG},
            ResponseKind::rollback,
            settings_with(time_tolerance, integrator)};
}

/// Rounding errors of a time of some seconds, and of a sphere's distance (kSphereTolerance) at some m/s.
constexpr double kTimeRounding = 2e-12;

TEST(Rollback, TimeOfImpactIsEarlyByAtMostTheTolerance) {
    for (int digits = 3; digits <= 12; ++digits) {
        const double tolerance = std::pow(10.0, -digits);
        SCOPED_TRACE(tolerance);
        for (const double radius : {0.0, 0.1}) {
            for (const double height : {0.3, 0.57, 1.0, 1.7}) {
                for (const bool is_mesh : {false, true}) {
                    Course course = course_of(is_mesh ? mesh_collider(floor_mesh(2.0, 3)) : ground(), {}, tolerance);
                    MovingParticle ball{{{0.1, 0.2, height + radius}, {}, 1.0, radius, 0.0}, {}, 0, 0};
                    const double t0 = std::sqrt(2.0 * height / kG);
                    ASSERT_EQ(course.move(ball, 1.5 * t0).bounces, 1U);
                    EXPECT_LE(course.impact_times().front(), t0 + kTimeRounding);
                    EXPECT_GE(course.impact_times().front(), t0 - tolerance - kTimeRounding);
                }
            }
        }
    }
}

TEST(Rollback, ToleranceSmallerBy1024CostsTenTrialsPerImpact) {
    const auto trials = [](double tolerance, double duration, std::uint32_t impacts) {
        Course course = course_of(ground(), {}, tolerance);
        ForceInput ball = at({0, 0, 1});
        const MoveOutcome outcome = course.move(ball, duration);
        EXPECT_EQ(outcome.bounces, impacts);
        return static_cast<int>(outcome.trials);
    };
    const double t0 = std::sqrt(2.0 / kG);
    for (const double tolerance : {1e-3, 3e-4, 1e-6, 1e-8}) {
        SCOPED_TRACE(tolerance);
        EXPECT_EQ(trials(tolerance / 1024.0, 1.5 * t0, 1) - trials(tolerance, 1.5 * t0, 1), 10);
        // The rest of the step after the first impact depends on the tolerance: one trial more or less per impact.
        EXPECT_NEAR(trials(tolerance / 1024.0, 8.0 * t0, 4) - trials(tolerance, 8.0 * t0, 4), 40, 4);
    }
}

// An elastic ball resolved too early by d has the speed of its height, so it is early by another 2 d at the next
// impact.
TEST(Rollback, EveryImpactOfAnElasticBallIsWithinItsTolerances) {
    const double t0 = std::sqrt(2.0 / kG);
    for (const double time_step : {20.0 * t0, 0.3, 1.0 / 60.0}) {
        for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
            SCOPED_TRACE(::testing::Message() << "step " << time_step << ", tolerance " << tolerance);
            Course course = course_of(ground(), {}, tolerance);
            ForceInput ball = at({0, 0, 1});
            std::vector<double> times;
            while (ball.time < 14.5 * t0) {
                (void)course.move(ball, time_step);
                for (const double time : course.impact_times()) times.push_back(time);
                EXPECT_NEAR(ball.position.z + 0.5 * length_squared(ball.velocity) / kG, 1.0, 1e-12);
            }
            ASSERT_GE(times.size(), 7U);
            for (int n = 0; n < 7; ++n) {
                const double expected = (2 * n + 1) * t0;
                const double time = times[static_cast<std::size_t>(n)];
                EXPECT_LE(time, expected + kTimeRounding);
                EXPECT_GE(time, expected - (2 * n + 1) * tolerance - kTimeRounding);
            }
        }
    }
}

// The impact is resolved at a height v d above the floor, at a speed too small by g d. The apex is too high by (1 -
// e^2) v d. The errors of earlier impacts shrink by e^2 each.
TEST(Rollback, ApexRisesByAtMostTheDistanceOfOneTolerance) {
    for (const double e : {0.5, 0.8, 0.95}) {
        for (const double tolerance : {1e-3, 1e-5, 1e-7, 1e-9}) {
            SCOPED_TRACE(::testing::Message() << "e " << e << ", tolerance " << tolerance);
            Course course = course_of(ground(), {"", e, 0.0}, tolerance);
            ForceInput ball = at({0, 0, 1});
            (void)course.move(ball, 0.99 * std::sqrt(2.0 / kG) * (1.0 + e) / (1.0 - e));
            ASSERT_GE(course.scratch.records.size(), 5U);
            for (int n = 0; n < 5; ++n) {
                const ContactRecord& record = course.scratch.records[static_cast<std::size_t>(n)];
                const double apex = record.position.z + 0.5 * length_squared(record.velocity_after) / kG;
                const double expected = std::pow(e, 2.0 * (n + 1));
                EXPECT_GE(apex, expected - 1e-12);
                EXPECT_LE(apex, expected + std::sqrt(2.0 * kG) * tolerance + 1e-12);
            }
        }
    }
}

// Successive hops of an elastic ball down a slope have the lengths 8 h sin(theta) (1, 2, 3, ...), and all take 2 t0.
TEST(Rollback, HopsDownASlopeMatchTheClosedFormWithinTheirTolerances) {
    const double t0 = std::sqrt(2.0 / kG);
    for (const double degrees : {30.0, 45.0}) {
        const double theta = degrees * kPi / 180.0;
        const Vec3 downhill{std::cos(theta), 0, -std::sin(theta)};
        for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
            SCOPED_TRACE(::testing::Message() << degrees << " degrees, tolerance " << tolerance);
            Course course = course_of(plane_collider({0, 0, 0}, {std::sin(theta), 0, std::cos(theta)}), {}, tolerance);
            ForceInput ball = at({0, 0, 1});
            const double start = dot(ball.position, downhill);
            (void)course.move(ball, 16.0 * t0);
            ASSERT_GE(course.scratch.records.size(), 8U);
            for (int n = 0; n < 8; ++n) {
                const ContactRecord& record = course.scratch.records[static_cast<std::size_t>(n)];
                const double time = (2 * n + 1) * t0;
                const double speed = kG * std::sin(theta) * time;
                // The impact is 1 + 8 (1 + 2 + ... + n) times h sin(theta) below the start.
                const double distance = (1.0 + 4.0 * n * (n + 1)) * std::sin(theta);
                EXPECT_NEAR(dot(record.position, downhill) - start, distance, (2 * n + 1) * tolerance * speed + 1e-10);
            }
        }
    }
}

// A documented limit: only the chord of the path is tested.
TEST(Rollback, ArcThatDipsThroughAPlaneWithinAStepIsMissed) {
    const double v = 2.0;
    const double back = 2.0 * v / kG;
    for (const ResponseKind kind : {ResponseKind::rollback, ResponseKind::exact}) {
        Course course({ground()}, {}, {0, 0, kG}, kind, settings_with(1e-9));
        ForceInput ball = at({0, 0, 0.1}, {1, 0, -v});
        const MoveOutcome outcome = course.move(ball, back);
        EXPECT_EQ(outcome.bounces, kind == ResponseKind::exact ? 1U : 0U);
        if (kind == ResponseKind::exact) continue;
        EXPECT_EQ(outcome.trials, 1U);
        EXPECT_NEAR(length(ball.position - Vec3{back, 0, 0.1}), 0.0, 1e-14);
        // Steps that end below the plane detect it.
        ball = at({0, 0, 0.1}, {1, 0, -v});
        EXPECT_EQ(course.move(ball, 0.4 * back).bounces, 1U);
    }
}

/// Returns a random rock: a sphere mesh with every vertex moved in or out.
TriangleMesh rock(std::uint64_t seed) {
    TriangleMesh mesh = testing::sphere_mesh({}, 1.0, 2);
    RandomSequence random(seed, 0, 0);
    for (Vec3& vertex : mesh.vertices) vertex *= 0.7 + 0.6 * random.uniform();
    return mesh;
}

struct Containment {
    IntegratorKind integrator;
    bool global;
};

class RollbackInRocks : public ::testing::TestWithParam<Containment> {};
INSTANTIATE_TEST_SUITE_P(
    Integrators, RollbackInRocks,
    ::testing::Values(Containment{IntegratorKind::ballistic, false},
                      Containment{IntegratorKind::symplectic_euler, false},
                      Containment{IntegratorKind::midpoint, false}, Containment{IntegratorKind::rk4, false},
                      Containment{IntegratorKind::ballistic, true}, Containment{IntegratorKind::symplectic_euler, true},
                      Containment{IntegratorKind::midpoint, true}, Containment{IntegratorKind::rk4, true}),
    [](const auto& of) { return std::string(name_of(of.param.integrator)) + (of.param.global ? "_global" : ""); });

TEST_P(RollbackInRocks, NoSegmentCrossesASurfaceAndNoParticleEndsOnTheWrongSide) {
    std::uint64_t contacts = 0;
    for (const std::uint64_t seed : {1U, 2U, 3U, 4U}) {
        for (const double radius : {0.0, 0.05}) {
            SCOPED_TRACE(::testing::Message() << "seed " << seed << ", radius " << radius);
            SimulationSetup setup;
            setup.options.integrator = GetParam().integrator;
            setup.options.response = ResponseKind::rollback;
            setup.options.rollback.global = GetParam().global;
            setup.options.verify = true;
            setup.options.time_step = 0.02;
            setup.options.duration = 0.02 * 60;
            setup.forces.push_back(make_gravity({0, 0, -kG}));
            setup.forces.push_back(make_linear_drag(0.05));
            setup.materials = {{"", seed % 2 == 0 ? 1.0 : 0.6, seed % 2 == 0 ? 0.0 : 0.3}};
            setup.colliders.push_back(mesh_collider(rock(seed)));
            RandomSequence random(seed, 1, 0);
            for (int i = 0; i < test::scaled(25); ++i) {
                Particle particle;
                particle.position = testing::random_vector(random, 0.3);
                particle.velocity = testing::random_vector(random, 8.0);
                particle.radius = radius;
                setup.particles.push_back(particle);
            }
            Simulation simulation(std::move(setup));
            while (!simulation.finished()) simulation.step();
            EXPECT_EQ(simulation.statistics().violations, 0U);
            EXPECT_EQ(simulation.statistics().frozen, 0U);
            contacts += simulation.statistics().contacts;
        }
    }
    EXPECT_GT(contacts, 8U * static_cast<std::uint64_t>(test::scaled(25)));
}

/// Returns elastic points above a floor, dropped from different heights.
SimulationSetup rain(int count, bool global, double tolerance) {
    SimulationSetup setup;
    setup.options.response = ResponseKind::rollback;
    setup.options.rollback = {tolerance, global};
    setup.options.time_step = 1.0;
    setup.options.duration = 1.0;
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.materials = {{"", 1.0, 0.0}};
    setup.colliders.push_back(ground());
    for (int i = 0; i < count; ++i) {
        Particle particle;
        particle.position = {0.1 * i, 0, 0.9 + 0.8 * (i + 0.5) / count};
        setup.particles.push_back(particle);
    }
    return setup;
}

Simulation finished(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

class RollbackOfOne : public ::testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, RollbackOfOne,
                         ::testing::Values(IntegratorKind::ballistic, IntegratorKind::midpoint, IntegratorKind::rk4),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

TEST_P(RollbackOfOne, SystemAndParticleRollbackAgreeWithinTheTolerance) {
    for (const double tolerance : {1e-5, 1e-8, 1e-11}) {
        SCOPED_TRACE(tolerance);
        const auto end = [&](bool global) {
            SimulationSetup setup = rain(1, global, tolerance);
            setup.options.integrator = GetParam();
            setup.options.time_step = 0.1;
            setup.options.duration = 3.0;
            setup.materials = {{"", 0.8, 0.0}};
            setup.particles[0].velocity = {0.5, 0, 0};
            return finished(std::move(setup));
        };
        const Simulation alone = end(false);
        const Simulation together = end(true);
        EXPECT_EQ(alone.statistics().contacts, together.statistics().contacts);
        EXPECT_GT(alone.statistics().contacts, 3U);
        const double moved = length(alone.particles().position[0] - together.particles().position[0]);
        EXPECT_LT(moved, 100.0 * tolerance);
    }
}

TEST(RollbackTogether, EveryCollisionCostsAllParticlesATrial) {
    const auto trials_per_particle = [](int count, bool global) {
        const Simulation simulation = finished(rain(count, global, 1e-6));
        EXPECT_EQ(simulation.statistics().contacts, static_cast<std::uint64_t>(count));  // each at another time
        return static_cast<double>(simulation.statistics().trials) / count;
    };
    const double alone = trials_per_particle(1, false);
    EXPECT_NEAR(trials_per_particle(64, false), alone, 1.0);
    for (const int count : {16, 32, 64}) {
        EXPECT_GE(trials_per_particle(count, true), count) << count;
        EXPECT_NEAR(trials_per_particle(2 * count, true) / trials_per_particle(count, true), 2.0, 0.6) << count;
    }
}

TEST(RollbackTogether, SystemAndParticleRollbackAgreeForManyParticles) {
    for (const double tolerance : {1e-4, 1e-7, 1e-10}) {
        SCOPED_TRACE(tolerance);
        const Simulation alone = finished(rain(40, false, tolerance));
        const Simulation together = finished(rain(40, true, tolerance));
        // The error bound at 6 m/s: two tolerances ahead for the impact, one for each of two brackets' ends and one for
        // waiting.
        for (std::size_t i = 0; i < 40; ++i) {
            const double moved = length(alone.particles().position[i] - together.particles().position[i]);
            EXPECT_LT(moved, 6.0 * 5.0 * tolerance + 1e-12) << i;
        }
    }
}

TEST(RollbackTogether, ParticlesAtRestCostNoTrials) {
    const auto run = [](int resting) {
        SimulationSetup setup = rain(4, true, 1e-9);
        setup.options.time_step = 0.1;
        setup.options.duration = 2.0;
        setup.materials = {{"", 0.6, 0.5}};
        for (int i = 0; i < resting; ++i) {
            Particle particle;
            particle.position = {-1.0 - i, 0, 1e-12};
            setup.particles.push_back(particle);
        }
        return finished(std::move(setup));
    };
    const Simulation without = run(0);
    const Simulation with = run(50);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_LT(length(with.particles().position[i] - without.particles().position[i]), 1e-6);
    }
    EXPECT_EQ(with.statistics().resting, 50U + without.statistics().resting);
    // The resting particles land in the first step and cost nothing afterwards.
    EXPECT_LT(with.statistics().trials, without.statistics().trials + 50U * 60U);
}

TEST(RollbackTogether, BitsDoNotDependOnTheNumberOfThreads) {
    const auto hash = [](int threads) {
        const ThreadLimit limit(threads);
        SimulationSetup setup = rain(test::scaled(600), true, 1e-6);
        setup.options.time_step = 0.05;
        setup.options.duration = 0.5;
        const Simulation simulation = finished(std::move(setup));
        EXPECT_GT(simulation.statistics().contacts, 0U);
        return simulation.state_hash();
    };
    EXPECT_EQ(hash(1), hash(2));
}

// In a system rollback each piece of a step is a step with its own kick, so each impact costs a part of a kick. A
// particle that rolls back alone gets one kick per step.
TEST(RollbackTogether, SystemRollbackLosesHeightUnderSymplecticEuler) {
    const auto height = [](bool global) {
        SimulationSetup setup = rain(1, global, 1e-9);
        setup.options.integrator = IntegratorKind::symplectic_euler;
        setup.options.time_step = 0.01;
        setup.options.duration = 10.0;
        const double start = setup.particles[0].position.z;
        const Simulation simulation = finished(std::move(setup));
        const double speed = length(simulation.particles().velocity[0]);
        return (simulation.particles().position[0].z + 0.5 * speed * speed / kG) / start;
    };
    EXPECT_NEAR(height(false), 1.0, 0.05);
    EXPECT_LT(height(true), 0.8);
}

TEST(RollbackContact, ParticleComesToRestAndStaysThere) {
    for (const double radius : {0.0, 0.05}) {
        for (const double tolerance : {1e-6, 1e-9}) {
            SCOPED_TRACE(::testing::Message() << "radius " << radius << ", tolerance " << tolerance);
            Course course = course_of(mesh_collider(floor_mesh(1.0, 4)), {"", 0.5, 0.4}, tolerance);
            MovingParticle ball{{{0.1, 0.2, 0.2 + radius}, {}, 1.0, radius, 0.0}, {}, 0, 0};
            for (int k = 0; k < 120; ++k) (void)course.move(ball, 1.0 / 60.0);
            const Vec3 position = ball.state.position;
            EXPECT_GT(position.z, radius - 1e-12);
            // The particle lands at most one tolerance's distance above the floor. Its speed is the resting speed or
            // the gain of one step.
            EXPECT_LT(position.z, radius + tolerance * (kG / 60.0 + 1e-3));
            for (int k = 0; k < 1000; ++k) {
                ASSERT_TRUE(course.move(ball, 1.0 / 60.0).is_resting()) << k;
                ASSERT_EQ(ball.state.position, position) << k;
            }
        }
    }
}

class RollbackOnASlope : public ::testing::TestWithParam<IntegratorKind> {};
INSTANTIATE_TEST_SUITE_P(Integrators, RollbackOnASlope,
                         ::testing::Values(IntegratorKind::ballistic, IntegratorKind::symplectic_euler,
                                           IntegratorKind::midpoint, IntegratorKind::rk4),
                         [](const auto& kind) { return std::string(name_of(kind.param)); });

TEST_P(RollbackOnASlope, FrictionHoldsBelowItsAngleAndBrakesAboveItByCoulombsLaw) {
    const double theta = 0.5;
    const Vec3 normal{std::sin(theta), 0, std::cos(theta)};
    const Vec3 downhill{std::cos(theta), 0, -std::sin(theta)};
    for (const double part : {0.0, 0.3, 0.6, 0.9, 1.1, 1.5}) {
        SCOPED_TRACE(part);
        const double friction = part * std::tan(theta);
        Course course = course_of(plane_collider({0, 0, 0}, normal), {"", 0.3, friction}, 1e-9, GetParam());
        ForceInput block = at(1e-9 * normal);
        bool resting = false;
        for (int k = 0; k < 100; ++k) resting = course.move(block, 0.01).is_resting();
        const double expected = part < 1.0 ? kG * (std::sin(theta) - friction * std::cos(theta)) : 0.0;
        EXPECT_EQ(resting, part > 1.0);
        EXPECT_NEAR(dot(block.velocity, downhill), expected, 0.01 * expected);
        EXPECT_NEAR(dot(block.position, downhill), 0.5 * expected, 0.02 * 0.5 * expected + 1e-6);
        EXPECT_NEAR(dot(block.position, normal), 0.0, 1e-6);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
