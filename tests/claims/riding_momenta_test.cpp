// Momentum and angular momentum in persistent contact with dynamic bodies and with colliders of prescribed motion. In
// every step, the gain of the bodies and colliders equals the loss of the particles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Momenta of all bodies and particles. Particles have the inertia of solid spheres.
struct Momenta {
    Vec3 linear;
    Vec3 angular;        ///< about the origin, including spin
    double scale = 0.0;  ///< sum of magnitudes, in kg m/s
};

Momenta momenta_of(const Simulation& simulation) {
    Momenta sum;
    const Particles& p = simulation.particles();
    for (std::size_t i = 0; i < p.size(); ++i) {
        sum.linear += p.mass[i] * p.velocity[i];
        sum.angular += p.mass[i] * (cross(p.position[i], p.velocity[i]) + 0.4 * p.radius[i] * p.radius[i] * p.spin[i]);
        sum.scale += p.mass[i] * length(p.velocity[i]);
    }
    for (const BodyState& body : simulation.bodies()) {
        sum.linear += body.mass * body.velocity;
        sum.angular += body.mass * cross(body.center, body.velocity) + body.angular_momentum;
        sum.scale += body.mass * length(body.velocity) + length(body.angular_momentum);
    }
    return sum;
}

BodyDescription body_in(const std::string& frame, double mass, double inertia, JointKind joint, const Vec3& axis) {
    BodyDescription body;
    body.frame = frame;
    body.mass = mass;
    body.inertia = {inertia, inertia, 1.3 * inertia, 0.0, 0.0, 0.0};
    body.joint = joint;
    body.axis = axis;
    return body;
}

/// Returns a particle at a random position in a box, with a random velocity.
Particle somewhere(RandomSequence& random, const Vec3& half, double radius) {
    Vec3 place;
    for (int axis = 0; axis < 3; ++axis) place[axis] = (2.0 * random.uniform() - 1.0) * half[axis];
    Particle particle = particle_of(place, 0.3 * random.unit_vector(), radius);
    particle.mass = 0.02 + 0.02 * random.uniform();
    return particle;
}

// A box tumbles in free space, with particles that rest, slide and roll on its walls.
TEST(WhatRidesInATumblingBody, ConservesTheTotalMomentumAndAngularMomentumInEveryStep) {
    for (const double friction : {0.0, 0.4}) {
        for (const double radius : {0.0, 0.05}) {
            SCOPED_TRACE(std::to_string(friction) + " " + std::to_string(radius));
            FrameDescription frame = frame_of("box", {}, {0.3, 0.2, -0.1});
            frame.is_driven = true;
            SimulationSetup setup = setup_of({frame}, {{"box", CuboidShape{{1.0, 0.8, 0.6}, {}}, 0, "box"}}, 0.01, 0.8);
            setup.bodies = {body_in("box", 6.0, 0.8, JointKind::free, {})};
            setup.bodies[0].velocity = {0.4, -0.3, 0.2};
            setup.bodies[0].angular_velocity = {1.0, -2.0, 3.0};
            setup.materials = {{"felt", 0.0, friction}};
            RandomSequence random(3, 0, 0);
            for (int k = 0; k < std::max(4, test::scaled(24)); ++k) {
                Particle particle = somewhere(random, {0.4, 0.3, 0.2}, radius);
                particle.position += Vec3{0.3, 0.2, -0.1};
                particle.velocity += Vec3{0.4, -0.3, 0.2};
                setup.particles.push_back(particle);
            }
            Simulation simulation(std::move(setup));
            const Momenta first = momenta_of(simulation);
            Momenta before = first;
            while (!simulation.finished()) {
                simulation.step();
                const Momenta after = momenta_of(simulation);
                ASSERT_LT(length(after.linear - before.linear), 1e-12 * after.scale) << simulation.time();
                ASSERT_LT(length(after.angular - before.angular), 1e-12 * after.scale) << simulation.time();
                before = after;
            }
            EXPECT_LT(length(before.angular - first.angular), 1e-12 * first.scale * 200.0);
            EXPECT_EQ(simulation.statistics().violations, 0U);
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
        }
    }
}

// Gravity is along the hinge axis of a table and has no moment about it. Only the particles that slide over the table
// turn it.
TEST(WhatSlidesOverATurntable, TransfersItsAngularMomentumToIt) {
    for (const double radius : {0.0, 0.05}) {
        SCOPED_TRACE(radius);
        FrameDescription frame = frame_of("table", {});
        frame.is_driven = true;
        SimulationSetup setup =
            setup_of({frame}, {{"table", CuboidShape{{4, 4, 0.2}, {{0, 0, -0.1}}}, 0, "table"}}, 0.01, 1.5);
        setup.bodies = {body_in("table", 5.0, 2.0, JointKind::hinge, {0, 0, 1})};
        setup.bodies[0].rate = 1.5;
        setup.materials = {{"felt", 0.2, 0.3}};
        setup.forces.push_back(make_gravity({0, 0, -9.81}));
        RandomSequence random(4, 0, 0);
        for (int k = 0; k < std::max(4, test::scaled(24)); ++k) {
            Particle particle = somewhere(random, {1.0, 1.0, 0.1}, radius);
            particle.position.z += 0.2;
            particle.velocity *= 3.0;
            setup.particles.push_back(particle);
        }
        Simulation simulation(std::move(setup));
        Momenta before = momenta_of(simulation);
        const double rate = simulation.bodies()[0].rate;
        while (!simulation.finished()) {
            simulation.step();
            const Momenta after = momenta_of(simulation);
            ASSERT_LT(std::fabs(after.angular.z - before.angular.z), 1e-12 * after.scale) << simulation.time();
            before = after;
        }
        EXPECT_GT(std::fabs(simulation.bodies()[0].rate - rate), 0.02);
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
}

// On a table with prescribed rotation, the recorded moment about the axis must equal the loss of the particles' angular
// momentum.
TEST(TheMomentOfContactThatLasts, IsRecordedAboutTheAxisOfATurningTable) {
    for (const double radius : {0.0, 0.05}) {
        SCOPED_TRACE(radius);
        SimulationSetup setup = setup_of({frame_of("table", {Spin{{0, 0, 1}, 70.0}})},
                                         {{"table", CuboidShape{{4, 4, 0.2}, {{0, 0, -0.1}}}, 0, "table"}}, 0.01, 1.5);
        setup.materials = {{"felt", 0.2, 0.3}};
        setup.forces.push_back(make_gravity({0, 0, -9.81}));
        RandomSequence random(5, 0, 0);
        for (int k = 0; k < std::max(4, test::scaled(24)); ++k) {
            Particle particle = somewhere(random, {1.0, 1.0, 0.1}, radius);
            particle.position.z += 0.2;
            setup.particles.push_back(particle);
        }
        Simulation simulation(std::move(setup));
        Momenta before = momenta_of(simulation);
        double given = 0.0;
        while (!simulation.finished()) {
            simulation.step();
            const Momenta after = momenta_of(simulation);
            const double now = simulation.collider_totals()[0].moment.z;
            ASSERT_LT(std::fabs(after.angular.z - before.angular.z + (now - given)),
                      1e-12 * (after.scale + before.scale + std::fabs(now)))
                << simulation.time();
            given = now;
            before = after;
        }
        EXPECT_GT(std::fabs(given), 0.01);
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
