// Spheres that overlap surfaces at birth: the reaction of emitters, and the motion of such spheres.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

ColliderDescription mesh_collider(TriangleMesh mesh, const std::string& name = "mesh") {
    return {name, MeshShape{std::make_shared<const TriangleMesh>(std::move(mesh)), {}, ""}, 0};
}

EmitterDescription spheres_from(EmitterShape shape, std::uint64_t burst, double radius) {
    EmitterDescription emitter;
    emitter.name = "spheres";
    emitter.shape = std::move(shape);
    emitter.burst = burst;
    emitter.radius = {radius, 0.0};
    return emitter;
}

/// Gives each emitter its own name.
std::vector<EmitterDescription> named(std::vector<EmitterDescription> emitters) {
    for (std::size_t k = 0; k < emitters.size(); ++k) emitters[k].name += std::to_string(k);
    return emitters;
}

Particle sphere(const Vec3& position, double radius, const Vec3& velocity = {}, const Vec3& spin = {}) {
    return testing::particle_of(position, velocity, radius, spin);
}

double clearance(const Simulation& simulation, std::size_t i) {
    return simulation.collisions().closest_point(simulation.particles().position[i])->distance;
}

double energy(const Simulation& simulation) { return simulation.kinetic_energy() + *simulation.potential_energy(); }

/// Returns two plates, each a closed box, with a gap between z = -half and z = half.
SimulationSetup slot(double half) {
    SimulationSetup setup = testing::setup_of(0.01, 0.1, {"", 0.5, 0.3});
    setup.colliders = {mesh_collider(testing::box_mesh({-2, -2, half}, {2, 2, half + 1})),
                       mesh_collider(testing::box_mesh({-2, -2, -half - 1}, {2, 2, -half}), "lower")};
    return setup;
}

TEST(BirthsOfSpheres, SpheresAreBornARadiusAwayFromEverySurfaceForAnyThreads) {
    std::set<std::uint64_t> hashes;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        SimulationSetup setup = slot(0.5);
        setup.options.verify = true;
        setup.emitters = {spheres_from(BoxShape{{}, {1, 1, 1.2}}, 200, 0.1)};
        setup.emitters[0].rate = {3000.0, 1000.0};
        setup.emitters[0].radius.spread = 0.05;
        setup.emitters[0].speed = {1.0, 0.5};
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        const Particles& all = simulation.particles();
        EXPECT_GT(all.size(), 300U);
        for (std::size_t i = 0; i < all.size(); ++i) {
            ASSERT_GE(clearance(simulation, i), all.radius[i] - 1e-11) << i;
        }
        EXPECT_EQ(simulation.statistics().started_in_overlap, 0U);
        EXPECT_EQ(simulation.statistics().births_refused_by_overlap, 0U);
        EXPECT_EQ(simulation.statistics().violations, 0U);
        hashes.insert(simulation.state_hash());
    }
    EXPECT_EQ(hashes.size(), 1U);
}

TEST(BirthsOfSpheres, BirthsAreRefusedAndCountedIfNothingFits) {
    SimulationSetup setup = slot(0.09);
    setup.emitters =
        named({spheres_from(BoxShape{{}, {1, 1, 0.18}}, 20, 0.1), spheres_from(PointShape{{0, 0, 0.05}}, 7, 0.05),
               spheres_from(BoxShape{{}, {1, 1, 0.18}}, 30, 0.0)});
    setup.emitters[0].rate = {100.0, 0.0};
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().births_refused_by_overlap, 20U + 10U + 7U);
    EXPECT_EQ(simulation.statistics().births_refused_by_population, 0U);
    EXPECT_EQ(simulation.statistics().emitted, 30U);
}

TEST(BirthsOfSpheres, RefusalsByOverlapAndByThePopulationAddUp) {
    SimulationSetup setup = slot(0.2);
    setup.options.most_particles = 50;
    setup.emitters =
        named({spheres_from(PointShape{{0, 0, 0.15}}, 11, 0.1), spheres_from(BoxShape{{}, {1, 1, 0.4}}, 70, 0.1)});
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    const SimulationStatistics& counts = simulation.statistics();
    EXPECT_EQ(counts.emitted, 50U);
    EXPECT_EQ(counts.births_refused_by_overlap, 11U);
    EXPECT_EQ(counts.emitted + counts.births_refused_by_overlap + counts.births_refused_by_population, 81U);
}

TEST(BirthsOfSpheres, SpheresMayBeBornInsideASolidAndMayTouch) {
    SimulationSetup setup = testing::setup_of(0.01, 0.01, {"", 0.5, 0.0});
    setup.colliders = {mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 1}))};
    setup.emitters = named({spheres_from(PointShape{}, 3, 0.5), spheres_from(PointShape{{0.75, 0, 0}}, 4, 0.25)});
    Simulation simulation(std::move(setup));
    simulation.step();
    EXPECT_EQ(simulation.statistics().emitted, 7U);
    EXPECT_EQ(simulation.statistics().births_refused_by_overlap, 0U);
}

TEST(BirthsOfSpheres, BirthsOnAMeshOverlapNeitherTheirTriangleNorItsNeighbours) {
    // The spheres are inside a box. Near its edges, a sphere above one face overlaps the next face.
    const auto box = std::make_shared<const TriangleMesh>(testing::flipped(testing::box_mesh({-1, -1, -1}, {1, 1, 1})));
    for (const bool volume : {false, true}) {
        SimulationSetup setup = testing::setup_of(0.01, 0.01, {"", 0.5, 0.0});
        setup.options.verify = true;
        setup.colliders = {mesh_collider(*box)};
        setup.emitters = {volume ? spheres_from(MeshVolumeShape{box}, 500, 0.3)
                                 : spheres_from(MeshSurfaceShape{box}, 500, 0.3)};
        Simulation simulation(std::move(setup));
        simulation.step();
        EXPECT_EQ(simulation.statistics().emitted, 500U);
        EXPECT_EQ(simulation.statistics().started_in_overlap, 0U);
        EXPECT_EQ(simulation.statistics().violations, 0U);
        for (std::size_t i = 0; i < 500; ++i) {
            ASSERT_GE(clearance(simulation, i), 0.3 - 1e-12);
            ASSERT_LE(max_abs(simulation.particles().position[i]), 0.7 + 1e-12);
        }
    }
}

// Explicit spheres.

TEST(SphereInOverlap, OverlapNeverGainsEnergyNorDeepensAndCostsFewContacts) {
    constexpr std::uint64_t kSeed = 5;
    SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
    for (const double friction : {0.0, 0.4}) {
        SimulationSetup setup = testing::setup_of(0.01, 1.0, {"", 0.5, friction}, {0, 0, -kG});
        setup.options.verify = true;
        setup.colliders = {mesh_collider(testing::sphere_mesh({}, 1.0, 2)), {"floor", PlaneShape{{0, 0, -1.2}}, 0}};
        RandomSequence random(kSeed, 1, 0);
        for (int k = 0; k < 40; ++k) {
            setup.particles.push_back(sphere((0.9 + 0.2 * random.uniform()) * random.unit_vector(), 0.15,
                                             2.0 * random.in_unit_ball(), 20.0 * random.in_unit_ball()));
        }
        Simulation simulation(std::move(setup));
        const std::uint64_t overlaps = simulation.statistics().started_in_overlap;
        EXPECT_GT(overlaps, 30U);
        std::vector<double> clear(40);
        for (std::size_t i = 0; i < clear.size(); ++i) clear[i] = std::min(0.15, clearance(simulation, i));
        double before = energy(simulation);
        while (!simulation.finished()) {
            simulation.step();
            const double after = energy(simulation);
            ASSERT_LE(after, before + 1e-9) << simulation.time();
            before = after;
            for (std::size_t i = 0; i < clear.size(); ++i) {
                ASSERT_GE(clearance(simulation, i), clear[i] - 1e-11) << i << " at " << simulation.time();
            }
        }
        EXPECT_EQ(simulation.statistics().unsimulated_time, 0.0);
        EXPECT_EQ(simulation.statistics().violations, 0U);
        EXPECT_LE(simulation.statistics().bounces_per_step_max, 50U);
    }
}

TEST(SphereInOverlap, SphereLeavesAsIfTheSurfaceWereAbsent) {
    SimulationSetup setup = testing::setup_of(0.01, 1.0, {"", 0.5, 0.3}, {0, 0, kG});
    setup.colliders = {mesh_collider(testing::box_mesh({-1, -1, -1}, {1, 1, 0}))};
    setup.particles = {sphere({0.1, 0.2, 0.03}, 0.1, {0.3, 0, 0}, {1, 2, 3})};
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_NEAR(length(simulation.particles().position[0] - Vec3{0.4, 0.2, 0.03 + 0.5 * kG}), 0.0, 1e-12);
    EXPECT_EQ(simulation.particles().spin[0], (Vec3{1, 2, 3}));
    EXPECT_EQ(simulation.statistics().contacts, 0U);
}

// A sphere half sunk into a slope moves like one on its surface: g sin without friction, 5/7 g sin when rolling, with
// spin v / r.
TEST(SphereInOverlap, SphereSlidesAndRollsLikeATouchingOne) {
    for (const double friction : {0.0, 1.0}) {
        const double angle = 0.3;
        SimulationSetup setup =
            testing::setup_of(0.01, 1.0, {"", 0.0, friction}, {kG * std::sin(angle), 0, -kG * std::cos(angle)});
        TriangleMesh floor = testing::box_mesh({-1, -3, -1}, {20, 3, 0});
        setup.colliders = {mesh_collider(std::move(floor))};
        setup.particles = {sphere({0, 0.1, 0.05}, 0.1)};
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        const double acceleration = (friction > 0.0 ? 5.0 / 7.0 : 1.0) * kG * std::sin(angle);
        EXPECT_NEAR(simulation.particles().position[0].x, 0.5 * acceleration, 1e-9);
        EXPECT_NEAR(simulation.particles().position[0].z, 0.05, 1e-12);
        const double spin = friction > 0.0 ? acceleration / 0.1 : 0.0;
        EXPECT_NEAR(length(simulation.particles().spin[0] - Vec3{0, spin, 0}), 0.0, 1e-7);
        EXPECT_LE(simulation.statistics().contacts, 4U);
    }
}

TEST(SphereInOverlap, SphereRestsAndSleepsAtItsPosition) {
    SimulationSetup setup = testing::setup_of(0.01, 0.5, {"", 0.5, 0.3}, {0, 0, -kG});
    setup.colliders = {{"floor", PlaneShape{}, 0}};
    setup.particles = {sphere({0.5, 0, 0.04}, 0.1), sphere({1.5, 0, 0}, 0.1), sphere({2.5, 0, -0.04}, 0.1, {0, 0, 3})};
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().asleep, 2U);
    EXPECT_NEAR(simulation.particles().position[0].z, 0.04, 1e-13);
    EXPECT_NEAR(simulation.particles().position[1].z, 0.0, 1e-13);
    EXPECT_LT(simulation.particles().position[2].z, -0.1);
    EXPECT_LE(simulation.statistics().contacts, 10U);
}

TEST(SphereInOverlap, SphereHasItsFullRadiusOnceItHasBeenFree) {
    SimulationSetup setup = testing::setup_of(0.01, 2.0, {"", 0.0, 0.3}, {0, 0, -kG});
    setup.options.verify = true;
    setup.colliders = {{"floor", PlaneShape{}, 0}};
    setup.particles = {sphere({0.5, 0, 0.02}, 0.1, {0, 0, 4})};
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_NEAR(simulation.particles().position[0].z, 0.1, 1e-12);
    EXPECT_EQ(simulation.statistics().resting, 1U);
    EXPECT_EQ(simulation.statistics().violations, 0U);
}

TEST(SphereInOverlap, ForcesSeeTheWholeRadius) {
    std::atomic<int> others{0};
    SimulationSetup setup = testing::setup_of(0.01, 0.3, {"", 0.5, 0.3});
    setup.forces.push_back(make_acceleration([&](const ForceInput& input) {
        others += input.radius == 0.1 && input.whole_radius == 0.0 ? 0 : 1;
        return Vec3{0, 0, -kG};
    }));
    setup.colliders = {{"floor", PlaneShape{}, 0}};
    setup.particles = {sphere({0.5, 0, 0.04}, 0.1, {1, 0, 0})};
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(others, 0);
}

TEST(SphereInOverlap, SavedStateKeepsTheOverlap) {
    const auto make = [] {
        SimulationSetup setup = testing::setup_of(0.01, 1.0, {"", 0.8, 0.2}, {0.5, 0, -kG});
        setup.colliders = {{"floor", PlaneShape{}, 0}};
        setup.particles = {sphere({0.5, 0, 0.04}, 0.1, {1, 0, 1}), sphere({0.5, 1, 3}, 0.1)};
        return setup;
    };
    Simulation whole(make());
    while (!whole.finished()) whole.step();
    Simulation first(make());
    for (int k = 0; k < 10; ++k) first.step();
    std::vector<std::byte> bytes;
    first.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    Simulation second(make());
    std::size_t at = 0;
    second.restore([&](std::span<std::byte> part) {
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
    while (!second.finished()) second.step();
    EXPECT_EQ(second.state_hash(), whole.state_hash());
    EXPECT_EQ(second.statistics().started_in_overlap, 1U);
}

TEST(SphereInOverlap, WarningNamesTheSphere) {
    SimulationSetup setup = testing::setup_of(0.01, 1.0, {"", 0.8, 0.2}, {0, 0, -kG});
    setup.colliders = {{"floor", PlaneShape{}, 0}};
    setup.particles = {sphere({0, 0, 5}, 0.5), sphere({0, 0, 0.25}, 0.5), sphere({3, 0, 0.125}, 0.5)};
    const Simulation simulation(std::move(setup));
    ASSERT_EQ(simulation.warnings().size(), 1U);
    EXPECT_EQ(simulation.warnings()[0],
              "2 spheres are born in overlap with a surface: the first is particle 1, 0.25 m deep in 'floor'; the "
              "deepest is 0.375 m; they can leave and slide, but nothing pushes them out: place them a radius away");
    EXPECT_EQ(simulation.statistics().started_in_overlap, 2U);
    EXPECT_EQ(simulation.statistics().started_inside, 2U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
