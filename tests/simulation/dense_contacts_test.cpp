#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::mesh_collider;
using testing::particle_of;
using testing::setup_of;

constexpr double kRadius = 0.005;

/// Returns spheres of 5 mm in a box of 12 radii, open above.
SimulationSetup box_setup(double duration, PairMethod method) {
    Material rough{"", 0.5, 0.5};
    SimulationSetup setup = setup_of(1e-3, duration, rough, {0, 0, -9.81});
    const double side = 12.0 * kRadius;
    setup.colliders = {mesh_collider(testing::flipped(testing::box_mesh({0, 0, 0}, {side, side, 1.0})))};
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.5, .friction = 0.5, .method = method};
    setup.options.verify = true;
    return setup;
}

void fill_loosely(SimulationSetup& setup, int count) {
    RandomSequence random(1, 0, 0);
    for (int k = 0; k < count; ++k) {
        const double radius = kRadius * (0.8 + 0.4 * random.uniform());
        const double pitch = 3.0 * kRadius;
        const Vec3 place{pitch * (k % 4 + 0.5), pitch * (k / 4 % 4 + 0.5), pitch * (k / 16 + 0.5)};
        Particle particle = particle_of(place + (0.2 * kRadius) * random.unit_vector(), {}, radius);
        particle.mass = 2500.0 * 4.18879020478639 * radius * radius * radius;
        setup.particles.push_back(particle);
    }
}

void advance(Simulation& simulation, int steps) {
    for (int k = 0; k < steps && !simulation.finished(); ++k) simulation.step();
}

// Uses a burst that fits, and one that does not.
TEST(DenseContacts, EmittersSpawnOnlyIntoFreeSpace) {
    for (const std::uint64_t burst : {60U, 4000U}) {
        SimulationSetup setup = box_setup(0.02, PairMethod::automatic);
        EmitterDescription emitter;
        emitter.shape = BoxShape{{6.0 * kRadius, 6.0 * kRadius, 0.2}, {10.0 * kRadius, 10.0 * kRadius, 0.1}};
        emitter.radius = {kRadius, 0.2 * kRadius};
        emitter.burst = burst;
        emitter.rate = {2000.0, 0.0};
        setup.emitters.push_back(emitter);
        Simulation simulation(std::move(setup));
        advance(simulation, 1000);
        EXPECT_GT(simulation.particles().size(), 60U);
        EXPECT_LT(simulation.statistics().overlap_largest, 5e-3) << burst;
        const std::uint64_t refused = simulation.statistics().births_refused_by_overlap;
        EXPECT_TRUE(burst < 1000U || refused > 1000U) << refused;
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
}

TEST(DenseContacts, PouredSpheresSettleInABoxWithHardlyAnyOverlap) {
    SimulationSetup setup = box_setup(0.75, PairMethod::automatic);
    fill_loosely(setup, 96);
    Simulation simulation(std::move(setup));
    advance(simulation, 1000);
    const SimulationStatistics& statistics = simulation.statistics();
    EXPECT_EQ(statistics.violations, 0U);
    EXPECT_EQ(statistics.energy_violations, 0U);
    EXPECT_EQ(statistics.unsimulated_time, 0.0);
    EXPECT_LT(statistics.overlap_largest, 5e-3);
    // Without rolling friction one in fifty may still roll in its hollow.
    const std::vector<Vec3>& velocity = simulation.particles().velocity;
    EXPECT_LE(std::count_if(velocity.begin(), velocity.end(), [](const Vec3& v) { return length(v) > 0.01; }), 2);
}

/// With the method "contacts" the island is dense from the start and does not overlap. With "automatic" it becomes
/// dense in the second step, and the fall of the first step is corrected.
TEST(DenseContacts, ColumnStands) {
    for (const PairMethod method : {PairMethod::contacts, PairMethod::automatic}) {
        SimulationSetup setup = box_setup(0.3, method);
        for (int i = 0; i < 20; ++i) {
            Particle particle = particle_of({0.03, 0.03, kRadius * (2 * i + 1)}, {}, kRadius);
            particle.mass = 1e-3;
            setup.particles.push_back(particle);
        }
        Simulation simulation(std::move(setup));
        const std::vector<Vec3> start = simulation.particles().position;
        advance(simulation, 300);
        for (std::size_t i = 0; i < start.size(); ++i) {
            EXPECT_LT(length(simulation.particles().position[i] - start[i]), 1e-3 * kRadius) << i;
        }
        EXPECT_LT(simulation.statistics().overlap_largest, method == PairMethod::contacts ? 1e-3 : 5e-3);
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
}

/// A heavy sphere drives a light one at rest onto a floor. The floor is farther away than the light sphere's own
/// motion.
TEST(DenseContacts, SpherePushedBeyondItsOwnMotionFindsTheFloor) {
    SimulationSetup setup = box_setup(0.05, PairMethod::contacts);
    Particle light = particle_of({0.03, 0.03, 1.3 * kRadius}, {}, kRadius);
    light.mass = 1e-3;
    Particle heavy = particle_of({0.03, 0.03, 3.32 * kRadius}, {0, 0, -2}, kRadius);
    heavy.mass = 1.0;
    setup.particles = {light, heavy};
    Simulation simulation(std::move(setup));
    advance(simulation, 50);
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-3);
    EXPECT_EQ(simulation.statistics().violations, 0U);
}

/// Returns a gas in a closed box with packing 0.15. In each step a third of the spheres collide.
SimulationSetup gas_setup() {
    SimulationSetup setup = setup_of(0.01, 1.0);
    setup.colliders = {mesh_collider(testing::flipped(testing::box_mesh({0, 0, 0}, {1, 1, 1})))};
    setup.options.particle_contacts = PairContactSettings{.method = PairMethod::contacts};
    RandomSequence random(5, 0, 0);
    for (int k = 0; k < 216; ++k) {
        const Vec3 place{(k % 6 + 0.5) / 6.0, (k / 6 % 6 + 0.5) / 6.0, (k / 36 + 0.5) / 6.0};
        setup.particles.push_back(particle_of(place, random.unit_vector(), 0.055));
    }
    return setup;
}

double kinetic_energy(const Simulation& simulation) {
    double sum = 0.0;
    for (const Vec3& v : simulation.particles().velocity) sum += 0.5 * length_squared(v);
    return sum;
}

TEST(DenseContacts, ElasticGasKeepsItsEnergy) {
    Simulation simulation(gas_setup());
    const double before = kinetic_energy(simulation);
    advance(simulation, 100);
    EXPECT_NEAR(kinetic_energy(simulation), before, 1e-12 * before);
    EXPECT_GT(simulation.statistics().pair_impacts, 500U);
    EXPECT_EQ(simulation.statistics().unsolved_steps, 0U);
}

TEST(DenseContacts, BitsDoNotDependOnThreadsOrResume) {
    const auto made = [] {
        SimulationSetup setup = box_setup(0.3, PairMethod::automatic);
        fill_loosely(setup, 96);
        return setup;
    };
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        Simulation simulation(made());
        advance(simulation, 300);
        hashes.push_back(simulation.state_hash());
    }
    Simulation first(made());
    advance(first, 200);
    std::vector<std::byte> bytes;
    first.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    Simulation resumed(made());
    std::size_t at = 0;
    resumed.restore([&](std::span<std::byte> part) {
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
    advance(resumed, 100);
    hashes.push_back(resumed.state_hash());
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}

/// Returns the energy over the mass, in J/kg.
double energy_of(const Particles& p, std::size_t i) {
    return 0.5 * length_squared(p.velocity[i]) + 9.81 * p.position[i].z;
}

// Two touching spheres swing through the bottom like one, with the error of the step. Every straight line along the
// wall leads into it.
TEST(DenseContacts, TouchingSpheresSwingInAHollowSphereAndInAMeshOfIt) {
    for (const double time_step : {1e-3, 2.5e-4}) {
        SimulationSetup setup = setup_of(time_step, 0.6, {"", 0.0}, {0, 0, -9.81});
        setup.options.particle_contacts = PairContactSettings{.restitution = 0.0};
        setup.options.verify = true;
        setup.colliders = {{"bowl", BallShape{0.5, {}}}};
        const double center_path = 0.46;
        const double between = 2.0 * std::asin(0.04 / center_path) * (1.0 + 1e-13);
        for (const double angle : {1.0, 1.0 + between}) {
            setup.particles.push_back(
                particle_of({-center_path * std::sin(angle), 0.0, -center_path * std::cos(angle)}, {}, 0.04));
        }
        Simulation simulation(std::move(setup));
        const double before = energy_of(simulation.particles(), 0) + energy_of(simulation.particles(), 1);
        double highest = 0.0;
        while (!simulation.finished()) {
            simulation.step();
            highest = std::max(highest, simulation.particles().position[0].x);
        }
        const double after = energy_of(simulation.particles(), 0) + energy_of(simulation.particles(), 1);
        EXPECT_GT(highest, 0.2);  // on the other side
        EXPECT_LT(after, before + 1e-6);
        EXPECT_GT(after, before - 40.0 * time_step);
        EXPECT_EQ(simulation.statistics().violations, 0U);
        EXPECT_LT(simulation.statistics().overlap_largest, 1e-3);
    }
}

TEST(DenseContacts, PouredSpheresSettleInAnAnalyticCylinder) {
    SimulationSetup setup = setup_of(2e-3, 0.6, {"", 0.3, 0.4}, {0, 0, -9.81});
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.3, .friction = 0.4};
    setup.colliders = {{"silo", CylinderShape{0.1, 4.0, {{0, 0, 2}}}}};
    for (int k = 0; k < 60; ++k) {
        const double turn = 1.1 * k;
        setup.particles.push_back(
            particle_of({0.05 * std::cos(turn), 0.05 * std::sin(turn), 0.03 + 0.022 * k}, {}, 0.02));
    }
    Simulation simulation(std::move(setup));
    advance(simulation, 1000);
    EXPECT_LT(simulation.statistics().overlap_largest, 0.01);
    EXPECT_EQ(simulation.statistics().violations, 0U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
