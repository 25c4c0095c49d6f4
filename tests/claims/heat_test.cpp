// All kinetic energy that a particle loses at surfaces becomes heat of the particle. Tests cover single impacts,
// friction in contact, moving belts and walls, and simultaneous cooling.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::plane_collider;
using testing::setup_of;

constexpr double kG = 9.81;
constexpr double kHeatCapacity = 450.0;  // in J/(kg K)
constexpr double kStart = 300.0;         // in K

HeatSettings all_of_it() {
    HeatSettings heat;
    heat.specific_heat = kHeatCapacity;
    heat.impact_fraction = 1.0;
    heat.friction_fraction = 1.0;
    return heat;
}

/// Returns a setup with a floor in which only impacts and friction heat particles.
SimulationSetup on_a_floor(double time_step, double duration, const Material& material) {
    SimulationSetup setup = setup_of(time_step, duration, material, {0, 0, -kG});
    setup.colliders.push_back(plane_collider({0, 0, 0}, {0, 0, 1}));
    setup.attributes.push_back({"temperature", 1, {kStart, 0, 0}});
    setup.heat = all_of_it();
    return setup;
}

double temperature(const Simulation& simulation, std::size_t i = 0) {
    return simulation.particles().attributes.value(0, i).x;
}

/// Returns the heat gained by particle i since the start, in J.
double heat_of(const Simulation& simulation, std::size_t i = 0) {
    return simulation.particles().mass[i] * kHeatCapacity * (temperature(simulation, i) - kStart);
}

double mechanical(const Simulation& simulation) {
    return simulation.kinetic_energy() + simulation.potential_energy().value();
}

// After bounce n the ball has lost m g h (1 - e^(2 n)).
TEST(HeatOfImpacts, EqualsTheLossOfRestitutionInEachBounceAtAnyTimeStep) {
    const double e = 0.8;
    for (const double time_step : {1e-3, 1.0 / 60.0, 0.25}) {
        SCOPED_TRACE(time_step);
        SimulationSetup setup = on_a_floor(time_step, 2.5, {"floor", e, 0.0});
        setup.options.record_contacts = true;
        Particle ball = particle_of({0.3, -0.2, 1.0});
        ball.mass = 0.2;
        setup.particles.push_back(ball);
        Simulation simulation(std::move(setup));
        int bounces = 0;
        while (!simulation.finished()) {
            simulation.step();
            bounces += static_cast<int>(simulation.contact_records().size());
            EXPECT_NEAR(heat_of(simulation), 0.2 * kG * (1.0 - std::pow(e, 2.0 * bounces)), 1e-9);
        }
        EXPECT_GE(bounces, 4);
    }
}

TEST(HeatOfImpacts, IsSharedBetweenRestitutionAndFrictionByTheirFractions) {
    // A point hits the floor at (2, 0, -3) m/s. The normal motion loses the energy 9 (1 - e^2) / 2 per unit mass.
    // Friction removes the whole tangential velocity, or mu (1 + e) 3 m/s of it.
    const double e = 0.5;
    const double mu = 0.2;
    const double slip = 2.0 - mu * (1.0 + e) * 3.0;
    const double by_restitution = 4.5 * (1.0 - e * e);
    const double by_friction = 0.5 * (4.0 - slip * slip);
    for (const auto& [impact, friction] : {std::pair(1.0, 0.0), std::pair(0.0, 1.0), std::pair(0.25, 0.5)}) {
        SimulationSetup setup = on_a_floor(0.01, 0.02, {"floor", e, mu});
        setup.forces.clear();
        setup.heat->impact_fraction = impact;
        setup.heat->friction_fraction = friction;
        setup.particles.push_back(particle_of({0, 0, 0.015}, {2, 0, -3}));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        EXPECT_NEAR(heat_of(simulation), impact * by_restitution + friction * by_friction, 1e-9);
    }
}

// The work of friction is mu m g s, with the sliding distance s = v^2 / (2 mu g). It equals the whole kinetic energy
// for any time step. After half the distance, it equals half of the kinetic energy.
TEST(HeatOfFriction, IsTheKineticEnergyOfAParticleThatSlidesToRest) {
    const double mu = 0.3;
    const double v = 2.0;
    const double stop = v / (mu * kG);
    for (const double time_step : {1e-3, 0.05, 1.0}) {
        SCOPED_TRACE(time_step);
        SimulationSetup setup = on_a_floor(time_step, 1.0, {"floor", 0.5, mu});
        setup.particles.push_back(particle_of({0, 0, 0}, {v, 0, 0}));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) {
            simulation.step();
            const double now = std::max(0.0, v - mu * kG * std::min(simulation.time(), stop));
            EXPECT_NEAR(heat_of(simulation), 0.5 * (v * v - now * now), 1e-6);
        }
        EXPECT_NEAR(heat_of(simulation), 2.0, 1e-6);
    }
}

TEST(HeatOfFriction, EqualsTheLossOfASlidingBallUntilItRolls) {
    // In the end the ball rolls at 5/7 v, with 5/7 of its initial energy.
    SimulationSetup setup = on_a_floor(0.01, 1.5, {"floor", 0.5, 0.2});
    setup.particles.push_back(particle_of({0, 0, 0.1}, {2, 0, 0}, 0.1));
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_NEAR(simulation.particles().velocity[0].x, 2.0 * 5.0 / 7.0, 1e-6);
    EXPECT_NEAR(heat_of(simulation), 2.0 * 2.0 / 7.0, 1e-6);
}

// The belt does the work m u^2. Half of this work becomes the particle's kinetic energy, and the other half becomes
// heat.
TEST(HeatOfFriction, OnABeltIsHalfOfItsWork) {
    Material belt{"belt", 0.5, 0.4};
    belt.motion.velocity = {1.5, 0, 0};
    SimulationSetup setup = on_a_floor(0.01, 1.0, belt);
    setup.particles.push_back(particle_of({0, 0, 0}));
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_NEAR(simulation.particles().velocity[0].x, 1.5, 1e-9);
    EXPECT_NEAR(heat_of(simulation), 0.5 * 1.5 * 1.5, 1e-6);
    EXPECT_NEAR(simulation.collider_totals()[0].work, -1.5 * 1.5, 1e-6);
}

/// Returns balls with several radii and spins that are thrown into a box whose walls dissipate energy.
SimulationSetup thrown_balls(double duration) {
    SimulationSetup setup = on_a_floor(0.005, duration, {"wall", 0.6, 0.25});
    setup.colliders.push_back(plane_collider({-1, 0, 0}, {1, 0, 0}));
    setup.colliders.push_back(plane_collider({1, 0, 0}, {-1, 0, 0.2}));
    setup.colliders.push_back(plane_collider({0, -1, 0}, {0, 1, 0}));
    setup.colliders.push_back(plane_collider({0, 1, 0}, {0, -1, 0}));
    for (int k = 0; k < 40; ++k) {
        const double a = 0.7 * k;
        Particle ball = particle_of({0.5 * std::cos(a), 0.5 * std::sin(a), 0.3 + 0.02 * k},
                                    {3.0 * std::sin(2.0 * a), 2.0 * std::cos(3.0 * a), 1.0}, 0.002 * (k % 20),
                                    {20.0 * std::cos(a), 30.0 * std::sin(a), 5.0});
        if (ball.radius == 0.0) ball.spin = {};
        ball.mass = 0.1 + 0.01 * k;
        setup.particles.push_back(ball);
    }
    return setup;
}

TEST(Heat, AndMechanicalEnergyHaveAConstantSum) {
    Simulation simulation(thrown_balls(3.0));
    const double start = mechanical(simulation);
    double last = start;
    while (!simulation.finished()) {
        simulation.step();
        double heat = 0.0;
        for (std::size_t i = 0; i < simulation.particles().size(); ++i) heat += heat_of(simulation, i);
        ASSERT_NEAR(mechanical(simulation) + heat, start, 1e-6 * start) << simulation.time();
        last = mechanical(simulation);
    }
    EXPECT_LT(last, 0.5 * start);
    EXPECT_GT(simulation.statistics().resting, 0U);
}

std::uint64_t bits_of(const Simulation& simulation) {
    std::uint64_t hash = simulation.state_hash();
    for (std::size_t i = 0; i < simulation.particles().size(); ++i) {
        hash = hash * 1099511628211ULL ^ std::bit_cast<std::uint64_t>(temperature(simulation, i));
    }
    return hash;
}

SimulationSetup cooling_balls() {
    SimulationSetup setup = thrown_balls(0.8);
    for (Particle& ball : setup.particles) ball.radius = std::max(ball.radius, 0.002);
    setup.heat->emissivity = 0.7;
    setup.heat->convection = Convection{};
    setup.heat->convection->flow = make_rotation({}, {0, 0, 3});
    return setup;
}

TEST(Heat, HasTheSameBitsForAnyThreadsAccelerationsAndRecords) {
    const auto run = [](int threads, const AccelerationSwitches& switches, bool verify) {
        const ThreadLimit limit(threads);
        SimulationSetup setup = cooling_balls();
        setup.acceleration = switches;
        setup.options.verify = verify;
        Simulation simulation(std::move(setup));
        simulation.advance(1000);
        EXPECT_EQ(simulation.statistics().violations + simulation.statistics().energy_violations, 0U);
        return bits_of(simulation);
    };
    const std::uint64_t expected = run(1, {}, false);
    for (const int threads : {2, 7}) EXPECT_EQ(run(threads, {}, false), expected);
    EXPECT_EQ(run(1, {}, true), expected);
    AccelerationSwitches none;
    none.look_ahead = none.deferred_steps = none.sleeping = none.spatial_order = none.culling = false;
    EXPECT_EQ(run(1, none, false), expected);
}

TEST(Heat, ChangesNoPathIfNoForceDependsOnIt) {
    SimulationSetup without = cooling_balls();
    without.heat.reset();
    Simulation plain(std::move(without));
    Simulation heated(cooling_balls());
    plain.advance(1000);
    heated.advance(1000);
    EXPECT_EQ(plain.state_hash(), heated.state_hash());
    EXPECT_EQ(temperature(plain), kStart);
    EXPECT_NE(temperature(heated), kStart);
}

// A ball at rest in a wind cools by convection with a constant coefficient.
TEST(Heat, FollowsNewtonsLawForABallAtRestInAWind) {
    SimulationSetup setup = setup_of(0.1, 2.0);
    setup.attributes.push_back({"temperature", 1, {900.0, 0, 0}});
    HeatSettings heat;
    heat.specific_heat = kHeatCapacity;
    heat.ambient_temperature = 280.0;
    heat.convection = Convection{};
    heat.convection->flow = make_wind({4, 0, 0});
    setup.heat = heat;
    Particle ball = particle_of({}, {}, 1e-3);
    ball.mass = 3e-5;
    setup.particles.push_back(ball);
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    const double h = heat_transfer_coefficient(*heat.convection, 1e-3, 4.0);
    const double rate = cooling_rates(heat, 3e-5, 1e-3, h).convection;
    EXPECT_NEAR(temperature(simulation), 280.0 + 620.0 * std::exp(-2.0 * rate), 1e-9);
}

TEST(Heat, OnATurntableIsTheTablesWorkMinusTheBallsKineticEnergy) {
    FrameDescription table;
    table.name = "table";
    table.motions.push_back(Spin{{0, 0, 1}, 120.0});
    SimulationSetup setup = on_a_floor(0.01, 1.0, {"top", 0.3, 0.5});
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{table});
    setup.colliders[0].frame = "table";
    setup.particles.push_back(particle_of({0.3, 0, 0.02}, {}, 0.02));
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    const double work = -simulation.collider_totals()[0].work;
    EXPECT_GT(work, 1e-3);
    EXPECT_NEAR(heat_of(simulation) + simulation.kinetic_energy(), work, 1e-4 * work);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
