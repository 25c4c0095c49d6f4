#include "bench/cases.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>

#include "bench/case_setup.h"
#include "bench/insides.h"
#include "bench/small_cases.h"
#include "ricochet/core/error.h"

namespace ricochet::bench {
namespace {

// A case after all its steps.
Simulation finished(const Case& c) {
    const auto mesh = make_mesh(c);
    SimulationSetup setup = make_setup(c, mesh);
    setup.particles = make_particles(c, *mesh);
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

double contacts_per_step(const Simulation& simulation) {
    const SimulationStatistics& s = simulation.statistics();
    return static_cast<double>(s.contacts) / static_cast<double>(s.particle_steps);
}

TEST(BenchCases, AreCompleteAndHaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (const Case& c : all_cases()) {
        SCOPED_TRACE(std::string(c.suite) + "/" + std::string(c.name));
        EXPECT_TRUE(names.insert(std::string(c.suite) + "/" + std::string(c.name)).second);
        EXPECT_GE(c.triangles, 2U);
        EXPECT_GE(c.particles, 1U);
        EXPECT_GE(c.steps, 1U);
        EXPECT_GT(c.time_step, 0.0);
        EXPECT_FALSE(c.box.empty());
        EXPECT_TRUE(c.start != Start::inside || heart_of(c.ground).has_value());
    }
}

TEST(BenchCases, StandSuiteBySuite) {
    const std::vector<std::string> names = suite_names();
    EXPECT_EQ(std::set<std::string>(names.begin(), names.end()).size(), names.size());
    std::size_t cases = 0;
    for (const std::string& name : names) cases += cases_of(name).size();
    EXPECT_EQ(cases, all_cases().size());
}

TEST(BenchCases, OfAnUnknownSuiteAreRefusedWithTheNamesOfAll) {
    try {
        (void)cases_of("juggle");
        FAIL();
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_NE(message.find("--suite juggle"), std::string::npos) << message;
        for (const std::string& name : suite_names()) EXPECT_NE(message.find(name), std::string::npos) << message;
    }
}

TEST(BenchCases, HaveMeshesOfAboutTheSizeTheyWant) {
    for (const std::string& suite : suite_names()) {
        const Case c = small_case(suite, 1, 20'000);
        const double size = static_cast<double>(make_mesh(c)->triangles.size());
        EXPECT_NEAR(size / static_cast<double>(c.triangles), 1.0, 0.15) << suite;
    }
}

TEST(BenchCases, StartInsideTheirClosedGrounds) {
    for (const char* suite : {"gas", "pinball", "wedge"}) {
        const Case c = small_case(suite);
        const auto mesh = make_mesh(c);
        const Insides insides(*mesh, heart_of(c.ground).value());
        for (const Particle& particle : make_particles(c, *mesh)) EXPECT_TRUE(insides.contains(particle.position));
    }
}

TEST(BenchCases, OfGasHitInAboutThreeOfTwoHundredSteps) {
    const double share = contacts_per_step(finished(small_case("gas", 5000, 20'000)));
    EXPECT_GT(share, 0.012);
    EXPECT_LT(share, 0.018);
}

TEST(BenchCases, OfPinballHitInEveryStep) {
    const Case c = small_case("pinball");
    const Simulation simulation = finished(c);
    const auto& contacts = simulation.particles().contacts;
    EXPECT_GE(*std::min_element(contacts.begin(), contacts.end()), c.warm_up + c.steps);
}

TEST(BenchCases, OfTheWedgeBounceHundredsOfTimesInAStep) {
    const Simulation simulation = finished(small_case("wedge", 20));
    EXPECT_GT(contacts_per_step(simulation), 100.0);
    EXPECT_EQ(simulation.statistics().budget_exhausted, 0U);
}

TEST(BenchCases, OfRainHitWithFourDropsInFive) {
    const Simulation simulation = finished(small_case("rain", 5000, 20'000));
    const auto& contacts = simulation.particles().contacts;
    const auto dry = std::count(contacts.begin(), contacts.end(), 0U);
    EXPECT_NEAR(static_cast<double>(dry) / 5000.0, 0.2, 0.05);
    EXPECT_LT(contacts_per_step(simulation), 1.3);
}

TEST(BenchCases, OfSettlingEndAtRest) {
    const Simulation simulation = finished(small_case("settle"));
    EXPECT_GT(simulation.statistics().resting, simulation.particles().size() * 9 / 10);
}

TEST(BenchCases, OfHailLandOnTheTerrain) {
    const Simulation simulation = finished(small_case("hail", 2000, 20'000));
    const auto& contacts = simulation.particles().contacts;
    EXPECT_LT(std::count(contacts.begin(), contacts.end(), 0U), 40);
}

}  // namespace
}  // namespace ricochet::bench
