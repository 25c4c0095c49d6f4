// Particles spawned by particles in whole simulations.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "ricochet/verify/parity.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;

ColliderDescription floor_plane() { return {"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}; }

EmitterDescription parents(std::uint64_t count, const Vec3& offset, const Vec3& velocity) {
    EmitterDescription emitter;
    emitter.name = "parents";
    emitter.shape = PointShape{offset};
    emitter.burst = count;
    emitter.velocity = velocity;
    emitter.mass = {2.0, 0.0};
    emitter.radius = {0.1, 0.0};
    return emitter;
}

EmitterDescription children(BirthEvent on, bool share, const MeanSpread& count) {
    EmitterDescription emitter;
    ParentRule rule;
    rule.on = on;
    rule.share = share;
    rule.count = count;
    emitter.parent = rule;
    emitter.speed = {1.5, 0.5};
    return emitter;
}

SimulationSetup setup_of(double time_step, double duration) {
    SimulationSetup setup = testing::setup_of(time_step, duration);
    setup.options.seed = 3;
    return setup;
}

Simulation finished(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

Vec3 momentum_of(const Particles& particles) {
    Vec3 sum;
    for (std::size_t i = 0; i < particles.size(); ++i) sum += particles.mass[i] * particles.velocity[i];
    return sum;
}

double mass_of(const Particles& particles) {
    double sum = 0.0;
    for (const double mass : particles.mass) sum += mass;
    return sum;
}

TEST(Offspring, FragmentsOfADeathKeepMassAndMomentumAndStartInsideTheStep) {
    SimulationSetup setup = setup_of(0.1, 1.0);
    setup.emitters = {parents(5, {0, 0, 1}, {1, 2, 3}), children(BirthEvent::death, true, {20.0, 10.0})};
    setup.emitters[0].lifetime = {0.437, 0.0};
    const Simulation simulation = finished(std::move(setup));
    const Particles& particles = simulation.particles();
    EXPECT_EQ(simulation.statistics().expired, 5U);
    EXPECT_EQ(simulation.statistics().children, particles.size());
    EXPECT_GT(particles.size(), 5U * 9U);
    EXPECT_NEAR(mass_of(particles), 10.0,
                1e-13);  // exact for each parent, see ChildEmitter; sums over several parents round
    EXPECT_LT(length(momentum_of(particles) - Vec3{10, 20, 30}), 1e-12);
    for (std::size_t i = 0; i < particles.size(); ++i) {
        ASSERT_EQ(particles.birth_time[i], 0.437);
        // Fragments fly straight from the parent's position at its death.
        const Vec3 start = Vec3{0, 0, 1} + 0.437 * Vec3{1, 2, 3};
        ASSERT_LT(length(particles.position[i] - (start + 0.563 * particles.velocity[i])), 1e-12);
    }
}

TEST(Offspring, ShatteringImpactTransfersTheMomentumAfterIt) {
    SimulationSetup setup = setup_of(0.1, 0.52);  // the impact is at 0.5 s: z = 1.1 at -2 m/s, radius 0.1
    setup.emitters = {parents(4, {0, 0, 1.1}, {0.3, 0, -2}), children(BirthEvent::impact, true, {15.0, 5.0})};
    setup.emitters[1].parent->threshold_impulse = 7.9;  // 2 kg, 4 m/s
    setup.colliders = {floor_plane()};
    setup.options.record_contacts = true;
    const Simulation simulation = finished(std::move(setup));
    const SimulationStatistics& statistics = simulation.statistics();
    EXPECT_EQ(statistics.shattered, 4U);
    EXPECT_EQ(statistics.absorbed, 0U);
    EXPECT_EQ(statistics.emitted, simulation.particles().size() + 4);
    EXPECT_NEAR(mass_of(simulation.particles()), 8.0, 1e-13);
    // The later impulses on the floor, also from fragments, and the remaining momentum add up to the initial momentum.
    const TriangleTotals totals = simulation.triangle_totals(0);
    EXPECT_LT(length(momentum_of(simulation.particles()) + totals.impulse[0] - Vec3{2.4, 0, -16}), 1e-9);
}

TEST(Offspring, ImpactBelowTheThresholdShattersNothing) {
    SimulationSetup setup = setup_of(0.1, 0.6);
    setup.emitters = {parents(4, {0, 0, 1.1}, {0.3, 0, -2}), children(BirthEvent::impact, true, {15.0, 5.0})};
    setup.emitters[1].parent->threshold_impulse = 8.1;
    setup.colliders = {floor_plane()};
    const Simulation simulation = finished(std::move(setup));
    EXPECT_EQ(simulation.statistics().shattered, 0U);
    EXPECT_EQ(simulation.particles().size(), 4U);
}

TEST(Offspring, EveryResponseShatters) {
    for (const ResponseKind kind : response_kinds()) {
        for (const bool global : {false, true}) {
            SimulationSetup setup = setup_of(0.01, 0.6);
            setup.options.response = kind;
            setup.options.rollback.global = global;
            setup.emitters = {parents(4, {0, 0, 1.1}, {0.3, 0, -2}), children(BirthEvent::impact, true, {15.0, 5.0})};
            setup.emitters[1].parent->threshold_impulse = 3.9;  // penalty: the arriving momentum, 2 kg times 2 m/s
            setup.colliders = {floor_plane()};
            const Simulation simulation = finished(std::move(setup));
            EXPECT_EQ(simulation.statistics().shattered, 4U) << name_of(kind);
            EXPECT_NEAR(mass_of(simulation.particles()), 8.0, 1e-13) << name_of(kind);
        }
    }
}

TEST(Offspring, SparksOfAnImpactLeaveTheParentUnchanged) {
    SimulationSetup setup = setup_of(0.1, 0.6);
    setup.emitters = {parents(3, {0, 0, 1.1}, {0.3, 0, -2}), children(BirthEvent::impact, false, {6.0, 0.0})};
    setup.colliders = {floor_plane()};
    const Simulation simulation = finished(std::move(setup));
    EXPECT_EQ(simulation.statistics().shattered, 0U);
    EXPECT_EQ(simulation.statistics().children, 18U);
    EXPECT_EQ(simulation.particles().velocity[0], (Vec3{0.3, 0, 2}));
}

TEST(Offspring, TrailIsOnTheParentsParabolaAtTimesIndependentOfTheStep) {
    std::vector<double> times;
    for (const double time_step : {0.5, 0.1, 1.0 / 60.0}) {
        SimulationSetup setup = setup_of(time_step, 1.0);
        setup.forces.push_back(make_gravity({0, 0, -kG}));
        setup.emitters = {parents(1, {0, 0, 10}, {3, 0, 4}), children(BirthEvent::life, false, {})};
        setup.emitters[1].rate = {37.0, 10.0};
        setup.emitters[1].speed = {};
        const Simulation simulation = finished(std::move(setup));
        const Particles& particles = simulation.particles();
        std::vector<double> births;
        for (std::size_t i = 1; i < particles.size(); ++i) {
            births.push_back(particles.birth_time[i]);
            // A child with the parent's velocity at its birth stays at the parent.
            ASSERT_LT(length(particles.position[i] - particles.position[0]), 1e-12) << i;
            ASSERT_LT(length(particles.velocity[i] - particles.velocity[0]), 1e-12) << i;
        }
        std::sort(births.begin(), births.end());
        if (!times.empty()) {
            EXPECT_EQ(births, times);
        }
        times = births;
        EXPECT_GT(times.size(), 25U);
    }
}

// With springs, an adaptive method divides the step into substeps. Each has an active set in its own order.
TEST(Offspring, TrailStaysOnItsParentsTrajectoryIfSpringsDivideTheStep) {
    SimulationSetup setup = setup_of(0.1, 0.1);
    setup.options.integrator = IntegratorKind::dormand_prince;
    for (const double x : {10.0, 11.1}) {
        Particle particle;
        particle.position = {x, 0, 0.5};
        setup.particles.push_back(particle);
    }
    setup.springs.push_back({0, 1, 1.0, 2e4, 0.0});
    setup.emitters = {parents(800, {}, {0, 0, 20}), children(BirthEvent::life, false, {})};
    setup.emitters[0].shape = BoxShape{{0, 0, 0.5}, {2, 2, 0.4}};
    setup.emitters[0].radius = {};
    setup.emitters[1].rate = {20.0, 10.0};
    setup.emitters[1].speed = {};
    // Particles are moved in spatial order only beside a mesh of many triangles.
    const auto shell = std::make_shared<const TriangleMesh>(testing::flipped(testing::sphere_mesh({}, 20.0, 4)));
    setup.colliders = {
        floor_plane(), {"ceiling", PlaneShape{{0, 0, 1}, {0, 0, -1}}, 0}, {"shell", MeshShape{shell, {}, ""}, 0}};
    const Simulation simulation = finished(std::move(setup));
    const Particles& particles = simulation.particles();
    std::map<std::pair<double, double>, std::size_t> parent_over;
    for (std::size_t i = 2; i < 802; ++i) parent_over[{particles.position[i].x, particles.position[i].y}] = i;
    ASSERT_EQ(parent_over.size(), 800U);
    ASSERT_GT(particles.size(), 2000U);
    for (std::size_t i = 802; i < particles.size(); ++i) {
        const auto parent = parent_over.find({particles.position[i].x, particles.position[i].y});
        ASSERT_NE(parent, parent_over.end()) << i;
        // A child with the parent's velocity at its birth stays at the parent.
        ASSERT_LT(length(particles.position[i] - particles.position[parent->second]), 1e-10) << i;
        ASSERT_LT(length(particles.velocity[i] - particles.velocity[parent->second]), 1e-10) << i;
    }
}

SimulationSetup busy_setup(double time_step) {
    SimulationSetup setup = setup_of(time_step, 0.6);
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.materials = {{"stone", 0.6, 0.2}};
    setup.colliders = {
        {"ball",
         MeshShape{std::make_shared<const TriangleMesh>(testing::flipped(testing::sphere_mesh({}, 1.0, 2))), {}, ""},
         0}};
    setup.attributes = {{"heat", 1, {1, 0, 0}}, *looks_attribute("color"), *looks_attribute("size")};
    EmitterDescription first = parents(40, {0, 0, 0}, {0, 0, 0});
    first.speed = {4.0, 2.0};
    first.radius = {0.03, 0.02};
    first.lifetime = {0.5, 0.2};
    first.attributes = {{"heat", {100, 0, 0}, {50, 0, 0}}};
    EmitterDescription shards = children(BirthEvent::impact, true, {4.0, 2.0});
    shards.parent->threshold_impulse = 4.0;
    shards.parent->recursive = true;
    EmitterDescription sparks = children(BirthEvent::life, false, {});
    sparks.rate = {20.0, 10.0};
    sparks.parent->recursive = true;
    sparks.mass = {0.01, 0.0};
    sparks.lifetime = {0.2, 0.1};
    EmitterDescription dust = children(BirthEvent::death, false, {3.0, 1.0});
    dust.parent->emitter = 2;
    dust.mass = {0.001, 0.0};
    setup.emitters = {first, shards, sparks, dust};
    setup.options.max_depth = 3;
    return setup;
}

TEST(Offspring, BitsDoNotDependOnThreadsVerificationOrCulling) {
    std::set<std::uint64_t> hashes;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        SimulationSetup setup = busy_setup(0.04);
        setup.options.verify = threads == 2;
        setup.acceleration.culling = threads != 5;
        const Simulation simulation = finished(std::move(setup));
        hashes.insert(simulation.state_hash());
        EXPECT_GT(simulation.statistics().shattered, 5U);
        EXPECT_GT(simulation.statistics().births_refused_by_depth, 0U);
        EXPECT_EQ(simulation.statistics().violations, 0U);
    }
    EXPECT_EQ(hashes.size(), 1U);
}

TEST(Offspring, NoChildIsEverSpawnedOutsideAClosedMesh) {
    const ParityOracle oracle(testing::sphere_mesh({}, 1.0, 2));
    for (const double time_step : {0.02, 0.05, 0.2}) {
        Simulation simulation(busy_setup(time_step));
        while (!simulation.finished()) {
            simulation.step();
            for (const Vec3& p : simulation.particles().position) ASSERT_TRUE(oracle.inside(p));
        }
        EXPECT_GT(simulation.statistics().children, 200U);
        EXPECT_EQ(simulation.statistics().started_inside, 0U);
    }
}

TEST(Offspring, GenerationsEndAtTheDepthAndAreCounted) {
    for (const std::uint32_t depth : {0U, 1U, 3U}) {
        SimulationSetup setup = setup_of(0.05, 1.0);
        setup.emitters = {parents(2, {}, {}), children(BirthEvent::death, false, {2.0, 0.0})};
        setup.emitters[0].lifetime = {0.1, 0.0};
        setup.emitters[1].lifetime = {0.1, 0.0};
        setup.emitters[1].parent->recursive = true;
        setup.options.max_depth = depth;
        const Simulation simulation = finished(std::move(setup));
        std::uint64_t born = 0;
        for (std::uint32_t k = 1; k <= depth; ++k) born += 2ULL << k;
        EXPECT_EQ(simulation.statistics().children, born);
        EXPECT_EQ(simulation.statistics().births_refused_by_depth, 2ULL << (depth + 1));
        EXPECT_TRUE(simulation.particles().empty());
    }
}

TEST(Offspring, PopulationLimitRefusesAndCountsAndConservesMass) {
    SimulationSetup setup = setup_of(0.1, 1.0);
    setup.emitters = {parents(10, {0, 0, 1}, {1, 2, 3}), children(BirthEvent::death, true, {20.0, 0.0})};
    setup.emitters[0].lifetime = {0.45, 0.0};
    setup.options.most_particles = 50;
    const Simulation simulation = finished(std::move(setup));
    EXPECT_LE(simulation.particles().size(), 50U);
    EXPECT_EQ(simulation.statistics().births_refused_by_population, 200U - simulation.particles().size());
    EXPECT_NEAR(mass_of(simulation.particles()), 20.0, 1e-13);
    EXPECT_LT(length(momentum_of(simulation.particles()) - Vec3{20, 40, 60}), 1e-11);
}

// A step has millions of births, of which few fit. The others are counted without being made.
TEST(Offspring, BirthsOfALifeBeyondThePopulationLimitAreCountedOneByOne) {
    for (const std::uint64_t most : {10U, 13U, 500U}) {
        SimulationSetup setup = setup_of(0.1, 0.1);
        setup.emitters = {parents(10, {0, 0, 1}, {1, 2, 3}), children(BirthEvent::life, false, {})};
        setup.emitters[1].rate = {1e7, 0.0};
        setup.options.most_particles = most;
        const Simulation simulation = finished(std::move(setup));
        EXPECT_EQ(simulation.particles().size(), most);
        EXPECT_EQ(simulation.statistics().children, most - 10U);
        EXPECT_EQ(simulation.statistics().births_refused_by_population, 10U * 1'000'000U - (most - 10U));
    }
    SimulationSetup setup = setup_of(0.1, 0.1);
    setup.emitters = {parents(10, {0, 0, 1}, {1, 2, 3}), children(BirthEvent::life, false, {})};
    setup.emitters[1].rate = {1e7, 0.0};
    setup.options.most_particles = 20;
    setup.options.max_depth = 0;
    EXPECT_EQ(finished(std::move(setup)).statistics().births_refused_by_depth, 10'000'000U);
}

TEST(Offspring, PopulationLimitAppliesToEmittersToo) {
    SimulationSetup setup = setup_of(0.1, 1.0);
    setup.emitters = {parents(10, {0, 0, 1}, {1, 2, 3})};
    setup.options.most_particles = 7;
    const Simulation simulation = finished(std::move(setup));
    EXPECT_EQ(simulation.particles().size(), 7U);
    EXPECT_EQ(simulation.statistics().births_refused_by_population, 3U);
}

TEST(Offspring, MissingParentsAndTwoSharesAreRefused) {
    SimulationSetup missing = setup_of(0.1, 1.0);
    missing.emitters = {children(BirthEvent::death, true, {2.0, 0.0})};
    missing.emitters[0].parent->emitter = 5;
    EXPECT_THROW(Simulation{std::move(missing)}, InputError);
    SimulationSetup twice = setup_of(0.1, 1.0);
    twice.emitters = {parents(1, {}, {}), children(BirthEvent::death, true, {2.0, 0.0}),
                      children(BirthEvent::death, true, {2.0, 0.0})};
    EXPECT_THROW(Simulation{std::move(twice)}, InputError);
}

TEST(Offspring, CurvesOverLifeChangeTheDisplayOnly) {
    SimulationSetup setup = setup_of(0.1, 0.5);
    setup.attributes = {{"heat", 1, {}}, *looks_attribute("size")};
    setup.emitters = {parents(3, {}, {})};
    setup.emitters[0].lifetime = {2.0, 0.0};
    setup.emitters[0].attributes = {{"heat", {80, 0, 0}, {}}};
    setup.emitters[0].curves = {{"heat", KeyedCurve<Vec3>({{0.0, {1, 1, 1}}, {1.0, {0, 0, 0}}}), true},
                                {"size", KeyedCurve<Vec3>({{0.0, {0, 0, 0}}, {1.0, {2, 0, 0}}}), false}};
    const Simulation simulation = finished(std::move(setup));
    EXPECT_EQ(simulation.particles().attributes.value(0, 1).x, 80.0);
    EXPECT_EQ(simulation.shown_attributes().value(0, 1).x, 60.0);
    EXPECT_EQ(simulation.particles().attributes.value(1, 1).x, 0.1);     // the radius
    EXPECT_DOUBLE_EQ(simulation.shown_attributes().value(1, 1).x, 0.1);  // the factor is 1 at 0.5 s
}

TEST(Offspring, UnusedColumnsStayEmpty) {
    SimulationSetup setup = setup_of(0.1, 0.5);
    setup.emitters = {parents(3, {}, {})};
    const Simulation simulation = finished(std::move(setup));
    EXPECT_TRUE(simulation.particles().origin.empty());
    EXPECT_TRUE(simulation.particles().attributes.empty());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
