// A ball on a dynamic body. The ball can be much lighter or much heavier than the body. Ball and body come to rest in
// equilibrium. No energy is created, and steps are split into few substeps, for any resting speed.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "ricochet/simulation.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

/// A dynamic body of 1 kg with a ball as its load.
struct Pushed {
    BodyDescription body;
    Particle ball;
    double restitution = 0.0;
    double friction = 0.0;
    double resting_speed = 1e-3;
    double gravity = kG;
    double step = 0.01;
    double duration = 3.0;
};

Simulation simulation_of(const Pushed& pushed) {
    FrameDescription frame = frame_of("body", {});
    frame.is_driven = true;
    SimulationSetup setup = setup_of({frame}, {{"plate", PlaneShape{}, 0, "body"}}, pushed.step, pushed.duration);
    setup.options.resting_speed = pushed.resting_speed;
    setup.options.bounce_budget = 10000;  // without a resting speed, each small rebound counts against the budget
    setup.bodies = {pushed.body};
    setup.forces.push_back(make_gravity({0, 0, -pushed.gravity}));
    setup.particles = {pushed.ball};
    setup.materials = {{"steel", pushed.restitution, pushed.friction}};
    return Simulation(std::move(setup));
}

BodyDescription body_of(JointKind joint, const Vec3& axis) {
    BodyDescription body;
    body.frame = "body";
    body.mass = 1.0;
    body.inertia = {.xx = 1.0, .yy = 1.0, .zz = 1.0};
    body.joint = joint;
    body.axis = axis;
    return body;
}

Particle ball_of(double mass, const Vec3& position, const Vec3& velocity = {}) {
    Particle ball = particle_of(position, velocity, 0.0);
    ball.mass = mass;
    return ball;
}

/// Returns the energy of the ball, the body and its spring, in J.
double energy_of(const Simulation& simulation, const Pushed& pushed) {
    const Particles& all = simulation.particles();
    const BodyState body = simulation.bodies()[0];
    const double stretch = body.coordinate - pushed.body.settings.spring_rest;
    const double of_ball = 0.5 * dot(all.velocity[0], all.velocity[0]) + pushed.gravity * all.position[0].z;
    return all.mass[0] * of_ball + body.kinetic_energy + pushed.gravity * body.mass * body.center.z +
           0.5 * pushed.body.settings.spring * stretch * stretch;
}

struct Course {
    double gained = 0.0;  // largest increase of the energy above an earlier value, in J
    double coordinate = 0.0;
    double parts = 0.0;  // substeps per step
    double lost = 0.0;   // unsimulated time, in s
};

Course run(const Pushed& pushed) {
    Simulation simulation = simulation_of(pushed);
    Course course;
    double least = energy_of(simulation, pushed);
    while (!simulation.finished()) {
        simulation.step();
        const double energy = energy_of(simulation, pushed);
        course.gained = std::max(course.gained, energy - least);
        least = std::min(least, energy);
    }
    course.coordinate = simulation.bodies()[0].coordinate;
    const SimulationStatistics& statistics = simulation.statistics();
    course.parts = static_cast<double>(statistics.body_parts) / static_cast<double>(statistics.steps);
    course.lost = statistics.unsimulated_time;
    EXPECT_EQ(statistics.violations, 0U);
    return course;
}

template <class Check>
void for_all_balls(const Check& check) {
    for (const double ratio : {0.1, 1.0, 10.0, 100.0}) {
        for (const double resting_speed : {1e-3, 0.0}) {
            for (const double restitution : {0.0, 0.5}) {
                SCOPED_TRACE("ratio " + std::to_string(ratio) + ", resting speed " + std::to_string(resting_speed) +
                             ", restitution " + std::to_string(restitution));
                check(ratio, resting_speed, restitution);
            }
        }
    }
}

TEST(ATrayOnASpring, ComesToRestUnderABallOfAnyMass) {
    for_all_balls([](double ratio, double resting_speed, double restitution) {
        Pushed pushed;
        pushed.body = body_of(JointKind::slider, {0, 0, 1});
        const double whole = 1.0 + ratio;
        pushed.body.settings.spring = 100.0 * whole;
        pushed.body.settings.damping = 10.0 * whole;
        pushed.ball = ball_of(ratio, {0.1, 0, 0.01});
        pushed.restitution = restitution;
        pushed.resting_speed = resting_speed;
        const Course course = run(pushed);
        EXPECT_EQ(course.lost, 0.0);
        EXPECT_NEAR(course.coordinate, -kG / 100.0, 1e-4);
        EXPECT_LT(course.gained, 1e-11 * whole);
        EXPECT_LT(course.parts, resting_speed > 0.0 ? 10.0 : 300.0);
    });
}

// Friction keeps the ball in place on the plate, 0.5 m from the axis.
TEST(APlateOnAHinge, ComesToRestUnderABallOfAnyMass) {
    for_all_balls([](double ratio, double resting_speed, double restitution) {
        // This case takes long, and the test of the tray covers it.
        if (ratio > 10.0 && resting_speed == 0.0 && restitution > 0.0) return;
        Pushed pushed;
        pushed.body = body_of(JointKind::hinge, {0, -1, 0});
        constexpr double kArm = 0.5;
        constexpr double kAngle = -0.1;
        const double inertia = 1.0 + ratio * kArm * kArm;
        pushed.body.settings.spring = ratio * kG * kArm * std::cos(kAngle) / -kAngle;
        pushed.body.settings.damping = 1.4 * std::sqrt(pushed.body.settings.spring * inertia);
        pushed.ball = ball_of(ratio, {kArm, 0, 0.01});
        pushed.restitution = restitution;
        pushed.friction = 2.0;
        pushed.resting_speed = resting_speed;
        const Course course = run(pushed);
        EXPECT_EQ(course.lost, 0.0);
        EXPECT_NEAR(course.coordinate, kAngle, 2e-3);
        EXPECT_LT(course.gained, 1e-11 * inertia);
        EXPECT_LT(course.parts, resting_speed > 0.0 ? 10.0 : 300.0);
    });
}

Pushed door_and_ball(double mass, double restitution) {
    Pushed pushed;
    pushed.body = body_of(JointKind::hinge, {0, 1, 0});
    pushed.body.mass = 0.1;
    pushed.body.inertia = {.xx = 0.07, .yy = 0.07, .zz = 0.07};
    pushed.ball = ball_of(mass, {2.0, 0, 0.01}, {-20.0, 0, -2.0});
    pushed.restitution = restitution;
    pushed.gravity = 0.0;
    pushed.step = 0.02;
    pushed.duration = 0.4;
    return pushed;
}

// A particle slides along a light door towards the hinge. The effective mass of the door grows on the way. The particle
// opens the door within a single step. The energy may rise again after a loss, but only by the error of the integration
// method.
TEST(ALightDoor, IsPushedOpenByAHeavyBallWithoutEnergyGain) {
    for (const auto& [mass, bound] : {std::pair{1.0, 5e-3}, {10.0, 2e-3}, {100.0, 5e-5}}) {
        for (const double restitution : {0.0, 0.5}) {
            SCOPED_TRACE(std::to_string(mass) + " kg, restitution " + std::to_string(restitution));
            const Course course = run(door_and_ball(mass, restitution));
            EXPECT_LT(course.gained, bound * 0.5 * mass * 404.0);
            EXPECT_EQ(course.lost, 0.0);
            EXPECT_LT(course.parts, 100.0);
        }
    }
}

// A central impact reverses the velocity of each body relative to the centre of mass, and multiplies it by the
// restitution.
TEST(AFreePlate, IsHitByAMuchHeavierBallAsInClosedForm) {
    for (const double mass : {100.0, 1e4}) {
        for (const double restitution : {1.0, 0.5, 0.0}) {
            SCOPED_TRACE(std::to_string(mass) + " kg, restitution " + std::to_string(restitution));
            Pushed pushed;
            pushed.body = body_of(JointKind::free, {});
            pushed.ball = ball_of(mass, {0, 0, 0.01}, {0, 0, -1.0});
            pushed.restitution = restitution;
            pushed.gravity = 0.0;
            pushed.duration = 0.5;
            Simulation simulation = simulation_of(pushed);
            while (!simulation.finished()) simulation.step();
            const double common = -mass / (mass + 1.0);
            const double ball = common + restitution * (common + 1.0);
            EXPECT_NEAR(simulation.particles().velocity[0].z, ball, 1e-12);
            EXPECT_NEAR(simulation.bodies()[0].velocity.z, common * (1.0 + restitution), 1e-10);
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
        }
    }
}

// Without losses, energy is conserved up to the error of the substep after each impact.
TEST(ALightDoor, ConservesTheEnergyOfAnElasticHeavyBall) {
    for (const double mass : {1.0, 10.0, 100.0}) {
        SCOPED_TRACE(std::to_string(mass) + " kg");
        const Pushed pushed = door_and_ball(mass, 1.0);
        Simulation simulation = simulation_of(pushed);
        const double before = energy_of(simulation, pushed);
        while (!simulation.finished()) simulation.step();
        EXPECT_GT(simulation.statistics().contacts, 1U);
        EXPECT_NEAR(energy_of(simulation, pushed), before, 1e-6 * before);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
