#include "ricochet/simulation/memory_estimate.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/memory_limit.h"
#include "support/counts.h"
#include "support/memory_ceiling.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Part = MemoryNeed::Part;
using test::MemoryCeiling;

EmitterDescription source(const std::string& name) {
    EmitterDescription emitter;
    emitter.name = name;
    emitter.shape = BoxShape{};
    return emitter;
}

SimulationSetup setup_with(const EmitterDescription& emitter) {
    SimulationSetup setup;
    setup.options.time_step = 0.01;
    setup.options.duration = 10.0;
    setup.emitters = {emitter};
    return setup;
}

/// Returns the particles that an estimate counts for the only emitter.
std::uint64_t population(const SimulationSetup& setup) {
    std::uint64_t count = 0;
    for (const MemoryNeed& need : estimate_memory(setup).needs) count += need.part == Part::emitter ? need.count : 0;
    return count;
}

std::string refusal_of(SimulationSetup setup) {
    try {
        const Simulation simulation(std::move(setup));
    } catch (const InputError& error) {
        return error.what();
    }
    return "it was taken";
}

TEST(MemoryEstimate, CollidingSpheresNeedMore) {
    EmitterDescription emitter = source("tap");
    emitter.burst = 1000;
    SimulationSetup setup = setup_with(emitter);
    const double alone = estimate_memory(setup).bytes();
    setup.options.particle_contacts.emplace();
    EXPECT_GT(estimate_memory(setup).bytes(), alone + 1000.0 * 500.0);
}

TEST(MemoryEstimate, InteractingParticlesNeedMore) {
    EmitterDescription emitter = source("tap");
    emitter.burst = 1000;
    SimulationSetup setup = setup_with(emitter);
    const double alone = estimate_memory(setup).bytes();
    setup.particles_forces.push_back({make_mutual_gravity({})});
    EXPECT_GT(estimate_memory(setup).bytes(), alone + 1000.0 * 500.0);
}

TEST(MemoryEstimate, BurstsAndRatesCountWithTheirTimesLifetimesAndLimits) {
    EmitterDescription emitter = source("tap");
    emitter.burst = 500;
    EXPECT_EQ(population(setup_with(emitter)), 500U);
    emitter.rate = {1000.0, 300.0};
    EXPECT_EQ(population(setup_with(emitter)), 10'500U);
    emitter.start = 4.0;
    EXPECT_EQ(population(setup_with(emitter)), 6'500U);
    emitter.stop = 6.0;
    EXPECT_EQ(population(setup_with(emitter)), 2'500U);
    emitter.lifetime = {0.5, 0.25};
    EXPECT_EQ(population(setup_with(emitter)), 1'000U);
    emitter.limit = 800;
    EXPECT_EQ(population(setup_with(emitter)), 800U);
    emitter.start = 10.0;
    EXPECT_EQ(population(setup_with(emitter)), 0U) << "it begins when the run ends";
}

TEST(MemoryEstimate, RatesPerFrameAndPerScreenAreaCount) {
    EmitterDescription emitter = source("tap");
    emitter.rate_per_frame = {10.0, 0.0};
    EXPECT_EQ(population(setup_with(emitter)), 2'400U);
    emitter.rate_per_frame = {};
    emitter.rate_per_area = {1.0, 0.0};
    SimulationSetup setup = setup_with(emitter);
    setup.reference_camera = ReferenceCamera{{0, 0, 10}, {0, 0, 0}, 35.0, 720.0};
    const double area = screen_area(emitter.shape, *setup.reference_camera);
    EXPECT_EQ(population(setup), static_cast<std::uint64_t>(240.0 * area));
}

TEST(MemoryEstimate, RateCountsForOneStepIfParticlesMayEndEarly) {
    EmitterDescription emitter = source("tap");
    emitter.burst = 7;
    emitter.rate = {1000.0, 0.0};
    SimulationSetup bounded = setup_with(emitter);
    bounded.bounds = Box3{{-1, -1, -1}, {1, 1, 1}};
    EXPECT_EQ(population(bounded), 17U);
    SimulationSetup absorbing = setup_with(emitter);
    absorbing.materials = {{.name = "sponge", .absorption = 0.1}};
    EXPECT_EQ(population(absorbing), 17U);
}

TEST(MemoryEstimate, CountStopsAtTheLargestPopulation) {
    EmitterDescription emitter = source("tap");
    emitter.burst = 0xFFFFFFFFU;
    EXPECT_EQ(population(setup_with(emitter)), kDefaultMostParticles);
    SimulationSetup setup = setup_with(emitter);
    setup.options.most_particles = 1000;
    setup.particles.resize(400);
    EXPECT_EQ(population(setup), 600U);
    EXPECT_NE(refusal_of(std::move(setup)), "") << "it fits";
}

TEST(MemoryEstimate, EstimateGrowsWithTrianglesAttributesSidesAndVerification) {
    SimulationSetup setup = setup_with(source("tap"));
    setup.emitters[0].burst = 1000;
    setup.materials = {{}};
    setup.colliders.push_back({"plate", PlaneShape{}, 0});
    const double plain = estimate_memory(setup).bytes();
    setup.attributes = {{"heat", 3, {}}};
    const double with_attribute = estimate_memory(setup).bytes();
    EXPECT_EQ(with_attribute - plain, 1000.0 * 3.0 * 32.0);
    setup.options.verify = true;
    const double verified = estimate_memory(setup).bytes();
    EXPECT_GT(verified, with_attribute);
    setup.options.response = ResponseKind::penalty;
    EXPECT_GT(estimate_memory(setup).bytes(), verified);
    const auto mesh = std::make_shared<const TriangleMesh>(testing::box_mesh({-1, -1, -1}, {1, 1, 1}));
    setup.colliders.push_back({"box", MeshShape{mesh, {}, ""}, 0});
    const MemoryEstimate estimate = estimate_memory(setup);
    EXPECT_EQ(estimate.needs.back().part, Part::collider);
    EXPECT_EQ(estimate.needs.back().number, 1U);
    EXPECT_EQ(estimate.needs.back().count, 12U);
}

TEST(MemoryEstimate, SimulationThatDoesNotFitIsRefusedByItsLargestPart) {
    EmitterDescription burst = source("big bang");
    burst.burst = 4'000'000'000U;
    EmitterDescription rate = source("tap");
    rate.rate = {1e9, 0.0};
    const MemoryCeiling ceiling(500e6);
    EXPECT_EQ(refusal_of(setup_with(burst))
                  .rfind("emitter \"big bang\": 100000000 particles: with them the simulation asks for about 38 GB of "
                         "memory, expected at most ",
                         0),
              0U)
        << refusal_of(setup_with(burst));
    EXPECT_EQ(refusal_of(setup_with(rate)).rfind("emitter \"tap\": 100000000 particles: ", 0), 0U);
    rate.name.clear();
    EXPECT_EQ(refusal_of(setup_with(rate)).rfind("emitter 0: 100000000 particles: ", 0), 0U);
    rate.lifetime = {1e-4, 0.0};
    EXPECT_EQ(refusal_of(setup_with(rate)), "it was taken");
}

TEST(MemoryEstimate, AddedParticlesThatDoNotFitAreAllRefused) {
    if (test::kSanitized) GTEST_SKIP() << "the memory of sanitizers is not estimated";
    const std::vector<Particle> many(200'000);
    const MemoryCeiling ceiling(60e6);
    Simulation simulation(setup_with(source("none")));
    EXPECT_THROW((void)simulation.add_particles(many), InputError);
    EXPECT_TRUE(simulation.particles().empty());
    EXPECT_EQ(simulation.add_particles(std::span(many).first(10)).size(), 10U);
}

// Every particle that dies has two children, and so on. More than 2^17 would live, which cannot be counted in advance.
TEST(MemoryEstimate, MultiplyingChildrenThatExceedTheMemoryEndTheRunWithALine) {
    if (test::kSanitized) GTEST_SKIP() << "the memory of sanitizers is not estimated";
    EmitterDescription parents = source("parents");
    parents.burst = 100;
    parents.lifetime = {0.1, 0.0};
    EmitterDescription children = source("children");
    children.parent = ParentRule{.emitter = 0, .recursive = true, .on = BirthEvent::death, .count = {4.0, 0.0}};
    children.lifetime = {0.1, 0.0};
    SimulationSetup setup = setup_with(parents);
    setup.emitters.push_back(children);
    const MemoryCeiling ceiling(50e6);
    Simulation simulation(std::move(setup));
    try {
        while (!simulation.finished()) simulation.step();
        ADD_FAILURE() << simulation.particles().size() << " particles live";
    } catch (const RunError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.rfind("more particles are born than memory holds: ", 0), 0U) << message;
        EXPECT_NE(message.find("lower simulation.most_particles"), std::string::npos) << message;
    }
}

TEST(MemoryEstimate, UncountedBirthsThatExceedTheMemoryEndTheRunWithALine) {
    if (test::kSanitized) GTEST_SKIP() << "the memory of sanitizers is not estimated";
    EmitterDescription rate = source("tap");
    rate.rate = {1e6, 0.0};
    SimulationSetup setup = setup_with(rate);
    setup.bounds = Box3{{-1, -1, -1}, {1, 1, 1}};  // nothing leaves these bounds
    const MemoryCeiling ceiling(50e6);
    Simulation simulation(std::move(setup));
    EXPECT_THROW(simulation.advance(simulation.step_count()), RunError);
    EXPECT_GT(simulation.particles().size(), 10'000U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
