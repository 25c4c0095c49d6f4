// Contact with relative velocities that are only rounding errors of larger velocities. The cases are uniformly moving
// floors, and particles that reach both walls of an edge at the same time.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

TEST(AFloorThatMovesSteadily, CarriesAParticleAfterOneImpactInEveryOrientation) {
    for (const double radius : {0.0, 0.1}) {
        for (int k = 0; k < 12; ++k) {
            SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(k));
            const Vec3 n = normalized(Vec3{0.3 * k - 1.7, 0.11 * k * k - 4.0, 2.0});
            const Vec3 along = normalized(cross(n, {0.2, 1.0, 0.4}));
            auto setup =
                setup_of({frame_of("floor", {steady(along)})}, {{"floor", PlaneShape{{}, n}, 0, "floor"}}, 0.1, 1.0);
            setup.materials = {{"", 0.5, 0.5}};
            setup.forces.push_back(make_gravity(-kG * n));
            setup.particles = {particle_of((radius + 1e-12) * n, along, radius)};
            Simulation simulation(std::move(setup));
            EXPECT_LE(all_contacts(simulation).size(), 1U);
            EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
            EXPECT_LT(length(simulation.particles().position[0] - (radius * n + along)), 1e-9);
        }
    }
}

TEST(AnEdgeOfTwoWalls, ReversesAParticleThatSlidesIntoIt) {
    const Vec3 velocity{1.412990398168904, 1.8622771070860458, 0.0};
    for (int k = 0; k < 60; ++k) {
        SCOPED_TRACE(k);
        const Vec3 edge = (0.1 + 0.0137 * k) * velocity;
        auto setup = setup_of({},
                              {{"floor", PlaneShape{{}, {0, 0, 1}}},
                               {"x", PlaneShape{edge, {-1, 0, 0}}, 1},
                               {"y", PlaneShape{edge, {0, -1, 0}}, 1}},
                              0.0319751, 1.0);
        setup.materials = {{"", 0.8, 0.0}, {"", 1.0, 0.0}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.particles = {particle_of({0, 0, 1e-12}, velocity)};
        Simulation simulation(std::move(setup));
        static_cast<void>(all_contacts(simulation));
        EXPECT_LT(length(simulation.particles().velocity[0] + velocity), 1e-8);
    }
}

// The same edge belongs to a dynamic body, which is so heavy that it practically stays at rest.
TEST(AnEdgeOfTwoWalls, ReversesAParticleInADynamicBody) {
    const Vec3 velocity{1.412990398168904, 1.8622771070860458, 0.0};
    for (int k = 0; k < 60; ++k) {
        SCOPED_TRACE(k);
        const Vec3 edge = (0.1 + 0.0137 * k) * velocity;
        FrameDescription frame = frame_of("body", {});
        frame.is_driven = true;
        auto setup = setup_of({frame},
                              {{"floor", CuboidShape{{20, 20, 1}, {{0, 0, -0.5}}}, 0, "body"},
                               {"x", CuboidShape{{1, 20, 1}, {edge + Vec3{0.5, 0, 0.25}}}, 1, "body"},
                               {"y", CuboidShape{{20, 1, 1}, {edge + Vec3{0, 0.5, 0.25}}}, 1, "body"}},
                              0.0319751, 1.0);
        setup.materials = {{"", 0.8, 0.0}, {"", 1.0, 0.0}};
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        BodyDescription body;
        body.frame = "body";
        body.mass = 1e12;
        body.inertia = {.xx = 1e12, .yy = 1e12, .zz = 1e12};
        body.joint = JointKind::free;
        body.feels_forces = false;
        setup.bodies = {body};
        setup.particles = {particle_of({0, 0, 1e-12}, velocity)};
        Simulation simulation(std::move(setup));
        static_cast<void>(all_contacts(simulation));
        EXPECT_LT(length(simulation.particles().velocity[0] + velocity), 1e-8);
    }
}

// In a narrow wedge, a particle rebounds slowly from one wall while it hits the other wall. A wall that the particle
// leaves must not support it. Each impact must have the restitution of the hit wall's material.
TEST(ANarrowWedge, GivesEachImpactTheReboundOfItsMaterial) {
    for (int seed = 0; seed < test::scaled(40); ++seed) {
        SCOPED_TRACE(seed);
        RandomSequence random(static_cast<std::uint64_t>(seed), 17, 0);
        const double slope = 0.003 + 0.02 * random.uniform();  // slope of the upper wall
        const Vec3 upper = normalized(Vec3{-slope, 0, -1});
        auto setup = setup_of({}, {{"lower", PlaneShape{{}, {0, 0, 1}}}, {"upper", PlaneShape{{}, upper}}}, 0.02, 2.0);
        setup.materials = {{"", 0.6 + 0.35 * random.uniform(), 0.4 * random.uniform()}};
        setup.options.resting_speed = 0.05;
        setup.forces.push_back(make_gravity(kG * random.unit_vector()));
        for (int k = 0; k < 8; ++k) {
            const double x = -0.5 - random.uniform();
            const double radius = k % 2 == 0 ? 0.0 : 0.2 * slope * std::fabs(x);
            const Vec3 velocity = 3.0 * random.uniform() * random.unit_vector();
            setup.particles.push_back(particle_of({x, random.uniform(), 0.5 * slope * std::fabs(x)}, velocity, radius));
        }
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        EXPECT_EQ(simulation.statistics().violations, 0U);
        EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
