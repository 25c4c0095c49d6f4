// Steps of dormand_prince end even if no substep is short enough, and lost time is counted.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

/// Returns a particle at rest that falls into the centre.
SimulationSetup falling(std::unique_ptr<Force> force, ResponseKind response) {
    SimulationSetup setup = setup_of(1.0 / 60.0, 1.0);
    setup.options.integrator.kind = IntegratorKind::dormand_prince;
    setup.options.response = response;
    setup.forces.push_back(std::move(force));
    setup.particles = {particle_of({0.03, -0.16, 0.26})};
    return setup;
}

/// Runs to the end, or until the particle exceeds the speed of light. Returns false in that case.
bool run(Simulation& simulation) {
    try {
        while (!simulation.finished()) simulation.step();
    } catch (const DivergedError&) {
        return false;
    }
    return true;
}

TEST(AdaptiveSteps, StepsEndWhenAParticleFallsIntoAPointMass) {
    for (const ResponseKind response : {ResponseKind::exact, ResponseKind::rollback, ResponseKind::project}) {
        SCOPED_TRACE(name_of(response));
        Simulation gravity(falling(make_point_gravity({{{0, 0, 0}, 8.85, 0.0}}), response));
        (void)run(gravity);
        EXPECT_GT(gravity.statistics().coarse_steps, 0U);
        for (const double exponent : {-1.0, -2.0, -3.0}) {
            SCOPED_TRACE(exponent);
            Simulation radial(
                falling(make_radial_force({.center = {}, .strength = 8.85, .exponent = exponent}), response));
            const bool is_whole = run(radial);
            EXPECT_TRUE(!is_whole || radial.statistics().coarse_steps + radial.statistics().budget_exhausted > 0U);
        }
    }
}

// A step has 8000 orbits of 2e-6 s, each of about 50 substeps.
TEST(AdaptiveSteps, StepsOfATightOrbitAreCutOffAndTheParticleStaysOnIt) {
    const double strength = 10.0;
    const double radius = 1e-4;
    for (const ResponseKind response : {ResponseKind::exact, ResponseKind::rollback, ResponseKind::project}) {
        SCOPED_TRACE(name_of(response));
        SimulationSetup setup = falling(make_point_gravity({{{0, 0, 0}, strength, 0.0}}), response);
        setup.options.duration = setup.options.time_step;
        setup.particles = {particle_of({radius, 0, 0}, {0, std::sqrt(strength / radius), 0})};
        Simulation simulation(std::move(setup));
        simulation.step();
        EXPECT_EQ(simulation.statistics().budget_exhausted, 1U);
        EXPECT_GT(simulation.statistics().unsimulated_time, 0.0);
        EXPECT_LT(simulation.statistics().unsimulated_time, 1.0 / 60.0);
        EXPECT_NEAR(length(simulation.particles().position[0]), radius, 0.2 * radius);
    }
}

TEST(AdaptiveSteps, StepsEndWhenTwoParticlesFallIntoEachOther) {
    SimulationSetup setup = setup_of(1.0 / 60.0, 0.5);
    setup.options.integrator.kind = IntegratorKind::dormand_prince;
    setup.particles = {particle_of({}), particle_of({0.1, 0.2, -0.1})};
    GravitySettings gravity;
    gravity.constant = 1.0;
    setup.particles_forces = {{make_mutual_gravity(gravity)}};
    Simulation simulation(std::move(setup));
    const bool is_whole = run(simulation);
    EXPECT_TRUE(!is_whole || simulation.statistics().unsolved_steps > 0U);
}

TEST(AdaptiveSteps, OrdinaryOrbitLosesNothing) {
    SimulationSetup setup = falling(make_point_gravity({{{0, 0, 0}, 1.0, 0.0}}), ResponseKind::exact);
    setup.options.duration = 20.0;
    setup.particles = {particle_of({1, 0, 0}, {0, 0.3, 0})};
    Simulation simulation(std::move(setup));
    const double before = simulation.kinetic_energy() + simulation.potential_energy().value();
    ASSERT_TRUE(run(simulation));
    EXPECT_EQ(simulation.statistics().coarse_steps, 0U);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
    EXPECT_NEAR(simulation.kinetic_energy() + simulation.potential_energy().value(), before, 1e-3);
}

// The substeps pass a jump of a force accurately, and no time is unsimulated.
TEST(AdaptiveSteps, StepsPassAJumpOfAForce) {
    SimulationSetup setup = setup_of(0.1, 1.0);
    setup.options.integrator = {IntegratorKind::dormand_prince, {1e-30, 1e-30}};
    setup.forces.push_back(make_acceleration([](const ForceInput& input) {
        return Vec3{input.position.x < 0.55 ? 0.0 : 2.0, 0, 0};
    }));
    setup.particles = {particle_of({}, {1, 0, 0})};
    Simulation simulation(std::move(setup));
    ASSERT_TRUE(run(simulation));
    EXPECT_NEAR(simulation.particles().velocity[0].x, 1.9, 1e-9);
    EXPECT_NEAR(simulation.particles().position[0].x, 1.0 + 0.45 * 0.45, 1e-9);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
