// Steps in which spheres collide first, and press on each other later. Their impacts must stay as they were.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kGravity = 9.81;
constexpr double kRadius = 0.03;

/// Returns a setup of spheres that meet each other on a level table with friction.
SimulationSetup table_setup(double time_step, double duration, const PairContactSettings& contacts, double restitution,
                            double friction) {
    Material table;
    table.restitution = restitution;
    table.friction = friction;
    SimulationSetup setup = setup_of(time_step, duration, table, {0, 0, -kGravity});
    setup.colliders.push_back({"table", PlaneShape{{0, 0, 0}, {0, 0, 1}}});
    setup.options.particle_contacts = contacts;
    return setup;
}

Simulation run(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

double kinetic_energy(const Particles& p) {
    double sum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) {
        sum += 0.5 * p.mass[i] *
               (length_squared(p.velocity[i]) + 0.4 * p.radius[i] * p.radius[i] * length_squared(p.spin[i]));
    }
    return sum;
}

// A ball rolls at 3 m/s into two that touch each other. Its velocity goes to the last one. The first keeps its spin, so
// friction drives it into the second: this contact lasts. The last ball slides until it rolls with 5/7 of its speed.
TEST(ImpactsBeforeContact, ARollingBallMovesTheLastOfARow) {
    constexpr double kFriction = 0.2;
    for (const double step : {1.0 / 30.0, 1.0 / 60.0, 1.0 / 240.0, 0.001}) {
        for (const double gap : {0.0, 1e-6}) {
            SCOPED_TRACE("step " + std::to_string(step) + ", gap " + std::to_string(gap));
            SimulationSetup setup = table_setup(step, 0.3, {.restitution = 1.0}, 0.5, kFriction);
            setup.particles = {particle_of({-0.3, 0, kRadius}, {3, 0, 0}, kRadius, {0, 100, 0}),
                               particle_of({0, 0, kRadius}, {}, kRadius),
                               particle_of({2 * kRadius + gap, 0, kRadius}, {}, kRadius)};
            const Simulation simulation = run(std::move(setup));
            const double hit = (0.3 - 2 * kRadius + gap) / 3.0;
            const double last = 3.0 - kFriction * kGravity * (0.3 - hit);
            EXPECT_NEAR(simulation.particles().velocity[2].x, last, 2e-5);
            EXPECT_LT(std::fabs(simulation.particles().velocity[0].x), 0.5);
        }
    }
}

// The balls of a row lie apart by at most a micrometre, so all impacts happen in one step. Afterwards the spins of the
// balls press some of them together.
TEST(ImpactsBeforeContact, ARowOnARoughTableReleasesOneBallForOne) {
    for (const double step : {1.0 / 30.0, 1.0 / 120.0, 0.001}) {
        for (const double friction : {0.0, 0.05, 0.5}) {
            SCOPED_TRACE("step " + std::to_string(step) + ", friction " + std::to_string(friction));
            SimulationSetup setup = table_setup(step, 0.1, {.restitution = 1.0}, 0.5, friction);
            for (int k = 0; k < 5; ++k) {
                setup.particles.push_back(particle_of({k * (2 * kRadius + 1e-6), 0, kRadius}, {}, kRadius));
            }
            setup.particles[0] = particle_of({-0.05, 0, kRadius}, {1, 0, 0}, kRadius, {0, 1 / kRadius, 0});
            const Simulation simulation = run(std::move(setup));
            const Particles& p = simulation.particles();
            const double sliding = 1.0 - friction * kGravity * (0.1 - 0.05);
            EXPECT_NEAR(p.velocity[4].x, std::max(sliding, 5.0 / 7.0), 1e-4);
            EXPECT_LT(p.velocity[3].x, 0.3);
        }
    }
}

// A cue ball with topspin breaks a rack of ten. The method `events` with short steps is the reference.
TEST(ImpactsBeforeContact, ABreakKeepsTheEnergyOfItsSingleImpacts) {
    const auto break_at = [](double step, PairMethod method, std::uint64_t seed) {
        SimulationSetup setup =
            table_setup(step, 0.1, {.restitution = 0.95, .friction = 0.06, .method = method}, 0.5, 0.2);
        RandomSequence random(seed, 0, 0);
        const auto jitter = [&] { return 1e-6 * random.uniform(); };
        setup.particles.push_back(
            particle_of({0.02 * (random.uniform() - 0.5), -0.2, kRadius}, {0, 6, 0}, kRadius, {-200, 0, 0}));
        for (int row = 0; row < 4; ++row) {
            for (int k = 0; k <= row; ++k) {
                const double x = (2 * kRadius + 2e-6) * (k - 0.5 * row) + jitter();
                const double y = (2 * kRadius + 2e-6) * std::sqrt(0.75) * row + jitter();
                setup.particles.push_back(particle_of({x, y, kRadius}, {}, kRadius));
            }
        }
        return kinetic_energy(run(std::move(setup)).particles());
    };
    const int racks = test::scaled(3) * test::case_factor(100);
    for (int seed = 0; seed < racks; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        const auto number = static_cast<std::uint64_t>(seed);
        const double reference = break_at(0.001, PairMethod::events, number);
        for (const double step : {1.0 / 30.0, 1.0 / 60.0, 0.001}) {
            EXPECT_NEAR(break_at(step, PairMethod::automatic, number) / reference, 1.0, 0.01) << step;
        }
    }
}

// Two elastic spheres before a wall. The number of impacts gives the digits of pi (G. Galperin, "Playing pool with pi",
// Regular and Chaotic Dynamics 8, 2003): 3141 for a mass ratio of 10^6, of which every second one is on the wall.
TEST(ImpactsBeforeContact, TwoUnlikeMassesBeforeAWallMakeTheImpactsOfPi) {
    SimulationSetup setup = setup_of(0.05, 40.0);
    setup.colliders.push_back({"wall", PlaneShape{{0, 0, 0}, {1, 0, 0}}});
    setup.options.particle_contacts = PairContactSettings{.restitution = 1.0};
    setup.particles = {particle_of({1, 0, 0}, {}, 0.1), particle_of({2, 0, 0}, {-1, 0, 0}, 0.1)};
    setup.particles[1].mass = 1e6;
    const Simulation simulation = run(std::move(setup));
    EXPECT_EQ(simulation.statistics().pair_impacts + simulation.statistics().contacts, 3141U);
    EXPECT_NEAR(kinetic_energy(simulation.particles()) / 5e5, 1.0, 1e-9);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
}

// A ball falls onto two that lie on a table and touch each other. It rebounds in the step in which it would come to
// press on them.
TEST(ImpactsBeforeContact, ABallOnTwoRestingOnesReboundsAtAnyStep) {
    const auto height_at = [](double step) {
        SimulationSetup setup = table_setup(step, 0.2, {.restitution = 0.8, .method = PairMethod::automatic}, 0.8, 0.0);
        setup.particles = {particle_of({-kRadius, 0, kRadius}, {}, kRadius),
                           particle_of({kRadius, 0, kRadius}, {}, kRadius),
                           particle_of({0, 0, 0.2}, {0, 0, -2}, kRadius)};
        return run(std::move(setup)).particles().position[2].z;
    };
    const double fine = height_at(0.001);
    for (const double step : {1.0 / 30.0, 1.0 / 60.0, 1.0 / 240.0}) EXPECT_NEAR(height_at(step), fine, 1e-3) << step;
}

// A pebble rolls beside a stone, which lands on it and presses it onto the table. The pebble slips along the stone
// meanwhile, far more than the two part. Their contact lasts nevertheless.
TEST(ImpactsBeforeContact, ASlippingPairThatIsPressedTogetherIsPlanned) {
    SimulationSetup setup = table_setup(2.9e-4, 5.8e-4, {.restitution = 0.3, .friction = 0.4}, 0.3, 0.4);
    setup.materials[0].rolling_friction = 0.08;
    setup.colliders[0].shape = PlaneShape{{0, 0, 0.02781112}, {0, 0, 1}};
    setup.particles = {
        particle_of({-0.011686844839981711, 0.007546579484554943, 0.028315335271536145},
                    {0.004990423582775065, 0.01495401573776237, 0.0}, 0.0005042152715360878,
                    {-27.694483155034913, 10.392711290727481, 37.68975030824293}),
        particle_of({-0.010884708599714308, 0.005700564803915004, 0.029844060419758123},
                    {-0.06038190538577723, 0.0009175170938948481, 0.015258550999596282}, 0.0020228606068750424,
                    {-9.560923951023373, -21.073868312883032, -43.89483459668792})};
    const Simulation simulation = run(std::move(setup));
    EXPECT_GT(simulation.statistics().pair_impacts, 0U);
    EXPECT_LT(simulation.statistics().bounces_per_step_max, 10U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
