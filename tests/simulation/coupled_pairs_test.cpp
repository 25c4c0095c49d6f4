// Colliding spheres that also interact at a distance: by forces between particles or by springs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/pair_forces.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kRadius = 0.1;

Particle sphere(const Vec3& position, const Vec3& velocity, double mass, double radius = kRadius) {
    Particle particle = particle_of(position, velocity, radius);
    particle.mass = mass;
    return particle;
}

SimulationSetup scene_of(double time_step, double duration, const PairContactSettings& contacts,
                         IntegratorKind kind = IntegratorKind::velocity_verlet) {
    SimulationSetup setup = setup_of(time_step, duration);
    setup.options.particle_contacts = contacts;
    setup.options.integrator = kind;
    return setup;
}

Simulation run(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

Vec3 momentum_of(const Particles& p) {
    Vec3 sum;
    for (std::size_t i = 0; i < p.size(); ++i) sum += p.mass[i] * p.velocity[i];
    return sum;
}

Vec3 angular_momentum_of(const Particles& p) {
    Vec3 sum;
    for (std::size_t i = 0; i < p.size(); ++i) {
        const double inertia = 0.4 * p.mass[i] * p.radius[i] * p.radius[i];
        sum += p.mass[i] * cross(p.position[i], p.velocity[i]) + inertia * p.spin[i];
    }
    return sum;
}

double energy_of(const Simulation& simulation) {
    return simulation.kinetic_energy() + simulation.potential_energy().value();
}

double distance_of_first_two(const Particles& p) { return length(p.position[1] - p.position[0]); }

ParticlesForceEntry gravity(double constant) {
    GravitySettings settings;
    settings.constant = constant;
    return {make_mutual_gravity(settings)};
}

const std::vector<IntegratorKind>& explicit_kinds() {
    static const std::vector<IntegratorKind> kinds = {IntegratorKind::velocity_verlet, IntegratorKind::ballistic,
                                                      IntegratorKind::midpoint,        IntegratorKind::rk4,
                                                      IntegratorKind::dormand_prince,  IntegratorKind::symplectic_euler,
                                                      IntegratorKind::forward_euler};
    return kinds;
}

// Closed forms of two particles.

constexpr double kFrom = 1.0;  // m, between the centres at the start of a fall
constexpr double kPull = 3.0;  // m^3/s^2, G times both masses

/// Returns the time, in s, of two spheres that fall onto each other from rest: a degenerate Kepler ellipse.
double time_of_fall() {
    const double part = 2.0 * kRadius / kFrom;
    const double angle = std::acos(std::sqrt(part)) + std::sqrt(part * (1.0 - part));
    return std::sqrt(kFrom * kFrom * kFrom / (2.0 * kPull)) * angle;
}

/// Returns two spheres that fall onto each other and rebound to their initial positions.
SimulationSetup falling_pair(double steps, IntegratorKind kind) {
    const double period = 2.0 * time_of_fall();
    SimulationSetup setup = scene_of(period / steps, period, {}, kind);
    setup.particles = {sphere({0, 0, 0}, {}, 1.0), sphere({kFrom, 0, 0}, {}, 2.0)};
    setup.particles_forces.push_back(gravity(kPull / 3.0));
    return setup;
}

TEST(CoupledPairs, PairThatFallsByGravityReturnsAfterKeplersPeriodToSecondOrder) {
    for (const IntegratorKind kind :
         {IntegratorKind::velocity_verlet, IntegratorKind::ballistic, IntegratorKind::midpoint, IntegratorKind::rk4}) {
        SCOPED_TRACE(name_of(kind));
        std::vector<double> errors;
        for (const int steps : {400, 1600}) {
            const Simulation simulation = run(falling_pair(steps, kind));
            EXPECT_EQ(simulation.statistics().pair_impacts, 1U);
            EXPECT_LT(length(momentum_of(simulation.particles())), 1e-12);
            const double off = std::fabs(distance_of_first_two(simulation.particles()) - kFrom);
            errors.push_back(off + std::fabs(energy_of(simulation) + 2.0 * kPull / 3.0 / kFrom));
        }
        EXPECT_LT(errors[0], 2e-2);
        EXPECT_GT(errors[0] / errors[1], 14.0);  // 16 for second order
    }
}

/// The impact falls into every eighth of a step, not only at its end.
TEST(CoupledPairs, FallingPairKeepsItsEnergyForAnyTimeOfImpactInAStep) {
    struct Case {
        IntegratorKind kind;
        double largest;  // from the table in docs/design/coupled-particles.md, at 200 steps per period
    };
    const double energy = -2.0 * kPull / 3.0 / kFrom;
    for (const Case& c : {Case{IntegratorKind::velocity_verlet, 8.0e-3}, Case{IntegratorKind::midpoint, 1.9e-2},
                          Case{IntegratorKind::rk4, 1.6e-2}, Case{IntegratorKind::symplectic_euler, 7.7e-1},
                          Case{IntegratorKind::forward_euler, 2.9e-1}, Case{IntegratorKind::dormand_prince, 1.5e-2}}) {
        double largest = 0.0;
        for (int k = 0; k < 8; ++k) {
            const Simulation simulation = run(falling_pair(200.0 + 0.25 * k, c.kind));
            EXPECT_GE(simulation.statistics().pair_impacts, 1U);
            largest = std::max(largest, std::fabs(energy_of(simulation) / energy - 1.0));
        }
        EXPECT_NEAR(largest / c.largest, 1.0, 0.05) << name_of(c.kind);
    }
}

/// The pair is bound in the well and rebounds at negative potential energy.
TEST(CoupledPairs, PairInALennardJonesWellKeepsItsEnergyToSecondOrder) {
    std::vector<double> errors;
    for (const double time_step : {4e-3, 1e-3}) {
        SimulationSetup setup = scene_of(time_step, 4.0, {});
        setup.particles = {sphere({0, 0, 0}, {}, 1.0), sphere({0.3, 0.01, 0}, {0.1, 0, 0}, 2.0)};
        setup.particles_forces.push_back({make_lennard_jones({.depth = 1.0, .diameter = 0.17, .cutoff = 4.0})});
        Simulation simulation(std::move(setup));
        const double before = energy_of(simulation);
        const Vec3 momentum = momentum_of(simulation.particles());
        double worst = 0.0;
        while (!simulation.finished()) {
            simulation.step();
            worst = std::max(worst, std::fabs(energy_of(simulation) - before));
        }
        EXPECT_GT(simulation.statistics().pair_impacts, 5U);
        EXPECT_LT(length(momentum_of(simulation.particles()) - momentum), 1e-12);
        errors.push_back(worst);
    }
    EXPECT_LT(errors[1], 2e-3);
    EXPECT_GT(errors[0] / errors[1], 12.0);
}

TEST(CoupledPairs, MomentumIsConservedWithEveryIntegratorFrictionAndLosses) {
    for (const IntegratorKind kind : explicit_kinds()) {
        for (const double restitution : {1.0, 0.4}) {
            SCOPED_TRACE(std::string(name_of(kind)) + ", restitution " + std::to_string(restitution));
            SimulationSetup setup = scene_of(2e-3, 1.5, {.restitution = restitution, .friction = 0.3}, kind);
            setup.particles = {sphere({0, 0, 0}, {0.3, 0.2, 0.1}, 1.0), sphere({0.6, 0.05, 0}, {0, 0, -0.2}, 2.0),
                               sphere({0.2, 0.5, 0.1}, {0, -0.1, 0}, 0.5)};
            setup.particles_forces.push_back(gravity(0.5));
            setup.springs = {{0, 2, 0.2, 20.0, 0.1}};
            const Vec3 expected = Vec3{0.3, 0.2, 0.1} + 2.0 * Vec3{0, 0, -0.2} + 0.5 * Vec3{0, -0.1, 0};
            const Simulation simulation = run(std::move(setup));
            EXPECT_GT(simulation.statistics().pair_impacts, 3U);
            EXPECT_LT(length(momentum_of(simulation.particles()) - expected), 1e-12);
        }
    }
}

// Pressing contact.

TEST(CoupledPairs, PairPressedByASpringComesToRestInContact) {
    for (const IntegratorKind kind : {IntegratorKind::velocity_verlet, IntegratorKind::rk4}) {
        SimulationSetup setup = scene_of(2e-3, 2.0, {.restitution = 0.5}, kind);
        setup.particles = {sphere({0, 0, 0}, {}, 1.0), sphere({0.4, 0, 0}, {}, 2.0)};
        setup.springs = {{0, 1, 0.1, 100.0, 0.0}};
        const Simulation simulation = run(std::move(setup));
        EXPECT_NEAR(distance_of_first_two(simulation.particles()), 2.0 * kRadius, 1e-12);
        EXPECT_LT(simulation.kinetic_energy(), 1e-20);
        EXPECT_NEAR(simulation.potential_energy().value(), 0.5 * 100.0 * 0.1 * 0.1, 1e-9);
        EXPECT_LT(length(momentum_of(simulation.particles())), 1e-13);
    }
}

/// If the velocities included the forces of the step's end, the rotation would decay by half of h times the pull over
/// the distance. That is nine tenths of it here.
TEST(CoupledPairs, PairPressedByGravityKeepsRotating) {
    SimulationSetup setup = scene_of(2e-3, 6.0, {.restitution = 0.5});
    setup.particles = {sphere({0, 0, 0}, {0, 0.1, 0}, 1.0), sphere({kFrom, 0, 0}, {0, -0.05, 0}, 2.0)};
    setup.particles_forces.push_back(gravity(1.0));
    Simulation simulation(std::move(setup));
    const double before = angular_momentum_of(simulation.particles()).z;
    while (!simulation.finished()) simulation.step();
    EXPECT_NEAR(angular_momentum_of(simulation.particles()).z, before, 5e-3 * std::fabs(before));
    EXPECT_NEAR(distance_of_first_two(simulation.particles()), 2.0 * kRadius, 1e-4 * kRadius);
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-3);
}

/// A pile forms by its own gravity, and one sphere flies by. The impulses on the pile come from the sphere.
TEST(CoupledPairs, PileAndPassingSphereConserveMomentum) {
    SimulationSetup setup = scene_of(2e-3, 0.8, {.restitution = 0.3, .friction = 0.5});
    RandomSequence random(3, 1, 0);
    for (int k = 0; k < 27; ++k) {
        const Vec3 place{0.24 * (k % 3), 0.24 * (k / 3 % 3), 0.24 * (k / 9)};
        setup.particles.push_back(sphere(place + 0.015 * random.unit_vector(), {}, 1.0));
    }
    setup.particles.push_back(sphere({2.0, 0.3, 0.2}, {-1.0, 1.5, 0.0}, 20.0));
    setup.particles_forces.push_back(gravity(0.05));
    Simulation simulation(std::move(setup));
    const Vec3 before = momentum_of(simulation.particles());
    while (!simulation.finished()) simulation.step();
    EXPECT_LT(length(momentum_of(simulation.particles()) - before), 1e-12 * length(before));
    EXPECT_GT(simulation.statistics().pair_impacts, 20U);
    EXPECT_LT(simulation.statistics().overlap_largest, 5e-3);
    EXPECT_EQ(simulation.statistics().unsolved_steps, 0U);
}

/// Returns the mean height, in m, of the centres of a block of grains that was released on a floor.
double height_of_heap(double stiffness) {
    constexpr double kGrain = 0.005;
    SimulationSetup setup = setup_of(5e-4, 0.4, {"", 0.2, 0.4}, {0, 0, -9.81});
    setup.options.integrator = IntegratorKind::velocity_verlet;
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.2, .friction = 0.4};
    setup.options.verify = true;
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}});
    RandomSequence random(5, 1, 0);
    for (int k = 0; k < 45; ++k) {
        const Vec3 place = (2.04 * kGrain) * Vec3{k % 3 - 1.0, k / 3 % 3 - 1.0, k / 9 + 0.5};
        setup.particles.push_back(sphere(place + (0.015 * kGrain) * random.unit_vector(), {}, 1.3e-3, kGrain));
    }
    if (stiffness > 0.0) {
        setup.particles_forces.push_back({make_cohesion({.stiffness = stiffness, .range = 1e-3, .damping = 0.05})});
    }
    const Simulation simulation = run(std::move(setup));
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
    EXPECT_LT(simulation.statistics().overlap_largest, 5e-3);
    double sum = 0.0;
    for (const Vec3& x : simulation.particles().position) sum += x.z / 45.0;
    return sum;
}

TEST(CoupledPairs, CohesiveGrainsFormSteeperHeapsThanLooseOnes) {
    const double loose = height_of_heap(0.0);
    const double sticky = height_of_heap(600.0);
    EXPECT_LT(loose, 0.016);
    EXPECT_GT(sticky, 1.3 * loose);
}

// Cloth.

/// Returns spheres that fall onto a sheet fixed at two of its sides.
SimulationSetup spheres_on_cloth(double restitution) {
    SimulationSetup setup = setup_of(5e-4, 0.3, {}, {0, 0, -9.81});
    setup.options.integrator = IntegratorKind::velocity_verlet;
    setup.options.particle_contacts = PairContactSettings{.restitution = restitution, .friction = 0.0};
    constexpr int kSide = 9;
    constexpr double kCell = 0.05;
    const auto id = [](int i, int j) { return static_cast<std::uint64_t>(j * kSide + i); };
    for (int j = 0; j < kSide; ++j) {
        for (int i = 0; i < kSide; ++i) {
            Particle node = sphere({kCell * (i - 4), kCell * (j - 4), 0.0}, {}, 1e-3, 0.02);
            node.pinned = i == 0 || i == kSide - 1;
            setup.particles.push_back(node);
            if (i > 0) setup.springs.push_back({id(i - 1, j), id(i, j), kCell, 80.0, 0.0});
            if (j > 0) setup.springs.push_back({id(i, j - 1), id(i, j), kCell, 80.0, 0.0});
        }
    }
    setup.particles.push_back(sphere({0.01, 0.02, 0.1}, {0, 0, -1}, 0.01, 0.05));
    setup.particles.push_back(sphere({0.03, -0.09, 0.13}, {0, 0, -1}, 0.005, 0.04));
    return setup;
}

double energy_on_cloth(const Simulation& simulation) {
    return simulation.kinetic_energy() + simulation.potential_energy().value();
}

TEST(CoupledPairs, SpheresOnClothGainNoEnergyAndDoNotOverlap) {
    for (const double restitution : {1.0, 0.3}) {
        SCOPED_TRACE("restitution " + std::to_string(restitution));
        SimulationSetup setup = spheres_on_cloth(restitution);
        setup.options.verify = true;
        Simulation simulation(std::move(setup));
        const double before = energy_on_cloth(simulation);
        const double moving = simulation.kinetic_energy();
        double most = before;
        while (!simulation.finished()) {
            simulation.step();
            most = std::max(most, energy_on_cloth(simulation));
        }
        EXPECT_GT(simulation.statistics().pair_impacts, 10U);
        EXPECT_LT(most - before, 0.01 * moving);
        EXPECT_LT(simulation.statistics().overlap_largest, 5e-3);
        EXPECT_EQ(simulation.statistics().violations, 0U);
        EXPECT_EQ(simulation.statistics().energy_violations, 0U);
        EXPECT_EQ(simulation.statistics().pair_violations, 0U);
        if (restitution == 1.0) {
            EXPECT_GT(energy_on_cloth(simulation), before - 0.05 * moving);
        }
    }
}

// Invalid combinations.

TEST(CoupledPairs, SettingsWithoutExplicitStepsAreRefusedInOneLine) {
    const auto expect_refused = [](const char* words, const auto& change) {
        SimulationSetup setup = falling_pair(10, IntegratorKind::velocity_verlet);
        setup.particles_forces.clear();
        change(setup);
        try {
            const Simulation simulation(std::move(setup));
            ADD_FAILURE() << "taken: " << words;
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_NE(message.find(words), std::string::npos) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    };
    expect_refused("integrator: found implicit_euler", [](SimulationSetup& setup) {
        setup.springs = {{0, 1, 0.5, 1.0, 0.0}};
        setup.options.integrator = IntegratorKind::implicit_euler;
    });
    expect_refused("method: found events", [](SimulationSetup& setup) {
        setup.springs = {{0, 1, 0.5, 1.0, 0.0}};
        setup.options.particle_contacts->method = PairMethod::events;
    });
    expect_refused("springs: found one between spheres 0 and 1, which stand", [](SimulationSetup& setup) {
        setup.springs = {{0, 1, 0.5, 1.0, 0.0}};
        setup.particles[1].position.x = 0.1;
    });
    expect_refused("solver: found one of the program's own",
                   [](SimulationSetup& setup) { setup.solver = [](ParticleSystem&, double) {}; });
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
