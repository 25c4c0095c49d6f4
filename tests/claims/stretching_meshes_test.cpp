// Particles hit meshes with changing scale at the exact position of the surface, and never pass through.
//
// A long run has many more particles and steps.
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

#include "ricochet/core/error.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/stretched_motion.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/parity.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

/// Returns a mesh that moves with the last frame of a chain up to the time `end`. Each frame of the chain is the parent
/// of the next.
MeshShape stretching(const TriangleMesh& mesh, std::vector<FrameDescription> chain, double end) {
    for (std::size_t k = 0; k < chain.size(); ++k) {
        chain[k].name = std::to_string(k);
        if (k > 0) chain[k].parent = chain[k - 1].name;
    }
    const FrameTree frames(std::move(chain));
    MeshShape shape{std::make_shared<const TriangleMesh>(mesh), {}, "", {}};
    shape.motion =
        std::make_shared<const MeshMotion>(stretched_motion(mesh.vertices, frames, frames.size() - 1, 0.0, end));
    return shape;
}

FrameDescription frame_with(std::vector<FrameMotion> motions) {
    FrameDescription frame;
    frame.motions = std::move(motions);
    return frame;
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

/// Closed form of a ball that moves along one axis and hits two walls elastically. The walls are at -(1 + u t) and 1 +
/// u t.
struct Bouncer {
    double position;
    double velocity;
    double wall_speed;
    double radius;
    double time = 0.0;
    std::vector<double> hits{};

    /// Advances from impact to impact up to the time `end`.
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

// Each elastic moving wall changes only one velocity component. The three components therefore follow independent
// closed forms.
TEST(AMeshBoxWhoseScaleChanges, ReflectsParticlesAccordingToTheMotionOfItsWalls) {
    const Vec3 start{0.2, -0.1, 0.3};
    const Vec3 velocity{2.3, 1.7, -2.9};
    const double end = 3.0;
    for (const Vec3& rate : {Vec3{0.25, 0.25, 0.25}, Vec3{-0.2, -0.2, -0.2}, Vec3{0.3, -0.15, 0.0}}) {
        for (const double radius : {0.0, 0.1}) {
            SCOPED_TRACE(std::to_string(rate.x) + " " + std::to_string(radius));
            SimulationSetup setup = setup_of(0.07, end, {"", 1.0, 0.0});
            const KeyedCurve<Vec3> factors({{0.0, {1, 1, 1}}, {4.0, Vec3{1, 1, 1} + 4.0 * rate}});
            setup.colliders = {
                {"box", stretching(box_mesh({-1, -1, -1}, {1, 1, 1}), {frame_with({KeyedScale{factors}})}, 4.0), 0}};
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

/// A scene with a particle that falls on the upper side of a box. The box is in a frame rotated by a quarter turn. The
/// parent of this frame is at (0, 0, 1) and grows at the given rates.
struct Growing {
    Vec3 rates{0.3, -0.2, 0.4};
    Vec3 place{0.5, 0.25, 0.7};  // position of the box in the growing frame
    double half = 0.5;

    [[nodiscard]] SimulationSetup setup(const Material& material, double radius) const {
        SimulationSetup setup = setup_of(0.05, 1.0, material);
        FrameDescription lower =
            frame_with({KeyedScale{KeyedCurve<Vec3>({{0.0, {1, 1, 1}}, {2.0, Vec3{1, 1, 1} + 2.0 * rates}})}});
        lower.translation = {0, 0, 1};
        FrameDescription upper;
        upper.translation = place;
        upper.rotation_degrees = 90.0;
        const TriangleMesh box = box_mesh({-half, -half, -half}, {half, half, half});
        setup.colliders = {{"box", stretching(box, {lower, upper}, 2.0), 0}};
        Particle particle;
        particle.position = {0.8, 0.1, 3.0};
        particle.velocity = {0, 0, -2.0};
        particle.radius = radius;
        setup.particles = {particle};
        return setup;
    }
    /// Returns the time of impact, in s.
    [[nodiscard]] double time(double radius) const {
        const double top = place.z + half;
        return (3.0 - radius - 1.0 - top) / (2.0 + rates.z * top);
    }
};

TEST(ABoxInAChainOfScaledFrames, IsHitAtItsExactSideAndReflectsWithTwiceItsSpeed) {
    const Growing growing;
    for (const double radius : {0.0, 0.1}) {
        Simulation simulation(growing.setup({"", 1.0, 0.0}, radius));
        std::vector<ContactRecord> records;
        while (!simulation.finished()) {
            simulation.step();
            const auto some = simulation.contact_records();
            records.insert(records.end(), some.begin(), some.end());
        }
        ASSERT_EQ(records.size(), 1U);
        EXPECT_NEAR(records[0].time, growing.time(radius), 1e-14);
        const double speed = growing.rates.z * 1.2;  // speed of the upper side, whose height in the growing frame is
                                                     // 1.2 m
        EXPECT_LT(length(records[0].velocity_after - Vec3{0, 0, 2.0 * speed + 2.0}), 1e-13);
        expect_sound(simulation);
    }
}

// Without rebound and with sufficient friction, the particle gets the velocity of the surface point that it hits. This
// velocity is the rate of the scale times the position of the point in the growing frame.
TEST(ABoxInAChainOfScaledFrames, GivesAStickingParticleTheVelocityOfThePointOfImpact) {
    const Growing growing;
    Simulation simulation(growing.setup({"", 0.0, 1e3}, 0.0));
    std::vector<ContactRecord> records;
    while (records.empty()) {
        simulation.step();
        const auto some = simulation.contact_records();
        records.assign(some.begin(), some.end());
    }
    const double time = growing.time(0.0);
    const Vec3 rates = growing.rates;
    const Vec3 expected{rates.x * 0.8 / (1.0 + rates.x * time), rates.y * 0.1 / (1.0 + rates.y * time), rates.z * 1.2};
    EXPECT_LT(length(records[0].velocity_after - expected), 1e-13);
    // Afterwards the particle moves with this surface point.
    while (!simulation.finished()) simulation.step();
    const Vec3 start{0.8 / (1.0 + rates.x * time), 0.1 / (1.0 + rates.y * time), 1.2};
    const Vec3 end = Vec3{0, 0, 1} + start + Vec3{rates.x * start.x, rates.y * start.y, rates.z * start.z};
    EXPECT_LT(length(simulation.particles().position[0] - end), 1e-6);
    expect_sound(simulation);
}

/// Returns spheres in a mesh that grows and rotates. One frame describes both motions, or two frames describe one
/// motion each.
SimulationSetup turning_gas(bool in_two) {
    SimulationSetup setup = setup_of(0.01, 1.0, {"", 0.8, 0.2});
    const KeyedScale growth{KeyedCurve<Vec3>({{0.0, {1, 1, 1}}, {2.0, {1.4, 1.4, 1.4}}})};
    std::vector<FrameDescription> chain{frame_with({Spin{{1, 1, 0}, in_two ? 50.0 : 80.0}, growth})};
    if (in_two) chain.push_back(frame_with({Spin{{1, 1, 0}, 30.0}}));
    setup.colliders = {{"box", stretching(box_mesh({-1, -1, -1}, {1, 1, 1}), std::move(chain), 1.5), 0}};
    EmitterDescription emitter;
    emitter.shape = SphereShape{{}, 0.5, false};
    emitter.burst = 40;
    emitter.speed = {2.0, 1.0};
    emitter.radius = {0.05, 0.05};
    setup.emitters.push_back(std::move(emitter));
    return setup;
}

/// Returns the first impact of each particle.
std::vector<ContactRecord> first_impacts(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    std::vector<ContactRecord> first(40);
    for (ContactRecord& record : first) record.time = -1.0;
    while (!simulation.finished()) {
        simulation.step();
        for (const ContactRecord& record : simulation.contact_records()) {
            if (first.at(record.particle).time < 0.0) first[record.particle] = record;
        }
    }
    expect_sound(simulation);
    return first;
}

// A uniform scale commutes with a rotation about the same origin, so both descriptions are equivalent.
TEST(AMeshInAChainOfScaledFrames, IsHitAsInOneFrameWithTheCombinedMotion) {
    const std::vector<ContactRecord> chained = first_impacts(turning_gas(true));
    const std::vector<ContactRecord> single = first_impacts(turning_gas(false));
    int hits = 0;
    for (std::size_t k = 0; k < chained.size(); ++k) {
        hits += chained[k].time > 0.0 ? 1 : 0;
        EXPECT_NEAR(chained[k].time, single[k].time, 1e-12) << k;
        EXPECT_LT(length(chained[k].velocity_after - single[k].velocity_after), 1e-11) << k;
    }
    EXPECT_GT(hits, 20);
}

template <class Call>
std::string refusal(const Call& call) {
    try {
        call();
    } catch (const InputError& error) {
        return error.what();
    }
    return "";
}

// A collider in a scaled frame must be converted to a deforming mesh by stretched_motion(). An emitter is refused,
// because emitted particles keep their size.
TEST(WhatStandsInAScaledFrame, CannotBeAColliderOrAnEmitter) {
    FrameDescription frame = frame_with({KeyedScale{KeyedCurve<Vec3>({{0.0, {1, 1, 1}}, {1.0, {2, 2, 2}}})}});
    frame.name = "lung";
    const auto frames = std::make_shared<const FrameTree>(std::vector{frame});
    SimulationSetup with_collider = setup_of(0.01, 1.0, {"", 1.0, 0.0});
    with_collider.frames = frames;
    with_collider.colliders = {{"box", CuboidShape{{1, 1, 1}, {}}, 0, "lung"}};
    EXPECT_EQ(
        refusal([&] { Simulation{std::move(with_collider)}; }),
        "collider \"box\": frame: found lung, expected a frame without a scale: stretched_motion() says how a mesh "
        "in it deforms");
    EmitterDescription emitter;
    emitter.name = "tap";
    emitter.rate.mean = 1.0;
    emitter.frames = frames;
    SimulationSetup with_emitter = setup_of(0.01, 1.0, {"", 1.0, 0.0});
    with_emitter.emitters = {emitter};
    EXPECT_NE(
        refusal([&] { Simulation{std::move(with_emitter)}; }).find("its frame is scaled, expected one that keeps"),
        std::string::npos);
}

/// Returns a gas in a mesh that squashes, stretches, tumbles and oscillates. The scale of the parent frame oscillates
/// too.
SimulationSetup squashed_gas(double duration, int count, double radius) {
    SimulationSetup setup = setup_of(0.01, duration, {"", 0.9, 0.3});
    setup.options.record_contacts = false;
    const KeyedScale breath{KeyedCurve<Vec3>({{0.0, {1, 1, 1}}, {0.3, {1.1, 0.9, 1.2}}, {0.6, {1, 1, 1}}},
                                             Interpolation::spline, CurveEnds::repeat)};
    std::vector<CurveKey<Vec3>> keys;
    for (int k = 0; 0.2 * k < duration + 0.2; ++k) {
        const double s = k % 2 == 0 ? 0.8 : 1.25;
        keys.push_back({0.2 * k, {s, 1.0 / s, k % 3 == 0 ? 1.1 : 0.9}});
    }
    setup.colliders = {{"skin",
                        stretching(sphere_mesh({}, 1.0, 2),
                                   {frame_with({Oscillation{{0.2, 0, 0.1}, 0.8}, breath}),
                                    frame_with({Spin{{1, 2, 3}, 90.0}, KeyedScale{KeyedCurve<Vec3>(std::move(keys))}})},
                                   duration + 0.01),
                        0}};
    EmitterDescription emitter;
    emitter.shape = SphereShape{{}, 0.5, false};
    emitter.burst = static_cast<std::uint64_t>(count);
    emitter.speed = {2.0, 1.0};
    emitter.radius = {radius, 0.5 * radius};
    setup.emitters.push_back(std::move(emitter));
    return setup;
}

TEST(AMeshWhoseScaleChanges, KeepsParticlesInsideWhileItTumbles) {
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

/// Returns points and spheres in a box that is shaken, rotates back and forth, and stretches.
SimulationSetup shaken_box(std::uint64_t seed, const Material& material) {
    RandomSequence random(seed, 5, 0);
    SimulationSetup setup = setup_of(1.0 / 60.0, 0.7, material);
    setup.options.record_contacts = false;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    const KeyedScale stretch{KeyedCurve<Vec3>({{0.0, {1, 1, 1}}, {0.7, {0.8, 1.2, 1.25}}})};
    const Swing swing{random.unit_vector(), 20.0 + 60.0 * random.uniform(), 0.5 + random.uniform(), 30.0};
    const std::vector<FrameMotion> motions{Oscillation{{-0.1, 0.4, 0.1}, 0.7, 30.0}, swing, stretch};
    setup.colliders = {
        {"box", stretching(box_mesh({-0.85, -0.65, -0.75}, {0.85, 0.65, 0.75}), {frame_with(motions)}, 0.71), 0}};
    for (int k = 0; k < 16; ++k) {
        const double radius = k % 2 == 0 ? 0.0 : 0.02 + 0.1 * random.uniform();
        setup.particles.push_back(particle_of(0.4 * random.in_unit_ball(), 6.0 * random.in_unit_ball(), radius));
    }
    return setup;
}

// While a particle slides in a corner, the supporting faces turn during a contact interval.
TEST(AMeshWhoseScaleChanges, LosesNoTimeOfParticlesSlidingInItsCorners) {
    for (const Material& material : {Material{"", 0.0, 0.0}, Material{"", 0.0, 0.3}, Material{"", 0.3, 0.2}}) {
        for (std::uint64_t seed = 0; seed < static_cast<std::uint64_t>(test::scaled(3)); ++seed) {
            SCOPED_TRACE(std::to_string(material.restitution) + " " + std::to_string(material.friction) + " " +
                         std::to_string(seed));
            Simulation simulation(shaken_box(seed, material));
            while (!simulation.finished()) simulation.step();
            expect_sound(simulation);
            EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
        }
    }
}

std::uint64_t hash_of(Simulation simulation) {
    while (!simulation.finished()) simulation.step();
    return simulation.state_hash();
}

/// Returns a scene with a deforming mesh, a growing box, a box at rest and a spinning box, in the given order. A gas
/// and some rain hit them.
SimulationSetup mixed_setup(const std::vector<std::size_t>& order) {
    SimulationSetup setup = squashed_gas(0.4, 150, 0.03);
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    const KeyedScale growth{KeyedCurve<Vec3>({{0.0, {1, 1, 1}}, {1.0, {1.5, 1.5, 0.8}}})};
    FrameDescription spinning;
    spinning.name = "spinning";
    spinning.translation = {4, 0, 0};
    spinning.motions = {Spin{{0, 1, 0}, 200.0}};
    setup.frames = std::make_shared<const FrameTree>(std::vector{spinning});
    const std::vector<ColliderDescription> all{
        setup.colliders[0],
        {"block", stretching(box_mesh({2, -1, -1}, {3, 1, 0}), {frame_with({growth})}, 1.0), 0},
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

TEST(MeshesThatDeformAndStretch, EndInTheSameBitsForAnyOrderOfCollidersAndAnyThreads) {
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

TEST(MeshesThatDeformAndStretch, ResumeToTheSameBitsFromASavedState) {
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

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
