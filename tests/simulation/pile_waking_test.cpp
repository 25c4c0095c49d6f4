// Sleeping neighbours that are hit and pushed wake in the same step, and momentum is conserved.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kRadius = 0.1;

double momentum_along_x(const Simulation& simulation) {
    const Particles& p = simulation.particles();
    double sum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) sum += p.mass[i] * p.velocity[i].x;
    return sum;
}

/// Returns touching spheres of 1 kg, n by m of them from the origin, on a smooth floor.
SimulationSetup layer_setup(int n, int m, double duration, const PairContactSettings& contacts) {
    SimulationSetup setup = setup_of(2e-3, duration, {"", 0.3, 0.0}, {0, 0, -9.81});
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}}};
    setup.options.particle_contacts = contacts;
    for (int i = 0; i < n; ++i) {
        for (int k = 0; k < m; ++k)
            setup.particles.push_back(particle_of({2 * kRadius * i, 2 * kRadius * k, kRadius}, {}, kRadius));
    }
    return setup;
}

TEST(PileWaking, SleepingLayerTakesTheMomentumOfAnImpact) {
    for (const PairMethod method : {PairMethod::automatic, PairMethod::contacts}) {
        SCOPED_TRACE(static_cast<int>(method));
        SimulationSetup setup = layer_setup(8, 8, 0.6, {.restitution = 0.3, .method = method});
        Particle fast = particle_of({-5.3, 7 * kRadius, kRadius}, {10, 0, 0}, kRadius);
        fast.mass = 5.0;
        setup.particles.push_back(fast);
        Simulation simulation(std::move(setup));
        std::uint64_t asleep = 0;
        while (!simulation.finished()) {
            simulation.step();
            asleep = std::max(asleep, simulation.statistics().asleep);
            ASSERT_NEAR(momentum_along_x(simulation), 50.0, 1e-10) << simulation.time();
        }
        EXPECT_GE(asleep, 64U);
        // Rows beside the hit ones are only grazed, without an impulse.
        EXPECT_LE(simulation.statistics().asleep, 24U);
    }
}

TEST(PileWaking, SleepingRowWithoutWeightConservesMomentum) {
    SimulationSetup setup = setup_of(1e-3, 0.6);
    setup.options.particle_contacts = PairContactSettings{.method = PairMethod::contacts};
    setup.particles = {particle_of({-1, 0, 0}, {2, 0, 0}, kRadius)};
    for (int i = 0; i < 5; ++i) setup.particles.push_back(particle_of({2 * kRadius * i, 0, 0}, {}, kRadius));
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_NEAR(momentum_along_x(simulation), 2.0, 1e-12);
}

// The sphere is slower than a fall of 1 % of a radius.
TEST(PileWaking, SlowSphereMovesASleepingPair) {
    SimulationSetup setup = layer_setup(2, 1, 3.0, {.restitution = 0.3});
    setup.particles.push_back(particle_of({-2.5 * kRadius, 0, kRadius}, {0.05, 0, 0}, kRadius));
    setup.particles.back().position.x -= 0.05;
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_NEAR(momentum_along_x(simulation), 0.05, 1e-12);
    EXPECT_GT(simulation.particles().velocity[1].x, 0.01);
}

TEST(PileWaking, SpheresOnAFloorReboundWithTheirRestitution) {
    for (const double e : {0.0, 0.5, 1.0}) {
        SCOPED_TRACE("restitution " + std::to_string(e));
        SimulationSetup setup = layer_setup(1, 1, 0.5, {.restitution = e, .method = PairMethod::contacts});
        setup.particles.push_back(particle_of({-0.6, 0, kRadius}, {2, 0, 0}, kRadius));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        EXPECT_NEAR(simulation.particles().velocity[0].x, 1.0 + e, 1e-8);
        EXPECT_NEAR(simulation.particles().velocity[1].x, 1.0 - e, 1e-8);
    }
}

TEST(PileWaking, PileFallsWhenItsLowestSphereExpires) {
    SimulationSetup setup = setup_of(2e-3, 0.5, {"", 0.3, 0.4}, {0, 0, -9.81});
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.3, .friction = 0.3};
    setup.options.verify = true;
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}}};
    for (const double z : {0.1, 0.301, 0.502}) setup.particles.push_back(particle_of({0, 0, z}, {}, 0.099));
    setup.particles[0].lifetime = 0.2;
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    ASSERT_EQ(simulation.particles().size(), 2U);
    EXPECT_NEAR(simulation.particles().position[0].z, 0.099, 1e-4);
    EXPECT_NEAR(simulation.particles().position[1].z, 0.297, 1e-4);
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-3);
}

/// Returns a layer of ten by ten in a bin, and one of nine by nine in its hollows.
SimulationSetup bed_setup(double duration) {
    SimulationSetup setup = setup_of(1e-3, duration, {"", 0.3, 0.5}, {0, 0, -9.81});
    const double side = 20 * kRadius;
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}},
                       {"left", PlaneShape{{0, 0, 0}, {1, 0, 0}}},
                       {"right", PlaneShape{{side, 0, 0}, {-1, 0, 0}}},
                       {"front", PlaneShape{{0, 0, 0}, {0, 1, 0}}},
                       {"back", PlaneShape{{0, side, 0}, {0, -1, 0}}}};
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.3, .friction = 0.5};
    setup.options.verify = true;
    for (int layer = 0; layer < 2; ++layer) {
        for (int i = 0; i < 10 - layer; ++i) {
            for (int k = 0; k < 10 - layer; ++k) {
                const Vec3 place{2.0 * i + 1.0 + layer, 2.0 * k + 1.0 + layer, 1.0 + 1.4142135623730951 * layer};
                setup.particles.push_back(particle_of(kRadius * place, {}, kRadius));
            }
        }
    }
    return setup;
}

/// Returns the missing upward momentum, in N s: impulses on the colliders plus momentum of the spheres, minus the
/// impulse of gravity.
double momentum_missing(const Simulation& simulation) {
    const Particles& p = simulation.particles();
    double sum = 0.0;
    for (std::size_t i = 0; i < p.size(); ++i) sum += p.mass[i] * (p.velocity[i].z + 9.81 * simulation.time());
    for (std::size_t c = 0; c < 5; ++c) {
        for (const Vec3& impulse : simulation.triangle_totals(c).impulse) sum += impulse.z;
    }
    return sum;
}

TEST(PileWaking, ImpactOnAPileWakesOnlyTheSpheresNearIt) {
    SimulationSetup setup = bed_setup(2.0);
    const std::uint64_t bed = setup.particles.size();
    setup.particles.push_back(particle_of({10.3 * kRadius, 9.8 * kRadius, 0.5}, {}, kRadius));
    Simulation simulation(std::move(setup));
    std::uint64_t most = 0;
    std::uint64_t least = bed;  // smallest number asleep since the whole bed slept
    while (!simulation.finished()) {
        simulation.step();
        const std::uint64_t asleep = simulation.statistics().asleep;
        most = std::max(most, asleep);
        if (most >= bed) least = std::min(least, asleep);
    }
    EXPECT_GE(most, bed);
    EXPECT_LT(least, bed - 5);
    EXPECT_GT(least, bed / 2);
    EXPECT_EQ(simulation.statistics().asleep, bed + 1);
    EXPECT_NEAR(momentum_missing(simulation), 0.0, 1e-9 * 9.81 * 2.0 * static_cast<double>(bed));
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
    EXPECT_LT(simulation.statistics().overlap_largest, 1e-3);
}

/// Returns spheres of 4.3 to 5.7 mm that fall into a bin of one layer, and others that drip onto them one by one.
SimulationSetup dripping_setup(std::uint64_t seed) {
    SimulationSetup setup = setup_of(1e-3, 2.5, {"", 0.2, 0.4}, {0, 0, -9.81});
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}},
                       {"left", PlaneShape{{-0.02, 0, 0}, {1, 0, 0}}},
                       {"right", PlaneShape{{0.02, 0, 0}, {-1, 0, 0}}},
                       {"front", PlaneShape{{0, -0.006, 0}, {0, 1, 0}}},
                       {"back", PlaneShape{{0, 0.006, 0}, {0, -1, 0}}}};
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.2, .friction = 0.4};
    setup.options.verify = true;
    EmitterDescription first;
    first.name = "first";
    first.seed = seed;
    first.shape = BoxShape{{0, 0, 0.12}, {0.028, 1e-4, 0.2}};
    first.burst = 20;
    first.mass = {1e-3, 0.0};
    first.radius = {0.005, 0.0007};
    EmitterDescription later = first;
    later.name = "later";
    later.seed = seed + 1000;
    later.shape = BoxShape{{0, 0, 0.2}, {0.03, 1e-4, 0.01}};
    later.burst = 0;
    later.rate = {30.0, 0.0};
    later.start = 0.8;
    later.radius = {0.005, 0.0};
    setup.emitters = {first, later};
    return setup;
}

// Smooth walls support no weight, even if spheres have woken and fallen asleep again.
TEST(PileWaking, FloorOfASmoothBinSupportsAllSleepers) {
    std::uint64_t most = 0;
    for (const std::uint64_t seed : {1U, 10U, 13U, 14U, 19U, 30U}) {
        SCOPED_TRACE(seed);
        SimulationSetup setup = dripping_setup(seed);
        setup.materials[0].friction = 0.0;
        setup.emitters[1].limit = 30;
        setup.options.duration = 3.5;
        Simulation simulation(std::move(setup));
        const auto on_floor = [&] { return simulation.triangle_totals(0).impulse[0].z; };
        while (simulation.time() < 3.0) simulation.step();
        const double before = on_floor();
        const double begin = simulation.time();
        most = std::max(most, simulation.statistics().asleep);
        while (!simulation.finished()) simulation.step();
        const double weight = 9.81e-3 * static_cast<double>(simulation.particles().size());
        EXPECT_NEAR((on_floor() - before) / (begin - simulation.time()), weight, 1e-3 * weight);
    }
    EXPECT_GT(most, 20U);
}

// A sphere between a sleeper and a wall cannot separate, and each dripping sphere would drive it in deeper.
TEST(PileWaking, SphereDrivenIntoASleeperWakesIt) {
    for (const std::uint64_t seed : {20U, 45U, 85U, 106U}) {
        Simulation simulation(dripping_setup(seed));
        while (!simulation.finished()) simulation.step();
        EXPECT_LT(simulation.statistics().overlap_largest, 4e-3) << seed;
        EXPECT_EQ(simulation.statistics().pair_violations, 0U) << seed;
    }
}

// The upper spheres are supported by sleepers around them, or fall with the woken ones below.
TEST(PileWaking, SpheresWithoutSupportFall) {
    SimulationSetup setup = bed_setup(1.5);
    const std::size_t bed = setup.particles.size();
    for (std::size_t i = 0; i < 100; ++i) setup.particles[i].lifetime = 0.6;  // the whole lower layer
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    const Particles& p = simulation.particles();
    ASSERT_EQ(p.size(), bed - 100);
    for (std::size_t i = 0; i < p.size(); ++i) EXPECT_LT(p.position[i].z, 1.001 * kRadius) << i;
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
