#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kRadius = 0.005;

/// Returns three spheres in a row on a floor and two on top, which support themselves. A wall on each side holds them.
SimulationSetup pile_setup(double duration) {
    SimulationSetup setup = setup_of(1e-3, duration, {"", 0.3, 0.5}, {0, 0, -9.81});
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}},
                       {"left", PlaneShape{{-3 * kRadius, 0, 0}, {1, 0, 0}}},
                       {"right", PlaneShape{{3 * kRadius, 0, 0}, {-1, 0, 0}}},
                       {"front", PlaneShape{{0, -kRadius, 0}, {0, 1, 0}}},
                       {"back", PlaneShape{{0, kRadius, 0}, {0, -1, 0}}}};
    setup.options.particle_contacts =
        PairContactSettings{.restitution = 0.3, .friction = 0.5, .method = PairMethod::contacts};
    setup.options.verify = true;
    const double up = kRadius * (1.0 + 1.7320508075688772);
    for (const double x : {-2.0, 0.0, 2.0}) setup.particles.push_back(particle_of({x * kRadius, 0, kRadius}));
    for (const double x : {-1.0, 1.0}) setup.particles.push_back(particle_of({x * kRadius, 0, up}));
    for (Particle& particle : setup.particles) {
        particle.radius = kRadius;
        particle.mass = 1e-3;
    }
    return setup;
}

void advance(Simulation& simulation, int steps) {
    for (int k = 0; k < steps && !simulation.finished(); ++k) simulation.step();
}

TEST(PileSleep, PileAtRestSleepsAndStaysToTheLastBit) {
    Simulation simulation(pile_setup(1.0));
    advance(simulation, 100);
    EXPECT_EQ(simulation.statistics().asleep, 5U);
    const std::vector<Vec3> before = simulation.particles().position;
    advance(simulation, 500);
    for (std::size_t i = 0; i < before.size(); ++i) {
        EXPECT_EQ(simulation.particles().position[i], before[i]) << i;
        EXPECT_EQ(simulation.particles().velocity[i], Vec3{}) << i;
    }
    EXPECT_EQ(simulation.statistics().asleep, 5U);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
}

TEST(PileSleep, ImpactWakesThePile) {
    SimulationSetup setup = pile_setup(1.0);
    Particle falling = particle_of({0.1 * kRadius, 0, 0.2}, {}, 0.9 * kRadius);
    falling.mass = 1e-3;
    setup.particles.push_back(falling);
    Simulation simulation(std::move(setup));
    advance(simulation, 180);
    EXPECT_EQ(simulation.statistics().asleep, 5U);
    const Vec3 before = simulation.particles().position[3];
    advance(simulation, 30);  // the sphere falls for 0.192 s
    EXPECT_LT(simulation.statistics().asleep, 5U);
    EXPECT_GT(length(simulation.particles().position[3] - before), 0.0);
    EXPECT_EQ(simulation.statistics().violations, 0U);
}

TEST(PileSleep, LossOfASupportWakesThePile) {
    Simulation simulation(pile_setup(1.0));
    advance(simulation, 100);
    ASSERT_EQ(simulation.statistics().asleep, 5U);
    ASSERT_TRUE(simulation.remove_particle(simulation.particles().id[0]));
    advance(simulation, 60);
    EXPECT_LT(simulation.particles().position[2].z, 0.9 * kRadius * 2.7320508075688772);
}

TEST(PileSleep, OtherForcesWakeThePile) {
    Simulation simulation(pile_setup(1.0));
    advance(simulation, 100);
    ASSERT_EQ(simulation.statistics().asleep, 5U);
    std::vector<std::unique_ptr<Force>> up;
    up.push_back(make_gravity({0, 0, 1.0}));
    simulation.set_forces(std::move(up));
    advance(simulation, 100);
    for (const Vec3& velocity : simulation.particles().velocity) EXPECT_NEAR(velocity.z, 0.1, 1e-3);
}

TEST(PileSleep, BitsDoNotDependOnSleepingOrResume) {
    std::vector<std::uint64_t> hashes;
    const auto made = [](bool sleeping) {
        SimulationSetup setup = pile_setup(0.4);
        Particle falling = particle_of({0.1 * kRadius, 0, 0.2}, {}, 0.9 * kRadius);
        falling.mass = 1e-3;
        setup.particles.push_back(falling);
        setup.acceleration.sleeping = sleeping;
        return setup;
    };
    for (const bool sleeping : {true, false}) {
        Simulation simulation(made(sleeping));
        advance(simulation, 400);
        hashes.push_back(simulation.state_hash());
    }
    for (const int threads : {1, 7}) {
        const ThreadLimit limit(threads);
        Simulation first(made(true));
        advance(first, 150);
        EXPECT_EQ(first.statistics().asleep, 5U);
        std::vector<std::byte> bytes;
        first.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
        Simulation resumed(made(true));
        std::size_t at = 0;
        resumed.restore([&](std::span<std::byte> part) {
            std::memcpy(part.data(), bytes.data() + at, part.size());
            at += part.size();
        });
        advance(resumed, 250);
        hashes.push_back(resumed.state_hash());
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}

// Without friction, three balls on a floor roll apart under a fourth, for any time step.
TEST(PileSleep, ParticleThatBeginsToMoveNeverFallsAsleep) {
    for (const double time_step : {1e-3, 5e-5}) {
        SimulationSetup setup = setup_of(time_step, 0.25, {"", 0.0, 0.9}, {0, 0, -9.81});
        setup.options.particle_contacts = PairContactSettings{.restitution = 0.0};
        setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}}};
        const double radius = 0.1;
        for (int k = 0; k < 3; ++k) {
            const double turn = 2.0 * 3.14159265358979 / 3.0 * k;
            const double away = 2.0 * radius / std::sqrt(3.0);
            setup.particles.push_back(particle_of({away * std::cos(turn), away * std::sin(turn), radius}, {}, radius));
        }
        setup.particles.push_back(particle_of({0, 0, radius * (1.0 + std::sqrt(8.0 / 3.0))}, {}, radius));
        Simulation simulation(std::move(setup));
        advance(simulation, 100000);
        EXPECT_EQ(simulation.statistics().asleep, 0U) << time_step;
        EXPECT_LT(simulation.particles().position[3].z, 0.24) << time_step;
    }
}

/// Returns the impulse on all colliders, in N s.
Vec3 given_to_colliders(const Simulation& simulation, std::size_t colliders) {
    Vec3 sum;
    for (std::size_t c = 0; c < colliders; ++c) {
        for (const Vec3& impulse : simulation.triangle_totals(c).impulse) sum += impulse;
    }
    return sum;
}

Vec3 momentum_of(const Simulation& simulation) {
    const Particles& particles = simulation.particles();
    Vec3 sum;
    for (std::size_t i = 0; i < particles.size(); ++i) sum += particles.mass[i] * particles.velocity[i];
    return sum;
}

// Without rolling friction, some spheres keep rolling on sleeping ones.
TEST(PileSleep, WeightOfRollingSpheresReachesTheFloorThroughSleepers) {
    SimulationSetup setup = setup_of(1e-3, 10.0, {"", 0.3, 0.5}, {0, 0, -9.81});
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}},
                       {"left", PlaneShape{{-0.03, 0, 0}, {1, 0, 0}}},
                       {"right", PlaneShape{{0.03, 0, 0}, {-1, 0, 0}}},
                       {"front", PlaneShape{{0, -0.03, 0}, {0, 1, 0}}},
                       {"back", PlaneShape{{0, 0.03, 0}, {0, -1, 0}}}};
    setup.options.particle_contacts =
        PairContactSettings{.restitution = 0.3, .friction = 0.5, .method = PairMethod::contacts};
    RandomSequence random(11, 3, 0);
    double weight = 0.0;  // N
    for (int k = 0; k < 100; ++k) {
        const double radius = kRadius * (0.8 + 0.4 * random.uniform());
        const Vec3 place{0.0125 * (k % 4 - 1.5), 0.0125 * (k / 4 % 4 - 1.5), 0.007 + 0.0125 * (k / 16)};
        setup.particles.push_back(particle_of(place + 5e-5 * random.unit_vector(), {}, radius));
        setup.particles.back().mass = 1e4 * radius * radius * radius;
        weight += 9.81 * setup.particles.back().mass;
    }
    Simulation simulation(std::move(setup));
    std::uint64_t together = 0;  // number of steps with both sleeping and moving spheres
    for (int part = 0; part < 30; ++part) {
        const Vec3 given = given_to_colliders(simulation, 5);
        const Vec3 before = momentum_of(simulation);
        const std::uint64_t asleep = simulation.statistics().asleep;
        advance(simulation, 50);
        if (asleep > 0 && simulation.statistics().asleep < 100) together += 50;
        const double time = 0.05;
        const Vec3 missing =
            given_to_colliders(simulation, 5) - given + momentum_of(simulation) - before + Vec3{0, 0, weight * time};
        EXPECT_LT(length(missing), 1e-7 * weight * time) << part << ", " << asleep << " asleep";
    }
    EXPECT_GT(together, 200U);
    EXPECT_EQ(simulation.statistics().asleep, 100U);
}

// A single sphere sleeps by itself and belongs to no pile.
TEST(PileSleep, SingleSleeperWeighsOnTheFloorUntilItIsHit) {
    for (const PairMethod method : {PairMethod::automatic, PairMethod::contacts, PairMethod::events}) {
        SCOPED_TRACE(static_cast<int>(method));
        for (const Vec3& velocity : {Vec3{2, 0, 0}, Vec3{0, 0, -0.5}}) {
            SimulationSetup setup = setup_of(1e-3, 0.5, {"", 0.3, 0.5}, {0, 0, -9.81});
            setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}}};
            setup.options.particle_contacts =
                PairContactSettings{.restitution = 0.3, .friction = 0.5, .method = method};
            setup.particles.push_back(particle_of({0, 0, kRadius}, {}, kRadius));
            const Vec3 start = velocity.z == 0.0 ? Vec3{-0.5, 0, kRadius} : Vec3{0.1 * kRadius, 0, 0.4};
            setup.particles.push_back(particle_of(start, velocity, kRadius));
            Simulation simulation(std::move(setup));
            const Vec3 before = momentum_of(simulation);
            advance(simulation, 350);
            double mass = 0.0;
            for (const double m : simulation.particles().mass) mass += m;
            const Vec3 missing = given_to_colliders(simulation, 1) + momentum_of(simulation) - before;
            // With the method "events" a sphere that rattles on the other spends its impact budget, and no force acts
            // on it then.
            const double lived = 2.0 * simulation.time() - simulation.statistics().unsimulated_time;
            const double weight = 9.81 * 0.5 * mass * lived;
            EXPECT_LT(length(missing + Vec3{0, 0, weight}), 1e-11 * weight);
            EXPECT_NE(simulation.particles().velocity[0], Vec3{});
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
