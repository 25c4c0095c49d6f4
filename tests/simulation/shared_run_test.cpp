// A run shared by ranks has the bits of one process: particles, contacts, counters, totals, saved states.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/simulation.h"
#include "simulation/shared_outcome.h"
#include "support/simulations.h"
#include "support/thread_ranks.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::belt_setup;
using testing::busy_setup;
using testing::difference;
using testing::divergence_of;
using testing::family_setup;
using testing::on_ranks;
using testing::Outcome;
using testing::particle_of;
using testing::run;
using testing::run_on;
using testing::saved_by_each;
using testing::setup_of;
using testing::State;

const std::vector<std::pair<const char*, SimulationSetup (*)()>> kSetups = {
    {"busy", busy_setup}, {"belt", belt_setup}, {"family", family_setup}};

TEST(SharedRun, BitsMatchOneProcess) {
    for (const auto& [name, make] : kSetups) {
        const Outcome alone = run(make, nullptr);
        for (const std::size_t count : {1U, 2U, 3U, 5U}) {
            EXPECT_EQ(difference(run_on(count, make), alone), "none") << name << ", " << count << " ranks";
        }
    }
}

// Checks that the scenes exercise their features.
TEST(SharedRun, ChildrenLimitsAndLostTimeOccur) {
    Simulation busy(busy_setup());
    while (!busy.finished()) busy.step();
    EXPECT_GT(busy.statistics().children, 100U);
    EXPECT_GT(busy.statistics().births_refused_by_population, 100U);
    EXPECT_GT(busy.statistics().absorbed, 10U);
    Simulation belt(belt_setup());
    while (!belt.finished()) belt.step();
    EXPECT_GT(belt.statistics().unsimulated_time, 0.0);
    EXPECT_GT(belt.collider_totals()[0].hits, 0U);
}

// With all four parents on the first rank, that rank would have two, three and four times the mean work.
TEST(SharedRun, ParticlesMoveFromOverloadedRanks) {
    for (const std::size_t count : {2U, 3U, 4U}) {
        RankBalance balance;
        on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
            SimulationSetup setup = family_setup();
            setup.ranks = ranks;
            Simulation simulation(std::move(setup));
            while (!simulation.finished()) simulation.step();
            if (ranks->rank() == 0) balance = simulation.rank_balance();
        });
        EXPECT_GT(balance.moved, 0U) << count << " ranks";
        EXPECT_LT(balance.busiest_now, 1.1) << count << " ranks, once no more are born";
        EXPECT_LT(balance.busiest, 1.3) << count << " ranks, the run's begin included";
    }
}

TEST(SharedRun, RunContinuesFromTheParticlesOfEachRank) {
    for (const auto& [name, make] : kSetups) {
        const Outcome alone = run(make, nullptr);
        const State four = saved_by_each(4, make, 40);
        EXPECT_EQ(run(make, nullptr, four).saved == alone.saved, true) << name << ", alone";
        for (const std::size_t count : {2U, 3U, 5U}) {
            EXPECT_EQ(run_on(count, make, four).saved == alone.saved, true) << name << ", " << count << " ranks";
        }
    }
}

TEST(SharedRun, RunContinuesWithAnyNumberOfRanks) {
    for (const auto& [name, make] : kSetups) {
        const Outcome alone = run(make, nullptr);
        const Outcome four = run_on(4, make, {}, 20);
        EXPECT_EQ(difference(four, run(make, nullptr, {}, 20)), "none") << name;
        const Outcome two = run_on(2, make, {four.saved, {}}, 45);
        const Outcome three = run_on(3, make, {two.saved, {}});
        EXPECT_EQ(three.state, alone.state) << name;
        EXPECT_EQ(three.saved == alone.saved, true) << name;
        EXPECT_EQ(run(make, nullptr, {two.saved, {}}).saved == alone.saved, true) << name;
    }
}

TEST(SharedRun, DivergenceOfOneParticleEndsAllRanks) {
    const auto make = [] {
        SimulationSetup setup = setup_of(0.01, 1.0);
        setup.forces.push_back(make_gravity({1e11, 0, 0}));
        for (int i = 0; i < 60; ++i) setup.particles.push_back(particle_of({0, 0, 0.1 * i}, {1e6 * (i % 50), 0, 0}));
        return setup;
    };
    const std::string alone = divergence_of(make, nullptr);
    EXPECT_NE(alone, "none");
    on_ranks(3, [&](const std::shared_ptr<Ranks>& ranks) { EXPECT_EQ(divergence_of(make, ranks), alone); });
}

TEST(SharedRun, FeaturesThatNeedOneProcessAreRefusedByName) {
    const auto refusal_of = [](SimulationSetup setup) {
        std::string text;
        on_ranks(2, [&](const std::shared_ptr<Ranks>& ranks) {
            if (ranks->rank() != 0) return;
            setup.ranks = ranks;
            try {
                const Simulation simulation(std::move(setup));
            } catch (const InputError& error) {
                text = error.what();
            }
        });
        return text;
    };
    SimulationSetup solved = setup_of(0.01, 1.0);
    solved.solver = [](ParticleSystem&, double) {};
    EXPECT_EQ(refusal_of(std::move(solved)).rfind("solver: ranks: found 2, expected 1", 0), 0U);
    SimulationSetup spheres = setup_of(0.01, 1.0);
    spheres.options.particle_contacts.emplace();
    EXPECT_EQ(refusal_of(std::move(spheres)).rfind("particle_contacts: ranks: found 2", 0), 0U);
    SimulationSetup project = setup_of(0.01, 1.0);
    project.options.response = ResponseKind::project;
    EXPECT_EQ(refusal_of(std::move(project)).rfind("response: ranks: found 2", 0), 0U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
