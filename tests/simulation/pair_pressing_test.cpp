// Spheres that forces press on each other before any plan exists: in the air, on a pinned sphere, and from the first
// step.
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kRadius = 0.1;

SimulationSetup two_spheres(double time_step, double duration, const Vec3& first, const Vec3& second,
                            double restitution) {
    SimulationSetup setup = setup_of(time_step, duration, {"", 0.0}, {0, 0, -9.81});
    setup.options.particle_contacts = PairContactSettings{.restitution = restitution};
    setup.particles = {particle_of(first, {}, kRadius), particle_of(second, {}, kRadius)};
    return setup;
}

Simulation run(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

TEST(PairPressing, SphereLiesOnAPinnedOne) {
    SimulationSetup setup = two_spheres(0.01, 2.0, {0, 0, 0}, {0, 0, 2.0 * kRadius}, 0.3);
    setup.particles[0].pinned = true;
    const Simulation simulation = run(std::move(setup));
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-5);
    EXPECT_NEAR(simulation.particles().position[1].z, 2.0 * kRadius, 1e-6);
}

// The sphere leaves when its squared speed over the distance of the centres equals the normal component of gravity.
// That is at two thirds of its initial height.
TEST(PairPressing, SphereSlidesDownAPinnedOneUntilItLeaves) {
    const double begin = 0.2;
    const Vec3 place = 2.0 * kRadius * Vec3{std::sin(begin), 0.0, std::cos(begin)};
    SimulationSetup setup = two_spheres(1e-4, 1.0, {0, 0, 0}, place, 0.3);
    setup.particles[0].pinned = true;
    Simulation simulation(std::move(setup));
    double leaves = 1.0;
    while (!simulation.finished()) {
        simulation.step();
        const Vec3& p = simulation.particles().position[1];
        if (length(p) > 2.0 * kRadius * (1.0 + 1e-5)) break;
        leaves = p.z / length(p);
    }
    EXPECT_NEAR(leaves, std::cos(begin) * 2.0 / 3.0, 0.02);
}

// Drag holds the light sphere back. The common fall is that of both masses with the drag of two spheres.
TEST(PairPressing, HeavyAndLightSphereFallTogetherThroughAir) {
    for (const double time_step : {0.01, 0.001}) {
        SimulationSetup setup = two_spheres(time_step, 2.0, {0, 0, 0}, {0, 0, 2.1 * kRadius}, 0.5);
        setup.particles[0].mass = 0.05;
        setup.particles[1].mass = 5.0;
        setup.forces.push_back(make_linear_drag(1.0));
        const Simulation simulation = run(std::move(setup));
        EXPECT_LT(simulation.statistics().overlap_largest, 1e-2) << time_step;
        const double rate = 2.0 / 5.05;
        const double fall = 9.81 / rate * (1.0 - std::exp(-rate * 2.0));
        EXPECT_NEAR(simulation.particles().velocity[0].z, -fall, 0.02 * fall) << time_step;
        EXPECT_NEAR(simulation.particles().velocity[1].z, -fall, 0.02 * fall) << time_step;
    }
}

TEST(PairPressing, InitiallyTouchingSpheresDoNotFallIntoEachOther) {
    for (const double mass : {1.0, 1e-6}) {
        SimulationSetup setup = two_spheres(0.01, 1.0, {0, 0, kRadius}, {0, 0, 3.0 * kRadius}, 0.0);
        setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}}};
        setup.particles[1].mass = mass;
        const Simulation simulation = run(std::move(setup));
        EXPECT_LT(simulation.statistics().overlap_largest, 1e-3) << mass;
        EXPECT_NEAR(simulation.particles().position[1].z, 3.0 * kRadius, 1e-3 * kRadius) << mass;
    }
}

TEST(PairPressing, ElasticSphereLiesOnOneOnAnInelasticFloor) {
    SimulationSetup setup = two_spheres(0.01, 4.0, {0, 0, kRadius}, {0, 0, 8.0 * kRadius}, 1.0);
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}}};
    const Simulation simulation = run(std::move(setup));
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-2);
    EXPECT_NEAR(simulation.particles().position[1].z, 3.0 * kRadius, 1e-2 * kRadius);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
