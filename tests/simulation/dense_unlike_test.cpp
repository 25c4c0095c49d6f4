// Spheres of very different radii that press on each other. A light sphere between heavy ones, or between one and a
// floor, is not pressed into them. Nothing gains energy.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::setup_of;

constexpr double kGravity = 9.81;
constexpr double kSmall = 1e-3;  // m

Particle ball(const Vec3& position, const Vec3& velocity, double radius) {
    Particle particle = testing::particle_of(position, velocity, radius);
    particle.mass = 1000.0 * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    return particle;
}

SimulationSetup setup_with(double time_step, double duration, double restitution, double friction, bool falls) {
    const Vec3 gravity = falls ? Vec3{0, 0, -kGravity} : Vec3{};
    SimulationSetup setup = setup_of(time_step, duration, {"", restitution, friction}, gravity);
    if (falls) setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}}};
    setup.options.particle_contacts = PairContactSettings{.restitution = restitution, .friction = friction};
    setup.options.verify = true;
    return setup;
}

/// Returns kinetic plus potential energy, in J.
double energy_of(const Simulation& simulation, double gravity) {
    const Particles& particles = simulation.particles();
    double energy = 0.0;
    for (std::size_t i = 0; i < particles.size(); ++i) {
        const double turning = particles.radius[i] * length(particles.spin[i]);
        energy += particles.mass[i] * (0.5 * length_squared(particles.velocity[i]) + 0.2 * turning * turning +
                                       gravity * particles.position[i].z);
    }
    return energy;
}

void expect_no_overlap(const Simulation& simulation) {
    EXPECT_LT(simulation.statistics().overlap_largest, 5e-3);
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
}

// The big ball falls two small radii onto 25 small ones, and rebounds with at most a fifth of its speed. Dense islands
// are of first order: their velocities have an error of g dt.
TEST(DenseUnlike, BigBallIsSupportedBySmallOnesAtAnyStep) {
    for (const double step : {2e-3, 1e-4}) {
        SCOPED_TRACE(step);
        SimulationSetup setup = setup_with(step, 0.1, 0.2, 0.3, true);
        for (int i = -2; i <= 2; ++i) {
            for (int j = -2; j <= 2; ++j)
                setup.particles.push_back(ball({0.02 * i, 0.02 * j, kSmall * (1.0 + 1e-6)}, {}, kSmall));
        }
        const double big = 100.0 * kSmall;
        setup.particles.push_back(ball({0, 0, big + 4.0 * kSmall}, {}, big));
        Simulation simulation(std::move(setup));
        double highest = 0.0;
        while (!simulation.finished()) {
            simulation.step();
            if (simulation.time() > 0.03) highest = std::max(highest, simulation.particles().position.back().z);
        }
        expect_no_overlap(simulation);
        const double rebound = 0.2 * std::sqrt(2.0 * kGravity * 2.0 * kSmall) + kGravity * step;
        EXPECT_LT(highest - big, 2.0 * kSmall + rebound * rebound / (2.0 * kGravity));
        EXPECT_GT(simulation.particles().position.back().z - big, 2.0 * kSmall * (1.0 - 5e-3));
    }
}

// Two spheres of 1 m/s collide with a light one between them, slightly off-centre, and friction pinches it. All energy
// may be lost and none gained, and momentum is conserved.
TEST(DenseUnlike, PinchedSphereOverlapsNoBigBall) {
    for (const double ratio : {10.0, 100.0, 1000.0}) {
        for (const double step : {1e-4, 2e-3}) {
            for (const double restitution : {0.0, 0.5}) {
                SCOPED_TRACE(std::to_string(ratio) + " " + std::to_string(step) + " " + std::to_string(restitution));
                SimulationSetup setup = setup_with(step, 0.05, restitution, 0.5, false);
                const double big = ratio * kSmall;
                setup.particles = {ball({-big - 4.0 * kSmall, 0, 0}, {1, 0, 0}, big),
                                   ball({big + 4.0 * kSmall, 0, 0}, {-1, 0, 0}, big),
                                   ball({0, 0.3 * kSmall, 0}, {}, kSmall)};
                const double mass = setup.particles[0].mass;
                Simulation simulation(std::move(setup));
                double energy = energy_of(simulation, 0.0);
                Vec3 momentum;
                while (!simulation.finished()) {
                    simulation.step();
                    EXPECT_LE(energy_of(simulation, 0.0), energy * (1.0 + 1e-12));
                    energy = energy_of(simulation, 0.0);
                }
                for (std::size_t i = 0; i < 3; ++i)
                    momentum += simulation.particles().mass[i] * simulation.particles().velocity[i];
                EXPECT_LT(length(momentum), 1e-12 * mass);
                expect_no_overlap(simulation);
            }
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
