// Particles in contact with surfaces at rest behave the same with and without colliders that move elsewhere, until such
// a collider reaches them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "claims/moving_scene.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr Vec3 kGravity{0, 0, -9.81};

/// Returns grains that settle on a floor. A blade rotates above part of the floor and sweeps it from time to time.
SimulationSetup swept_floor(bool sleeping, std::uint64_t seed) {
    FrameDescription arm;
    arm.name = "arm";
    arm.translation = {0, 0, 0.12};
    arm.motions = {KeyedRotation{{0, 0, 1}, KeyedCurve<double>({{0.0, 0.0}, {2.0, 0.0}, {4.0, 150.0}, {5.0, 150.0}})}};
    SimulationSetup setup = setup_of(0.02, 4.8, {"felt", 0.2, 0.6}, kGravity);
    setup.materials[0].rolling_friction = 0.2;
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{arm});
    setup.colliders = {{"floor", CuboidShape{{6, 6, 0.2}, {{0, 0, -0.1}}}, 0},
                       {"blade", CuboidShape{{1.6, 0.05, 0.22}, {{0.8, 0, 0}}}, 0, "arm"}};
    setup.acceleration.sleeping = sleeping;
    RandomSequence random(seed, 0, 0);
    for (int k = 0; k < test::scaled(120); ++k) {
        const double radius = k % 3 == 0 ? 0.0 : 0.03;
        setup.particles.push_back(
            particle_of({5.0 * random.uniform() - 2.5, 5.0 * random.uniform() - 2.5, 0.05 + 0.2 * random.uniform()},
                        {0.2, 0.1, 0}, radius));
    }
    return setup;
}

Vec3 given_to_floor(const Simulation& simulation) {
    Vec3 sum;
    for (const Vec3& impulse : simulation.triangle_totals(0).impulse) sum += impulse;
    return sum;
}

TEST(WhatRests, SleepsBesideMovingCollidersUntilOneArrivesWithTheSameBits) {
    for (const std::uint64_t seed : {1U, 2U}) {
        SCOPED_TRACE(seed);
        Simulation asleep(swept_floor(true, seed));
        Simulation awake(swept_floor(false, seed));
        std::uint64_t most = 0;
        while (!asleep.finished()) {
            asleep.step();
            awake.step();
            most = std::max(most, asleep.statistics().asleep);
            ASSERT_EQ(asleep.state_hash(), awake.state_hash()) << "s: " << asleep.time();
        }
        // advance(50) computes steps together. A particle that wakes between two of these steps has no deferred steps
        // to integrate.
        Simulation together(swept_floor(true, seed));
        while (!together.finished()) together.advance(50);
        EXPECT_EQ(together.state_hash(), awake.state_hash());
        EXPECT_GT(most, asleep.particles().size() / 2);
        EXPECT_EQ(awake.statistics().asleep, 0U);
        EXPECT_EQ(asleep.statistics().contacts, awake.statistics().contacts);
        EXPECT_EQ(asleep.statistics().squeezed, 0U);
        // The impulses on the floor include the weight of sleeping particles.
        EXPECT_LT(length(given_to_floor(asleep) - given_to_floor(awake)), 1e-11 * length(given_to_floor(awake)));
    }
}

// With a verifier, particles beside moving colliders do not sleep. A restored state without sleep must contain the load
// that sleeping particles had on the floor before the state was saved.
TEST(WhatRests, LoadsTheFloorAfterItsSleepIsResumedUnderVerification) {
    SimulationSetup verified = swept_floor(true, 1);
    verified.options.verify = true;
    Simulation whole(swept_floor(true, 1));
    Simulation first(swept_floor(true, 1));
    Simulation second(std::move(verified));
    first.advance(160);
    ASSERT_GT(first.statistics().asleep, first.particles().size() / 2);
    std::vector<std::byte> bytes;
    first.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    std::size_t at = 0;
    second.restore([&](std::span<std::byte> part) {
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
    while (!second.finished()) second.step();
    while (!whole.finished()) whole.step();
    EXPECT_EQ(second.state_hash(), whole.state_hash());
    EXPECT_EQ(second.statistics().violations, 0U);
    EXPECT_LT(length(given_to_floor(second) - given_to_floor(whole)), 1e-11 * length(given_to_floor(whole)));
}

// A slanted face at 1 m/s hits the upper half of a sphere on a floor. Both contacts are resolved together, with the
// relative velocity u. At the face, u . n = -e u_before . n. At the floor, u . n has at most this value. The sphere
// leaves along the floor at 1 + e m/s. Sequential impacts would make it bounce between both surfaces at ever smaller
// speeds until it counted as pinched.
TEST(WhatRests, AndIsHitFromAboveReboundsTogetherWithItsSupport) {
    for (const double friction : {0.0, 0.2}) {
        SCOPED_TRACE(friction);
        SimulationSetup setup = setup_of(0.01, 0.1, {"steel", 0.3, friction}, kGravity);
        setup.frames = std::make_shared<const FrameTree>(
            std::vector<FrameDescription>{frame_of("slide", {steady({1, 0, 0})}, {-0.095, 0, 0})});
        const double half = 0.1 * std::sqrt(0.5);
        setup.colliders = {
            {"floor", PlaneShape{{}, {0, 0, 1}}, 0},
            {"block", CuboidShape{{0.2, 2, 0.2}, {{-2.0 * half, 0, 0.1 + 2.0 * half}, {0, 1, 0}, 45.0}}, 0, "slide"}};
        setup.particles.push_back(particle_of({0, 0, 0.1 + 1e-14}, {}, 0.1));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        const SimulationStatistics& statistics = simulation.statistics();
        EXPECT_EQ(statistics.squeezed, 0U);
        EXPECT_EQ(statistics.budget_exhausted, 0U);
        EXPECT_EQ(statistics.unsimulated_time, 0.0);
        EXPECT_LE(statistics.bounces_per_step_max, 2U);
        const Vec3 v = simulation.particles().at(0).velocity;
        EXPECT_NEAR(v.z, 0.0, 1e-12);
        if (friction == 0.0) {
            EXPECT_NEAR(v.x, 1.3, 1e-9);
        } else {
            EXPECT_GT(v.x, 1.0);
        }
    }
}

TEST(WhatSlides, GainsNoEnergyBesideMovingCollidersWithAnyIntegrator) {
    for (const IntegratorKind integrator :
         {IntegratorKind::symplectic_euler, IntegratorKind::implicit_euler, IntegratorKind::forward_euler,
          IntegratorKind::midpoint, IntegratorKind::velocity_verlet}) {
        SCOPED_TRACE(static_cast<int>(integrator));
        SimulationSetup setup =
            setup_of({frame_of("fan", {Spin{{0, 0, 1}, 90.0}}, {5, 0, 0})},
                     {{"bowl", BallShape{1.0, {}}, 0}, {"fan", CuboidShape{{0.2, 0.2, 0.2}, {}}, 0, "fan"}}, 0.01, 2.0);
        setup.options.integrator = integrator;
        setup.materials = {{"smooth", 0.0, 0.0}};
        setup.forces.push_back(make_gravity(kGravity));
        setup.particles = {particle_of({0.9, 0, 0}, {}, 0.05)};
        Simulation simulation(std::move(setup));
        EXPECT_FALSE(all_contacts(simulation).empty());
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
