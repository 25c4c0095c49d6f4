// Springs in a run shared by ranks. The connected particles live on the first rank, and the bits match one process.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/error.h"
#include "ricochet/simulation.h"
#include "simulation/shared_outcome.h"
#include "support/simulations.h"
#include "support/thread_ranks.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::busy_setup;
using testing::difference;
using testing::divergence_of;
using testing::family_setup;
using testing::on_ranks;
using testing::Outcome;
using testing::particle_of;
using testing::run;
using testing::run_on;
using testing::setup_of;

/// Returns particles with springs among free drops. Some springs break, and some lose an end.
SimulationSetup joined_setup(IntegratorKind kind) {
    SimulationSetup setup = busy_setup();
    setup.options.integrator.kind = kind;
    setup.options.most_particles = 3000;
    for (std::uint64_t i = 0; i < 30; ++i) {
        const double strength = i % 3 == 0 ? 1.5 : 8.0;
        setup.springs.push_back({i, i + 1, 0.05, 400.0, 0.1, strength});
    }
    for (std::uint64_t i = 60; i < 80; ++i) setup.springs.push_back({i, i + 2, 0.1, 100.0, 0.2});
    setup.particles[70].lifetime = 0.33;
    return setup;
}

/// The same above a mesh and under drag. Particles without springs then fly in free spaces. Ranks without springs make
/// the substeps of the first rank.
SimulationSetup dragged_setup() {
    SimulationSetup setup = joined_setup(IntegratorKind::dormand_prince);
    setup.forces.push_back(make_linear_drag(0.05));
    setup.colliders = {testing::mesh_collider(testing::floor_mesh(5.0, 10))};
    return setup;
}

const std::vector<std::pair<const char*, SimulationSetup (*)()>> kJoined = {
    {"implicit", [] { return joined_setup(IntegratorKind::implicit_euler); }},
    {"adaptive", [] { return joined_setup(IntegratorKind::dormand_prince); }},
    {"dragged", dragged_setup},
    {"explicit", [] { return joined_setup(IntegratorKind::velocity_verlet); }}};

TEST(SharedSprings, BitsMatchOneProcess) {
    for (const auto& [name, make] : kJoined) {
        Simulation counted(make());
        while (!counted.finished()) counted.step();
        EXPECT_GT(counted.statistics().springs_broken, 0U) << name;
        EXPECT_GT(counted.statistics().springs_lost, 0U) << name;
        const Outcome alone = run(make, nullptr);
        for (const std::size_t count : {2U, 3U}) {
            EXPECT_EQ(difference(run_on(count, make), alone), "none") << name << ", " << count << " ranks";
        }
    }
}

TEST(SharedSprings, RunContinuesWithAnyNumberOfRanks) {
    for (const auto& [name, make] : kJoined) {
        const Outcome alone = run(make, nullptr);
        const Outcome three = run_on(3, make, {}, 20);
        const Outcome two = run_on(2, make, {three.saved, {}}, 45);
        EXPECT_EQ(run_on(4, make, {two.saved, {}}).saved == alone.saved, true) << name;
        EXPECT_EQ(run(make, nullptr, {two.saved, {}}).saved == alone.saved, true) << name;
    }
}

TEST(SharedSprings, SpringsStayOnTheFirstRankWhileOthersMove) {
    std::vector<std::size_t> joined(3);
    std::uint64_t moved = 0;
    on_ranks(3, [&](const std::shared_ptr<Ranks>& ranks) {
        SimulationSetup setup = family_setup();
        for (int i = 0; i < 20; ++i) setup.particles.push_back(particle_of({0.1 * i, 2.0, 0.5}));
        for (std::uint64_t i = 0; i < 19; ++i) setup.springs.push_back({i, i + 1, 0.1, 50.0, 0.1});
        setup.ranks = ranks;
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        const std::vector<std::uint64_t>& ids = simulation.particles().id;
        joined[ranks->rank()] =
            static_cast<std::size_t>(std::count_if(ids.begin(), ids.end(), [](std::uint64_t id) { return id < 20; }));
        if (ranks->rank() == 0) moved = simulation.rank_balance().moved;
    });
    EXPECT_EQ(joined, (std::vector<std::size_t>{20, 0, 0}));
    EXPECT_GT(moved, 0U);
}

TEST(SharedSprings, DivergingSpringsEndAllRanks) {
    const auto make = [] {
        SimulationSetup setup = setup_of(0.1, 20.0);
        setup.options.integrator.kind = IntegratorKind::velocity_verlet;
        for (int i = 0; i < 60; ++i) setup.particles.push_back(particle_of({0, 0, 0.1 * i}));
        setup.springs.push_back({3, 4, 0.05, 1e6, 0.0});
        return setup;
    };
    const std::string alone = divergence_of(make, nullptr);
    EXPECT_NE(alone, "none");
    on_ranks(3, [&](const std::shared_ptr<Ranks>& ranks) { EXPECT_EQ(divergence_of(make, ranks), alone); });
}

TEST(SharedSprings, SpringsAreNotSavedByParts) {
    const Simulation simulation(joined_setup(IntegratorKind::implicit_euler));
    EXPECT_THROW(simulation.save_particles([](std::span<const std::byte>) {}), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
