// Overlapping spheres separate without gaining a significant speed, for any time step. A removed sphere overlaps
// nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kGravity = 9.81;

SimulationSetup on_a_floor(double time_step, double duration) {
    SimulationSetup setup = setup_of(time_step, duration, {"", 0.0, 0.5}, {0, 0, -kGravity});
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}}};
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.0, .friction = 0.5};
    return setup;
}

/// Returns kinetic plus potential energy, in J.
double energy_of(const Simulation& simulation) {
    const Particles& particles = simulation.particles();
    double energy = 0.0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double speed = length(particles.velocity[i]);
        const double turning = particles.radius[i] * length(particles.spin[i]);
        energy +=
            particles.mass[i] * (0.5 * speed * speed + 0.2 * turning * turning + kGravity * particles.position[i].z);
    }
    return energy;
}

void run(Simulation& simulation) {
    while (!simulation.finished()) simulation.step();
}

// Separation lifts the second and the third layer by 0.1 and 0.2 radii: 2.7 m g r in all. A speed of v = 0.2 sqrt(g r)
// between neighbours leaves them with v and 2 v upward, 0.9 m g r. The outer spheres keep v to each side, 0.72 m g r.
TEST(DenseOverlaps, OverlappingPackingExpandsWithoutBeingThrown) {
    constexpr double kRadius = 0.005;
    constexpr double kMass = 1e-3;
    for (const double time_step : {1e-3, 1e-4}) {
        SCOPED_TRACE(time_step);
        SimulationSetup setup = on_a_floor(time_step, 0.1);
        for (int k = 0; k < 27; ++k) {
            const double spacing = 0.95 * 2.0 * kRadius;
            setup.particles.push_back(
                particle_of({spacing * (k % 3), spacing * (k / 3 % 3), kRadius + spacing * (k / 9)}, {}, kRadius));
            setup.particles.back().mass = kMass;
        }
        Simulation simulation(std::move(setup));
        const double before = energy_of(simulation);
        run(simulation);
        EXPECT_LT(energy_of(simulation), before + (2.7 + 0.9 + 0.72) * kMass * kGravity * kRadius);
        for (const Vec3& velocity : simulation.particles().velocity) EXPECT_LT(length(velocity), 0.5);
    }
}

TEST(DenseOverlaps, SeparationSpeedDoesNotDependOnTheStep) {
    constexpr double kRadius = 0.1;
    std::vector<double> heights;
    for (const double time_step : {1e-3, 1e-4, 2e-5}) {
        SimulationSetup setup = on_a_floor(time_step, 0.15);
        setup.particles.push_back(particle_of({0, 0, kRadius}, {}, kRadius));
        setup.particles.push_back(particle_of({0, 0, 2.6 * kRadius}, {}, kRadius));
        Simulation simulation(std::move(setup));
        run(simulation);
        heights.push_back(simulation.particles().position[1].z);
        EXPECT_LT(length(simulation.particles().velocity[1]), 0.21 * std::sqrt(kGravity * kRadius)) << time_step;
    }
    EXPECT_GT(heights[0], 2.65 * kRadius);
    EXPECT_NEAR(heights[1], heights[2], 1e-3 * kRadius);
    EXPECT_NEAR(heights[0], heights[2], 1e-2 * kRadius);
}

TEST(DenseOverlaps, ExpiredSphereOverlapsNothing) {
    SimulationSetup setup = setup_of(0.01, 0.05, {"", 1.0, 0.0}, {});
    setup.options.particle_contacts = PairContactSettings{};
    setup.particles.push_back(particle_of({0, 0, 0}, {}, 0.1));
    setup.particles.back().lifetime = 0.021;
    setup.particles.push_back(particle_of({0.65, 0, 0}, {-20, 0, 0}, 0.1));  // would touch at 0.0225 s
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_EQ(simulation.statistics().expired, 1U);
    EXPECT_EQ(simulation.statistics().pair_impacts, 0U);
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-12);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
