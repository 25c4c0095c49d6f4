#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
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
constexpr double kG = 9.81;

Particle grain(const Vec3& position, double radius = kRadius) {
    Particle particle = particle_of(position, {}, radius);
    particle.mass = 2500.0 * 4.18879020478639 * radius * radius * radius;
    return particle;
}

SimulationSetup moving_setup(double duration, FrameMotion motion, double friction) {
    SimulationSetup setup = setup_of(1e-3, duration, {"", 0.5, friction}, {0, 0, -kG});
    FrameDescription frame;
    frame.name = "mover";
    frame.motions = {std::move(motion)};
    setup.frames = std::make_shared<const FrameTree>(std::vector<FrameDescription>{frame});
    setup.options.particle_contacts =
        PairContactSettings{.restitution = 0.5, .friction = friction, .method = PairMethod::contacts};
    setup.options.verify = true;
    return setup;
}

KeyedTranslation steady(const Vec3& velocity) { return {KeyedCurve<Vec3>({{0.0, {}}, {8.0, 8.0 * velocity}})}; }

void expect_sound(const Simulation& simulation) {
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_EQ(simulation.statistics().energy_violations, 0U);
    EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
}

void run(Simulation& simulation) {
    while (!simulation.finished()) simulation.step();
}

/// Returns a heap in a rotating drum.
SimulationSetup drum_setup(double duration, int count) {
    SimulationSetup setup = moving_setup(duration, Spin{{0, 1, 0}, 90.0}, 0.5);
    setup.options.particle_contacts->method = PairMethod::automatic;
    CylinderShape shell{0.06, 0.04, {}};
    shell.placement.rotation_axis = {1, 0, 0};
    shell.placement.rotation_degrees = 90.0;
    setup.colliders = {{"shell", shell, 0, "mover"}};
    RandomSequence random(1, 0, 0);
    for (int k = 0; k < count; ++k) {
        const double pitch = 2.6 * kRadius;
        const Vec3 corner{-3.0 * pitch, -pitch, -0.03};
        const Vec3 place = corner + pitch * Vec3{k % 7 + 0.0, k / 7 % 3 + 0.0, k / 21 + 0.0};
        setup.particles.push_back(
            grain(place + 0.1 * kRadius * random.unit_vector(), kRadius * (0.8 + 0.4 * random.uniform())));
    }
    return setup;
}

TEST(DenseAmongMovers, HeapInADrumIsLiftedAndLeaksNothing) {
    Simulation simulation(drum_setup(0.7, 84));
    run(simulation);
    expect_sound(simulation);
    EXPECT_LT(simulation.statistics().overlap_largest, 5e-3);
    double side = 0.0;
    for (const Vec3& position : simulation.particles().position) side += position.x / 84.0;
    EXPECT_LT(side, -0.01);  // about +y by the right-hand rule: the lowest wall moves to -x
}

TEST(DenseAmongMovers, BitsDoNotDependOnTheNumberOfThreads) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        Simulation simulation(drum_setup(0.2, 84));
        run(simulation);
        hashes.push_back(simulation.state_hash());
    }
    EXPECT_EQ(hashes[1], hashes[0]);
    EXPECT_EQ(hashes[2], hashes[0]);
}

/// The column stands on the piston like on a floor, and the piston supports its weight.
TEST(DenseAmongMovers, ColumnRidesOnAPiston) {
    for (const double speed : {0.5, -0.3}) {
        SimulationSetup setup = moving_setup(0.4, steady({0.1, 0, speed}), 0.5);
        setup.colliders = {{"piston", CuboidShape{{0.2, 0.2, 0.02}, {{0, 0, -0.01}}}, 0, "mover"}};
        constexpr int kCount = 5;
        double mass = 0.0;
        for (int k = 0; k < kCount; ++k) {
            Particle particle = grain({0, 0, kRadius * (2 * k + 1)});
            particle.velocity = {0.1, 0, speed};
            mass += particle.mass;
            setup.particles.push_back(particle);
        }
        Simulation simulation(std::move(setup));
        run(simulation);
        expect_sound(simulation);
        for (int k = 0; k < kCount; ++k) {
            const Vec3 expected{0.04, 0.0, 0.4 * speed + kRadius * (2 * k + 1)};
            EXPECT_LT(length(simulation.particles().position[k] - expected), 1e-3 * kRadius) << k << ' ' << speed;
        }
        const ColliderTotals& load = simulation.collider_totals()[0];
        EXPECT_NEAR(load.impulse.z, -0.4 * mass * kG, 1e-3 * mass * kG * 0.4);
        EXPECT_NEAR(load.work, -0.4 * mass * kG * speed, 2e-3 * mass * kG * 0.4);
    }
}

/// A pushing floor is at its initial position at the start, middle and end of the step, and moves up and down by more
/// than a radius in between. A sphere thrown up keeps the initial speed of the floor, 2 pi A over the step.
TEST(DenseAmongMovers, FloorThatOscillatesWithinAStepEntersNoSphere) {
    constexpr double kStep = 1e-3;
    constexpr double kAmplitude = 1.5 * kRadius;
    SimulationSetup setup = moving_setup(kStep, Oscillation{{0, 0, kAmplitude}, 1.0 / kStep, 0.0}, 0.3);
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0, "mover"}};
    for (const int k : {-1, 0, 1}) {
        setup.particles.push_back(grain({0, 2.0 * kRadius * k, kRadius}));
        setup.particles.back().velocity = {0, -1e-6 * k, 0};  // two hits on the middle one: planned together
    }
    Simulation simulation(std::move(setup));
    run(simulation);
    expect_sound(simulation);
    for (const Vec3& position : simulation.particles().position) {
        EXPECT_NEAR(position.z, kRadius + 2.0 * std::numbers::pi * kAmplitude, 1e-9);
    }
}

/// Two spheres side by side across a belt slip on it until they roll, with 2/7 of its speed for any friction. The belt
/// is a moving collider or a moving material.
TEST(DenseAmongMovers, BeltGivesSpheresTwoSeventhsOfItsSpeed) {
    for (const bool by_material : {false, true}) {
        const Vec3 velocity{0.2, 0, 0};
        SimulationSetup setup = moving_setup(0.2, steady(by_material ? Vec3{} : velocity), 0.3);
        setup.options.particle_contacts->friction = 0.0;
        if (by_material) setup.materials[0].motion.velocity = velocity;
        setup.colliders = {{"belt", CuboidShape{{2, 0.2, 0.02}, {{0, 0, -0.01}}}, 0, "mover"}};
        for (const double y : {-kRadius, kRadius}) setup.particles.push_back(grain({0, y, kRadius}));
        Simulation simulation(std::move(setup));
        run(simulation);
        expect_sound(simulation);
        // The spheres slip for 2 v / (7 mu g). Their path at a time t is then u (t - t_slip / 2).
        const double slips = 2.0 * 0.2 / (7.0 * 0.3 * kG);
        for (std::size_t k = 0; k < 2; ++k) {
            EXPECT_NEAR(simulation.particles().velocity[k].x, 0.4 / 7.0, 1e-9);
            EXPECT_NEAR(simulation.particles().position[k].x, 0.4 / 7.0 * (0.2 - 0.5 * slips), 1e-3 * 0.4 / 7.0);
        }
        EXPECT_NEAR(simulation.collider_totals()[0].impulse.x, -2.0 * simulation.particles().mass[0] * 0.4 / 7.0, 1e-9);
    }
}

/// Returns a straight column between plates that close faster than it can separate, or a single sphere.
SimulationSetup pressed_setup(int count) {
    SimulationSetup setup = moving_setup(0.25, steady({0, 0, -0.1}), 0.3);
    const double top = 2.0 * kRadius * count + 0.005;
    setup.colliders = {{"low", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0},
                       {"high", PlaneShape{{0, 0, top}, {0, 0, -1}}, 0, "mover"}};
    for (int k = 0; k < count; ++k) setup.particles.push_back(grain({0, 0, kRadius * (2 * k + 1)}));
    return setup;
}

TEST(DenseAmongMovers, PinchedSphereGetsNoMoreThanTheSpeedOfThePress) {
    Simulation simulation(pressed_setup(1));
    run(simulation);
    EXPECT_GT(simulation.statistics().squeezed, 0U);
    EXPECT_EQ(simulation.statistics().lost_impulses, 0U);
    const double most = simulation.particles().mass[0] * (0.1 + 1e-3 * kG) * 250.0;  // in 250 steps
    for (const std::size_t plate : {0U, 1U}) EXPECT_LT(length(simulation.collider_totals()[plate].impulse), 4.0 * most);
}

/// The spheres of the column overlap, which is counted. They separate by at most 0.01 of a radius per step.
TEST(DenseAmongMovers, ColumnUnderAPressIsNotThrown) {
    Simulation simulation(pressed_setup(5));
    while (!simulation.finished()) {
        simulation.step();
        for (const Vec3& v : simulation.particles().velocity) ASSERT_LT(length(v), 0.5);
    }
    EXPECT_GT(simulation.statistics().unsolved_steps, 0U);
    EXPECT_GT(simulation.statistics().overlap_largest, 0.05);
    EXPECT_EQ(simulation.statistics().violations, 0U);
}

/// A closing press leaves no space for its content. The particles stall, and nothing passes through.
TEST(DenseAmongMovers, PressLetsNothingThrough) {
    SimulationSetup setup = moving_setup(0.25, steady({0, 0, -0.3}), 0.3);
    setup.colliders = {{"anvil", CuboidShape{{0.2, 0.2, 0.02}, {{0, 0, -0.01}}}, 0},
                       {"press", CuboidShape{{0.2, 0.2, 0.02}, {{0, 0, 0.07}}}, 0, "mover"}};
    const double pitch = 2.2 * kRadius;
    for (const Vec3& normal : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{-1, 0, 0}, Vec3{0, -1, 0}}) {
        const Vec3 middle{0.5 * pitch, 0.5 * pitch, 0};
        setup.colliders.push_back({"", PlaneShape{middle - (1.1 * pitch) * normal, normal}, 0});
    }
    for (int k = 0; k < 8; ++k) {
        setup.particles.push_back(grain({pitch * (k % 2), pitch * (k / 2 % 2), kRadius + pitch * (k / 4)}));
    }
    Simulation simulation(std::move(setup));
    run(simulation);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    EXPECT_GT(simulation.statistics().squeezed, 0U);
    EXPECT_EQ(simulation.statistics().lost_impulses, 0U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
