// Meshes whose scale changes in time are met where they are, and nothing gets through them.
//
// A long run: many more particles and steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/frame_tree.h"
#include "ricochet/core/parallel.h"
#include "ricochet/geometry/mesh/stretched_motion.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/parity.h"
#include "support/simple_meshes.h"

namespace ricochet::testing {
namespace {

/// A mesh that is scaled, within a frame with some motions, until a time.
MeshShape stretching(const TriangleMesh& mesh, const KeyedCurve<Vec3>& factors, std::vector<FrameMotion> motions,
                     double end) {
    FrameDescription frame;
    frame.name = "frame";
    frame.motions = std::move(motions);
    MeshShape shape{std::make_shared<const TriangleMesh>(mesh), {}, "", {}};
    shape.motion =
        std::make_shared<const MeshMotion>(stretched_motion(mesh.vertices, factors, FrameTree({frame}), 0, 0.0, end));
    return shape;
}

SimulationSetup setup_of(double time_step, double duration, const Material& material) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    setup.options.verify = true;
    setup.options.record_contacts = true;
    setup.materials = {material};
    return setup;
}

void expect_sound(const Simulation& simulation) {
    const SimulationStatistics& statistics = simulation.statistics();
    EXPECT_EQ(statistics.violations, 0U);
    EXPECT_EQ(statistics.energy_violations, 0U);
    EXPECT_EQ(statistics.frozen, 0U);
    EXPECT_EQ(statistics.squeezed, 0U);
    EXPECT_EQ(statistics.unsimulated_time, 0.0);
}

/// Along one axis between walls at -(1 + u t) and 1 + u t, which the ball of a radius meets with its sides,
/// elastically.
struct Bouncer {
    double position;
    double velocity;
    double wall_speed;
    double radius;
    double time = 0.0;
    std::vector<double> hits{};

    /// To the next hit, or to an end.
    void advance(double end) {
        while (time < end) {
            const double side = velocity > 0.0 ? 1.0 : -1.0;
            const double gap = 1.0 + wall_speed * time - radius - side * position;
            const double approach = side * velocity - wall_speed;
            const double wait = approach > 0.0 ? gap / approach : end;
            if (time + wait >= end) {
                position += velocity * (end - time);
                time = end;
                return;
            }
            position += velocity * wait;
            time += wait;
            hits.push_back(time);
            velocity -= 2.0 * side * approach;
        }
    }
};

// Perfectly elastic walls that move change one component at a time: closed forms, three at once.
TEST(AMeshBoxWhoseScaleChanges, ReflectsWhatIsInsideAsItsWallsMove) {
    const Vec3 start{0.2, -0.1, 0.3};
    const Vec3 velocity{2.3, 1.7, -2.9};
    const double end = 3.0;
    for (const Vec3& rate : {Vec3{0.25, 0.25, 0.25}, Vec3{-0.2, -0.2, -0.2}, Vec3{0.3, -0.15, 0.0}}) {
        for (const double radius : {0.0, 0.1}) {
            SCOPED_TRACE(std::to_string(rate.x) + " " + std::to_string(radius));
            SimulationSetup setup = setup_of(0.07, end, {"", 1.0, 0.0});
            const KeyedCurve<Vec3> factors({{0.0, {1, 1, 1}}, {4.0, Vec3{1, 1, 1} + 4.0 * rate}});
            setup.colliders = {{"box", stretching(box_mesh({-1, -1, -1}, {1, 1, 1}), factors, {}, 4.0), 0}};
            Particle particle;
            particle.position = start;
            particle.velocity = velocity;
            particle.radius = radius;
            setup.particles = {particle};
            Simulation simulation(std::move(setup));
            std::vector<double> hits;
            Vec3 given;
            while (!simulation.finished()) {
                simulation.step();
                for (const ContactRecord& record : simulation.contact_records()) {
                    hits.push_back(record.time);
                    given += record.mass * (record.velocity_before - record.velocity_after);
                }
            }
            std::vector<double> expected;
            for (int axis = 0; axis < 3; ++axis) {
                Bouncer bouncer{start[axis], velocity[axis], rate[axis], radius};
                bouncer.advance(end);
                expected.insert(expected.end(), bouncer.hits.begin(), bouncer.hits.end());
                EXPECT_NEAR(simulation.particles().position[0][axis], bouncer.position, 1e-11) << axis;
                EXPECT_NEAR(simulation.particles().velocity[0][axis], bouncer.velocity, 1e-12) << axis;
            }
            std::sort(expected.begin(), expected.end());
            ASSERT_EQ(hits.size(), expected.size());
            ASSERT_GT(hits.size(), 4U);
            for (std::size_t k = 0; k < hits.size(); ++k) EXPECT_NEAR(hits[k], expected[k], 1e-12) << k;
            EXPECT_LT(length(given - simulation.collider_totals()[0].impulse), 1e-12);
            const Vec3 lost = velocity - simulation.particles().velocity[0];
            EXPECT_LT(length(lost - simulation.collider_totals()[0].impulse), 1e-12);
            expect_sound(simulation);
        }
    }
}

/// Squash and stretch, while it tumbles and is carried to and fro.
SimulationSetup squashed_gas(double duration, int count, double radius) {
    SimulationSetup setup = setup_of(0.01, duration, {"", 0.9, 0.3});
    setup.options.record_contacts = false;
    std::vector<CurveKey<Vec3>> keys;
    for (int k = 0; 0.2 * k < duration + 0.2; ++k) {
        const double s = k % 2 == 0 ? 0.8 : 1.25;
        keys.push_back({0.2 * k, {s, 1.0 / s, k % 3 == 0 ? 1.1 : 0.9}});
    }
    setup.colliders = {{"skin",
                        stretching(sphere_mesh({}, 1.0, 2), KeyedCurve<Vec3>(std::move(keys)),
                                   {Oscillation{{0.2, 0, 0.1}, 0.8}, Spin{{1, 2, 3}, 90.0}}, duration + 0.01),
                        0}};
    EmitterDescription emitter;
    emitter.shape = SphereShape{{}, 0.5, false};
    emitter.burst = static_cast<std::uint64_t>(count);
    emitter.speed = {2.0, 1.0};
    emitter.radius = {radius, 0.5 * radius};
    setup.emitters.push_back(std::move(emitter));
    return setup;
}

TEST(AMeshWhoseScaleChanges, KeepsWhatIsInsideWhileItTumbles) {
    const bool is_long = test::is_long_run();
    for (const double radius : {0.0, 0.03}) {
        Simulation simulation(
            squashed_gas(is_long ? 5.0 : 0.5, std::max(20, test::scaled(is_long ? 2000 : 60)), radius));
        int outside = 0;
        while (!simulation.finished()) {
            simulation.step();
            const ParityOracle oracle(*simulation.collider_mesh(0));
            for (const Vec3& p : simulation.particles().position) outside += oracle.inside(p) ? 0 : 1;
        }
        EXPECT_EQ(outside, 0) << radius;
        expect_sound(simulation);
        EXPECT_GT(simulation.statistics().contacts, simulation.statistics().emitted / 2);
    }
}

std::uint64_t hash_of(Simulation simulation) {
    while (!simulation.finished()) simulation.step();
    return simulation.state_hash();
}

/// A mesh that deforms, a box that grows, one at rest and one that spins, in an order; a gas and some rain on them.
SimulationSetup mixed_setup(const std::vector<std::size_t>& order) {
    SimulationSetup setup = squashed_gas(0.4, 150, 0.03);
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    const KeyedCurve<Vec3> growth({{0.0, {1, 1, 1}}, {1.0, {1.5, 1.5, 0.8}}});
    FrameDescription spinning;
    spinning.name = "spinning";
    spinning.translation = {4, 0, 0};
    spinning.motions = {Spin{{0, 1, 0}, 200.0}};
    setup.frames = std::make_shared<const FrameTree>(std::vector{spinning});
    const std::vector<ColliderDescription> all{
        setup.colliders[0],
        {"block", stretching(box_mesh({2, -1, -1}, {3, 1, 0}), growth, {}, 1.0), 0},
        {"floor", PlaneShape{{0, 0, -3}, {0, 0, 1}}, 0},
        {"wheel", CuboidShape{{1, 1, 0.2}, {}}, 0, "spinning"}};
    setup.colliders.clear();
    for (const std::size_t k : order) setup.colliders.push_back(all[k]);
    EmitterDescription rain;
    rain.shape = BoxShape{{3.2, 0, 0.8}, {2.4, 1.6, 0.6}};
    rain.burst = 150;
    rain.speed = {2.0, 0.5};
    rain.direction = {0, 0, -1};
    rain.radius = {0.02, 0.02};
    setup.emitters.push_back(std::move(rain));
    return setup;
}

TEST(MeshesThatDeformAndStretch, EndInTheSameBitsWhateverTheOrderOfCollidersAndTheThreads) {
    const std::vector<std::size_t> order{0, 1, 2, 3};
    const std::uint64_t expected = hash_of(Simulation(mixed_setup(order)));
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        EXPECT_EQ(hash_of(Simulation(mixed_setup(order))), expected) << threads;
    }
    for (const std::vector<std::size_t>& other : {std::vector<std::size_t>{3, 2, 1, 0}, {1, 3, 0, 2}, {2, 0, 3, 1}}) {
        EXPECT_EQ(hash_of(Simulation(mixed_setup(other))), expected) << other[0];
    }
}

TEST(MeshesThatDeformAndStretch, GoOnToTheSameBitsFromASavedState) {
    Simulation whole(mixed_setup({0, 1, 2, 3}));
    std::vector<std::byte> bytes;
    while (whole.step_index() < 17) whole.step();
    whole.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    Simulation resumed(mixed_setup({0, 1, 2, 3}));
    std::size_t at = 0;
    resumed.restore([&](std::span<std::byte> part) {
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
    EXPECT_EQ(resumed.step_index(), 17U);
    const ThreadLimit limit(3);
    EXPECT_EQ(hash_of(std::move(resumed)), hash_of(std::move(whole)));
}

}  // namespace
}  // namespace ricochet::testing
