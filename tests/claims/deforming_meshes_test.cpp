// Particles never pass through deforming meshes, and they rebound according to the motion of the surface.
//
// A long run has many more particles and steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "claims/deforming_scene.h"
#include "ricochet/core/error.h"
#include "ricochet/core/frame_tree.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/geometry/mesh/mesh_motion.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/parity.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet::testing {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;
constexpr double kPi = 3.14159265358979323846;

SimulationSetup setup_of(double time_step, double duration, const Material& material) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    setup.options.verify = true;
    setup.options.record_contacts = true;
    setup.materials = {material};
    return setup;
}

int count_outside(const Simulation& simulation) {
    const ParityOracle oracle(*simulation.collider_mesh(0));
    int outside = 0;
    for (const Vec3& p : simulation.particles().position) outside += oracle.inside(p) ? 0 : 1;
    return outside;
}

// After each step, the test determines the side of each particle from the current mesh. The verifier determines it
// independently.
TEST(ABreathingSphere, KeepsParticlesThatStartInside) {
    for (const double radius : {0.0, 0.03}) {
        for (const double restitution : {1.0, 0.5}) {
            const bool is_long = test::is_long_run();
            SimulationSetup setup = setup_of(0.01, is_long ? 4.0 : 0.6, {"", restitution, 0.3});
            setup.forces.push_back(make_gravity({0, 0, -kG}));
            setup.colliders = {
                {"lung", deforming(sphere_mesh({}, 1.0, 2), breathing, evenly(0.0, 2.0 * kPi, 161), MeshEnds::repeat),
                 0}};
            EmitterDescription emitter;
            emitter.shape = SphereShape{{}, 0.6, false};
            emitter.burst = static_cast<std::uint64_t>(std::max(20, test::scaled(is_long ? 2000 : 60)));
            emitter.speed = {2.0, 1.0};
            emitter.radius = {radius, 0.0};
            setup.emitters.push_back(std::move(emitter));
            Simulation simulation(std::move(setup));
            int outside = 0;
            while (!simulation.finished()) {
                simulation.step();
                outside += count_outside(simulation);
            }
            EXPECT_EQ(outside, 0) << radius << " " << restitution;
            expect_sound(simulation);
            EXPECT_GE(simulation.statistics().contacts, simulation.statistics().emitted);
        }
    }
}

/// Expects that each particle stays above the first collider, which is a sheet. Compares the particle with the height
/// of the sheet after each step.
void expect_held_above(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    int below = 0;
    while (!simulation.finished()) {
        simulation.step();
        const TriangleMesh mesh = *simulation.collider_mesh(0);
        for (const Vec3& p : simulation.particles().position) below += p.z > height_of(mesh, p.x, p.y) ? 0 : 1;
    }
    EXPECT_EQ(below, 0);
    expect_sound(simulation);
    EXPECT_GT(simulation.statistics().contacts, 0U);
}

TEST(AWavingSheet, KeepsTheRainAboveIt) {
    for (const double radius : {0.0, 0.02}) {
        SCOPED_TRACE(radius);
        const bool is_long = test::is_long_run();
        SimulationSetup setup = setup_of(0.01, is_long ? 4.0 : 0.5, {"", 0.4, 0.2});
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.colliders = {{"sheet", deforming(sheet(1.5, 12), waving, evenly(0.0, 5.0, 120)), 0},
                           {"left", PlaneShape{{-1, 0, 0}, {1, 0, 0}}, 0},
                           {"right", PlaneShape{{1, 0, 0}, {-1, 0, 0}}, 0},
                           {"front", PlaneShape{{0, -1, 0}, {0, 1, 0}}, 0},
                           {"back", PlaneShape{{0, 1, 0}, {0, -1, 0}}, 0}};
        EmitterDescription emitter;
        emitter.shape = BoxShape{{0, 0, 0.9}, {1.8, 1.8, 0.6}};
        emitter.burst = static_cast<std::uint64_t>(test::scaled(is_long ? 1000 : 60));
        emitter.speed = {1.0, 0.5};
        emitter.radius = {radius, 0.0};
        setup.emitters.push_back(std::move(emitter));
        expect_held_above(std::move(setup));
    }
}

// Two halves of a strip between walls fold about the y axis. The flat strip becomes a narrow valley and opens again.
TEST(AFoldingStrip, LetsNoParticleThrough) {
    for (const double radius : {0.0, 0.02}) {
        SCOPED_TRACE(radius);
        const bool is_long = test::is_long_run();
        SimulationSetup setup = setup_of(0.01, is_long ? 2.0 : 1.0, {"", 0.7, 0.1});
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.colliders = {{"strip", deforming(sheet(6.0, 4), folding, evenly(0.0, 5.0, 90)), 0},
                           {"front", PlaneShape{{0, -1, 0}, {0, 1, 0}}, 0},
                           {"back", PlaneShape{{0, 1, 0}, {0, -1, 0}}, 0}};
        EmitterDescription emitter;
        emitter.shape = BoxShape{{0, 0, 0.5}, {0.8, 1.6, 0.4}};
        emitter.burst = static_cast<std::uint64_t>(test::scaled(is_long ? 500 : 40));
        emitter.speed = {1.0, 0.5};
        emitter.radius = {radius, 0.0};
        setup.emitters.push_back(std::move(emitter));
        expect_held_above(std::move(setup));
    }
}

// The same plate moves once by moving vertices and once by a moving frame.
TEST(APlateWhoseVerticesTranslate, EqualsThePlateInAMovingFrame) {
    const Vec3 velocity{0.3, -0.2, 0.7};
    for (const double radius : {0.0, 0.05}) {
        std::vector<std::vector<ContactRecord>> contacts;
        std::vector<Vec3> ends;
        for (const bool by_vertices : {true, false}) {
            SimulationSetup setup = setup_of(0.07, 3.0, {"", 0.8, 0.3});
            setup.forces.push_back(make_gravity({0, 0, -kG}));
            const TriangleMesh plate = sheet(6.0, 2);
            if (by_vertices) {
                const auto moved = [&](const Vec3& v, double time) { return v + time * velocity; };
                setup.colliders = {{"plate", deforming(plate, moved, {0.0, 8.0}), 0}};
            } else {
                FrameDescription frame;
                frame.name = "lift";
                frame.motions = {KeyedTranslation{KeyedCurve<Vec3>({{0.0, {}}, {8.0, 8.0 * velocity}})}};
                setup.frames = std::make_shared<const FrameTree>(std::vector{frame});
                setup.colliders = {
                    {"plate", MeshShape{std::make_shared<const TriangleMesh>(plate), {}, "", {}}, 0, "lift"}};
            }
            setup.particles = {particle_of({0.4, 0.3, 1.5}, {1.0, 0.5, 0.2}, radius)};
            Simulation simulation(std::move(setup));
            std::vector<ContactRecord>& all = contacts.emplace_back();
            while (!simulation.finished()) {
                simulation.step();
                all.insert(all.end(), simulation.contact_records().begin(), simulation.contact_records().end());
            }
            ends.push_back(simulation.particles().position[0]);
            expect_sound(simulation);
        }
        ASSERT_GT(contacts[0].size(), 3U);
        ASSERT_EQ(contacts[0].size(), contacts[1].size());
        for (std::size_t k = 0; k < contacts[0].size(); ++k) {
            const ContactRecord& a = contacts[0][k];
            const ContactRecord& b = contacts[1][k];
            EXPECT_NEAR(a.time, b.time, 1e-12) << k;
            EXPECT_LT(length(a.velocity_after - b.velocity_after), 1e-12) << k;
            EXPECT_LT(length(a.surface_velocity - velocity), 1e-12) << k;
        }
        EXPECT_LT(length(ends[0] - ends[1]), 1e-11);
    }
}

// A wall starts to move at speed u. The ball gains 2 u if the wall moves at the time of impact, and nothing if the wall
// is still at rest.
TEST(AnElasticBall, GainsTwiceTheSpeedOfTheSurface) {
    const auto press = [](const Vec3& v, double time) { return v + Vec3{0, 0, time < 1.0 ? 0.0 : 0.5 * (time - 1.0)}; };
    for (const auto& [start, expected] : {std::pair{0.5, 1.0}, std::pair{1.5, 2.0}}) {
        SimulationSetup setup = setup_of(0.03, 3.0, {"", 1.0, 0.0});
        setup.colliders = {{"wall", deforming(sheet(1.0, 3), press, {0.0, 1.0, 3.0}), 0}};
        setup.particles = {particle_of({0.1, 0.2, start}, {0, 0, -1.0})};
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        EXPECT_NEAR(simulation.particles().velocity[0].z, expected, 1e-14);
        expect_sound(simulation);
    }
}

// A plate rises, stops and tilts. Particles on the plate move with it without rebound, and slide when the plate is
// steep.
TEST(WhatLiesOnAMeshThatDeforms, MovesWithIt) {
    const auto lift = [](const Vec3& v, double time) { return v + Vec3{0.2 * time, 0, 0.5 * time}; };
    for (const double radius : {0.0, 0.05}) {
        SimulationSetup setup = setup_of(0.01, 1.0, {"", 0.0, 0.5});
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.colliders = {{"plate", deforming(sheet(2.0, 3), lift, {0.0, 2.0}), 0}};
        setup.particles = {particle_of({0.1, 0.2, radius + 0.01}, {}, radius)};
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        const Vec3 p = simulation.particles().position[0];
        const Vec3 v = simulation.particles().velocity[0];
        EXPECT_NEAR(p.z, radius + 0.5, 1e-12);
        EXPECT_LT(length(v - Vec3{radius == 0.0 ? 0.2 : v.x, 0, 0.5}), 1e-9);
        EXPECT_EQ(simulation.statistics().squeezed, 0U);
        EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
        expect_sound(simulation);
    }
}

// A particle counts as resting if it does not move relative to its support, even if the support moves. Sliding and
// rolling particles do not count.
TEST(WhatLiesOnAMeshThatDeforms, CountsAsRestingIfItRestsOnIt) {
    struct Sample {
        double lift;      ///< speed at which the plate rises, in m/s
        double friction;  ///< sliding and rolling friction
        double speed;     ///< initial speed along the plate, in m/s
        std::uint64_t resting;
    };
    for (const Sample& sample : {Sample{0.0, 0.5, 0.3, 2}, {0.3, 0.5, 0.3, 2}, {0.0, 0.0, 0.3, 0}}) {
        SCOPED_TRACE(std::to_string(sample.lift) + " " + std::to_string(sample.friction));
        const auto lift = [&](const Vec3& v, double time) { return v + Vec3{0, 0, sample.lift * time}; };
        SimulationSetup setup = setup_of(0.01, 1.0, {"", 0.0, sample.friction});
        setup.materials[0].rolling_friction = sample.friction;
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.colliders = {{"plate", deforming(sheet(2.0, 3), lift, {0.0, 2.0}), 0}};
        setup.particles = {particle_of({0.1, 0.2, 0.01}, {sample.speed, 0, 0}),
                           particle_of({0.1, 0.4, 0.06}, {sample.speed, 0, 0}, 0.05)};
        Simulation simulation(std::move(setup));
        simulation.step();
        EXPECT_EQ(simulation.statistics().resting, 0U);
        while (!simulation.finished()) simulation.step();
        EXPECT_EQ(simulation.statistics().resting, sample.resting);
        expect_sound(simulation);
    }
}

/// Runs a particle on a deforming mesh with two equal keys, and on the same mesh at rest. Expects the same path to
/// first order in the time step.
void expect_as_at_rest(const TriangleMesh& mesh, const Particle& particle, double time_step, double duration) {
    std::vector<Vec3> ends;
    for (const bool deforms : {false, true}) {
        SimulationSetup setup = setup_of(time_step, duration, {"", 0.0, 0.0});
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        const auto still = [](const Vec3& v, double /*time*/) { return v; };
        const MeshShape shape = deforms ? deforming(mesh, still, {0.0, 100.0})
                                        : MeshShape{std::make_shared<const TriangleMesh>(mesh), {}, "", {}};
        setup.colliders = {{"mesh", shape, 0}};
        setup.particles = {particle};
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        ends.push_back(simulation.particles().position[0]);
        expect_sound(simulation);
        EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
        EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
    }
    const double translation = length(ends[0] - particle.position);
    EXPECT_GT(translation, 0.05);
    EXPECT_LT(length(ends[1] - ends[0]), 1e-3 * translation)
        << ends[0].x << " " << ends[0].y << " " << ends[0].z << " but " << ends[1].x << " " << ends[1].y << " "
        << ends[1].z;
}

TEST(AMeshWithEqualKeys, ReleasesAtAConvexEdge) {
    const TriangleMesh box = box_mesh({-0.5, -0.5, -0.05}, {0.5, 0.5, 0.05});
    for (const double radius : {0.0, 0.04}) {
        for (const Vec3& velocity : {Vec3{0.1, 0, 0}, Vec3{0.1, 0.07, 0}, Vec3{1.0, 0, 0}}) {
            SCOPED_TRACE(std::to_string(radius) + " " + std::to_string(velocity.x) + " " + std::to_string(velocity.y));
            expect_as_at_rest(box, particle_of({0.49, 0.13, 0.0501 + radius}, velocity, radius), 0.05, 0.5);
        }
    }
}

TEST(AMeshWithEqualKeys, HasRidgesThatDoNotActAsWalls) {
    for (const double height : {0.01, 0.05, 0.1, 0.5}) {
        TriangleMesh roof = sheet(1.0, 2);
        for (Vec3& v : roof.vertices) v.z = height * (1.0 - std::fabs(v.x));
        for (const double radius : {0.0, 0.04}) {
            SCOPED_TRACE(std::to_string(height) + " " + std::to_string(radius));
            const double up = radius * std::sqrt(1.0 + height * height) + 1e-3;
            expect_as_at_rest(roof, particle_of({-0.1, 0.03, 0.9 * height + up}, {1.5, 0.05, 0}, radius), 0.02, 0.6);
        }
    }
}

TEST(AMeshWithEqualKeys, HasInnerEdgesWithoutEffect) {
    for (const double slope : {0.0, 0.3}) {
        TriangleMesh incline = sheet(2.0, 4);
        for (Vec3& v : incline.vertices) v.z = -slope * v.x;
        for (const double radius : {0.0, 0.05}) {
            SCOPED_TRACE(std::to_string(slope) + " " + std::to_string(radius));
            const double up = (radius + 0.01) * std::sqrt(1.0 + slope * slope);
            expect_as_at_rest(incline, particle_of({-1.2, 0.1, 1.2 * slope + up}, {1.0, 0.3, 0}, radius), 0.05, 1.0);
        }
    }
}

TEST(AMeshWithEqualKeys, LetsParticlesSlideDownItsDome) {
    const TriangleMesh dome = sphere_mesh({}, 1.0, 2);
    for (const double radius : {0.0, 0.05}) {
        SCOPED_TRACE(radius);
        expect_as_at_rest(dome, particle_of({0.11, 0.07, 1.0 + radius}, {0.1, 0.05, 0}, radius), 0.005, 1.0);
    }
}

// Before the key, friction accelerates the particle to 0.4 m/s. After the key, friction changes the velocity by 0.37
// m/s in the opposite direction. A step ends exactly at the key.
TEST(WorkOnAPlate, UsesTheVelocityBeforeAKeyUntilTheKey) {
    const double key = 0.63;
    const auto pose_at = [&](double time) {
        return Vec3{time < key ? 0.4 * time : 0.4 * key - 0.3 * (time - key), 0.0, 0.0};
    };
    for (const bool by_vertices : {true, false}) {
        for (const double time_step : {0.09, 0.01}) {
            SimulationSetup setup = setup_of(time_step, 1.0, {"", 0.0, 0.1});
            setup.options.record_contacts = false;
            setup.forces.push_back(make_gravity({0, 0, -10.0}));
            const TriangleMesh plate = sheet(2.0, 1);
            if (by_vertices) {
                const auto moved = [&](const Vec3& v, double time) { return v + pose_at(time); };
                setup.colliders = {{"plate", deforming(plate, moved, {0.0, key, 1.0}), 0}};
            } else {
                FrameDescription frame;
                frame.name = "shaker";
                frame.motions = {KeyedTranslation{
                    KeyedCurve<Vec3>({{0.0, pose_at(0.0)}, {key, pose_at(key)}, {1.0, pose_at(1.0)}})}};
                setup.frames = std::make_shared<const FrameTree>(std::vector{frame});
                setup.colliders = {
                    {"plate", MeshShape{std::make_shared<const TriangleMesh>(plate), {}, "", {}}, 0, "shaker"}};
            }
            setup.particles = {particle_of({0.1, 0.2, 0.3}, {})};
            Simulation simulation(std::move(setup));
            while (!simulation.finished()) simulation.step();
            EXPECT_NEAR(simulation.collider_totals()[0].work, -0.4 * 0.4 - 0.37 * 0.3, 1e-3)
                << by_vertices << time_step;
            EXPECT_NEAR(simulation.particles().velocity[0].x, 0.03, 1e-3) << by_vertices << time_step;
            expect_sound(simulation);
        }
    }
}

SimulationSetup lung_setup() {
    SimulationSetup setup = setup_of(0.01, 0.4, {"", 0.4, 0.3});
    setup.options.record_contacts = false;
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.colliders = {{"lung", deforming(sphere_mesh({}, 1.0, 1), breathing, evenly(0.0, 2.0 * kPi / 7.0, 23)), 0}};
    EmitterDescription emitter;
    emitter.shape = SphereShape{{}, 0.6, false};
    emitter.burst = 50;
    emitter.speed = {3.0, 1.0};
    emitter.radius = {0.02, 0.02};
    setup.emitters.push_back(std::move(emitter));
    return setup;
}

TEST(MeshesThatDeform, ResumeToTheSameBitsFromASavedState) {
    Simulation whole(lung_setup());
    while (whole.step_index() < 20) whole.step();
    std::vector<std::byte> bytes;
    whole.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    while (!whole.finished()) whole.step();
    const auto restored = [&](SimulationSetup setup) {
        auto simulation = std::make_unique<Simulation>(std::move(setup));
        std::size_t at = 0;
        simulation->restore([&](std::span<std::byte> part) {
            std::memcpy(part.data(), bytes.data() + at, part.size());
            at += part.size();
        });
        while (!simulation->finished()) simulation->step();
        return simulation->state_hash();
    };
    EXPECT_EQ(restored(lung_setup()), whole.state_hash());
    // A setup with another motion of the same mesh must be refused.
    SimulationSetup other = lung_setup();
    other.colliders[0].shape = deforming(sphere_mesh({}, 1.0, 1), breathing, evenly(0.0, 2.0 * kPi / 7.0, 22));
    EXPECT_THROW(static_cast<void>(restored(std::move(other))), InputError);
}

TEST(MeshesThatDeform, AreSupportedByTheExactResponseOnly) {
    for (const ResponseKind kind : {ResponseKind::rollback, ResponseKind::project, ResponseKind::penalty}) {
        SimulationSetup setup = lung_setup();
        setup.options.response = kind;
        EXPECT_THROW(Simulation{std::move(setup)}, InputError);
    }
}

TEST(MeshesThatDeform, GiveTheSameBitsForAnyNumberOfThreads) {
    std::vector<std::uint64_t> hashes;
    for (const int threads : {1, 2, 7}) {
        const ThreadLimit limit(threads);
        SimulationSetup setup = setup_of(0.01, 0.3, {"", 0.6, 0.3});
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.colliders = {
            {"lung", deforming(sphere_mesh({}, 1.0, 2), breathing, evenly(0.0, 2.0 * kPi / 7.0, 23)), 0}};
        EmitterDescription emitter;
        emitter.shape = SphereShape{{}, 0.6, false};
        emitter.burst = 300;
        emitter.speed = {3.0, 1.0};
        emitter.radius = {0.02, 0.01};
        setup.emitters.push_back(std::move(emitter));
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        hashes.push_back(simulation.state_hash());
    }
    EXPECT_EQ(hashes[0], hashes[1]);
    EXPECT_EQ(hashes[0], hashes[2]);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::testing
