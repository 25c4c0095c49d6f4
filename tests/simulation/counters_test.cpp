// Counters in whole simulations: closed forms of the number of passages, all kinds of motion, threads, saved states.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "simulation/pair_gas.h"
#include "support/counts.h"
#include "support/simple_meshes.h"
#include "support/simulations.h"
#include "support/thread_ranks.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kG = 9.81;

CounterDescription counter_at(const Vec3& center, double radius, const Vec3& normal = {0, 0, 1}) {
    return {"counter", DiskCounter{center, normal, radius}};
}

ColliderDescription floor_plane() { return {"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}; }

Simulation finished(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    return simulation;
}

/// Expects that each of the first counters has a balance equal to the number of particles that have changed sides.
void expect_balance(SimulationSetup setup, std::size_t least_passages) {
    const auto in_front = [&](const std::vector<Vec3>& positions, const CounterDescription& description) {
        const auto& counter = std::get<DiskCounter>(description.shape);
        std::int64_t count = 0;
        for (const Vec3& position : positions) count += dot(counter.normal, position - counter.center) >= 0.0 ? 1 : 0;
        return count;
    };
    const std::vector<CounterDescription> counters = setup.counters;
    std::vector<Vec3> before;
    for (const Particle& particle : setup.particles) before.push_back(particle.position);
    const Simulation simulation = finished(std::move(setup));
    for (std::size_t k = 0; k < counters.size(); ++k) {
        const CounterTotals& totals = simulation.counters()[k];
        EXPECT_EQ(static_cast<std::int64_t>(totals.forward) - static_cast<std::int64_t>(totals.backward),
                  in_front(simulation.particles().position, counters[k]) - in_front(before, counters[k]));
        EXPECT_GE(totals.forward + totals.backward, least_passages);
    }
}

/// Number of times that an elastic ball, dropped from a height of 1 m at 0 s, falls through a height.
std::uint64_t falls_through(double height, double duration, double* rises) {
    const double fall = std::sqrt(2.0 / kG);
    const double down = std::sqrt(2.0 * (1.0 - height) / kG);
    const auto count = [&](double first) {
        return first > duration ? 0.0 : std::floor((duration - first) / (2 * fall)) + 1;
    };
    *rises = count(2.0 * fall - down);
    return static_cast<std::uint64_t>(count(down));
}

TEST(Counters, BouncingBallPassesOncePerFallAndRise) {
    for (const double height : {0.001, 0.5, 0.93}) {
        double rises = 0.0;
        const std::uint64_t falls = falls_through(height, 20.0, &rises);
        for (const double time_step : {0.001, 0.0137, 0.4, 3.0}) {
            SCOPED_TRACE(::testing::Message() << height << " m, steps of " << time_step << " s");
            SimulationSetup setup = setup_of(time_step, 20.0, {}, {0, 0, -kG});
            setup.colliders.push_back(floor_plane());
            setup.particles.push_back(particle_of({0.1, 0, 1}));
            setup.particles.back().mass = 0.25;
            setup.counters = {counter_at({0, 0, height}, 0.11), counter_at({0, 0, height}, 0.09)};
            setup.counters[1].name = "beside";
            const Simulation simulation = finished(std::move(setup));
            const CounterTotals& totals = simulation.counters()[0];
            EXPECT_EQ(totals.backward, falls);
            EXPECT_EQ(totals.forward, static_cast<std::uint64_t>(rises));
            EXPECT_EQ(totals.backward_mass, 0.25 * static_cast<double>(falls));
            EXPECT_EQ(totals.forward_mass, 0.25 * rises);
            EXPECT_EQ(simulation.counters()[1].forward + simulation.counters()[1].backward, 0U);
        }
    }
}

TEST(Counters, BallThatLosesHeightPassesUntilItsApexIsBelow) {
    // The apex after n bounces is 0.8^(2 n) m: 0.64 after the first, then below 0.5.
    for (const ResponseKind kind : response_kinds()) {
        SCOPED_TRACE(name_of(kind));
        SimulationSetup setup = setup_of(0.001, 3.0, {.name = "m", .restitution = 0.8}, {0, 0, -kG});
        setup.options.response = kind;
        setup.colliders.push_back(floor_plane());
        setup.particles.push_back(particle_of({0, 0, 1}));
        setup.counters = {counter_at({0, 0, 0.5}, 1.0)};
        const Simulation simulation = finished(std::move(setup));
        EXPECT_EQ(simulation.counters()[0].backward, 2U);
        EXPECT_EQ(simulation.counters()[0].forward, 1U);
    }
}

TEST(Counters, CirclingParticlePassesOncePerTurn) {
    // Turns of 1 s about the y axis. The disk holds only the side at x > 0, where the particle rises.
    const double rate = 2.0 * std::numbers::pi;
    for (const double time_step : {0.01, 0.07}) {
        SimulationSetup setup = setup_of(time_step, 10.4);
        setup.options.integrator = IntegratorKind::rk4;
        setup.forces.push_back(make_acceleration([rate](const ForceInput& p) { return -rate * rate * p.position; }));
        setup.particles.push_back(particle_of({0, 0, -1}, {rate, 0, 0}));
        setup.counters = {counter_at({1, 0, 0}, 0.5), counter_at({0, 0, 0}, 1.5)};
        setup.counters[1].name = "both sides";
        const Simulation simulation = finished(std::move(setup));
        EXPECT_EQ(simulation.counters()[0].forward, 11U);
        EXPECT_EQ(simulation.counters()[0].backward, 0U);
        EXPECT_EQ(simulation.counters()[1].forward, 11U);
        EXPECT_EQ(simulation.counters()[1].backward, 10U);
    }
}

TEST(Counters, ParticleThatStopsOnTheDiskIsCountedOnce) {
    // Each step of 1/4 s moves the particle by 1/4 m, so it is exactly on the disk after two steps.
    for (const double sign : {1.0, -1.0}) {
        SimulationSetup setup = setup_of(0.25, 1.0);
        setup.particles.push_back(particle_of({0, 0, -0.5 * sign}, {0, 0, sign}));
        setup.counters = {counter_at({0, 0, 0}, 1.0)};
        Simulation simulation(std::move(setup));
        std::vector<std::uint64_t> counts;
        while (!simulation.finished()) {
            simulation.step();
            const CounterTotals& totals = simulation.counters()[0];
            counts.push_back(sign > 0.0 ? totals.forward : totals.backward);
            EXPECT_EQ(sign > 0.0 ? totals.backward : totals.forward, 0U);
        }
        const std::vector<std::uint64_t> rising{0, 1, 1, 1};
        const std::vector<std::uint64_t> falling{0, 0, 1, 1};
        EXPECT_EQ(counts, sign > 0.0 ? rising : falling);
    }
}

TEST(Counters, ParticlesThatAreRemovedInTheStepCount) {
    const auto counted = [](const std::function<void(SimulationSetup&)>& change) {
        SimulationSetup setup = setup_of(1.0, 1.0);
        setup.particles.push_back(particle_of({0, 0, 1}, {0, 0, -4}));
        setup.counters = {counter_at({0, 0, 0.5}, 1.0, {0, 0, -1})};
        change(setup);
        const Simulation simulation = finished(std::move(setup));
        EXPECT_EQ(simulation.particles().size(), 0U);
        EXPECT_EQ(simulation.counters()[0].backward, 0U);
        return simulation.counters()[0].forward;
    };
    EXPECT_EQ(counted([](SimulationSetup& s) {
                  s.materials[0].absorption = 1.0;
                  s.colliders.push_back(floor_plane());
              }),
              1U);
    EXPECT_EQ(counted([](SimulationSetup& s) { s.bounds = Box3{{-1, -1, -1}, {1, 1, 2}}; }), 1U);
    EXPECT_EQ(counted([](SimulationSetup& s) { s.particles[0].lifetime = 0.2; }), 1U);
    EXPECT_EQ(counted([](SimulationSetup& s) { s.particles[0].lifetime = 0.1; }), 0U);
}

/// Rain that bounces, has children at impacts, is absorbed at times and leaves a box.
SimulationSetup rain(ResponseKind response = ResponseKind::exact) {
    SimulationSetup setup =
        setup_of(0.02, 1.2, {.name = "m", .restitution = 0.7, .friction = 0.2, .absorption = 0.05}, {0, 0, -kG});
    setup.options.seed = 4;
    setup.options.response = response;
    setup.colliders.push_back(floor_plane());
    EmitterDescription emitter;
    emitter.name = "cloud";
    emitter.shape = BoxShape{{0, 0, 0.8}, {1, 1, 0.3}};
    emitter.rate = {600.0, 100.0};
    emitter.mass = {0.1, 0.07};
    emitter.radius = {0.01, 0.005};
    emitter.lifetime = {0.8, 0.2};
    setup.emitters.push_back(emitter);
    EmitterDescription child;
    child.name = "splash";
    child.shape = PointShape{};
    child.speed = {2.0, 1.0};
    child.mass = {0.01, 0.005};
    ParentRule rule;
    rule.on = BirthEvent::impact;
    rule.share = false;
    rule.count = {2.0, 0.0};
    child.parent = rule;
    setup.emitters.push_back(child);
    setup.bounds = Box3{{-0.7, -0.7, -1}, {0.7, 0.7, 2}};
    setup.counters = {counter_at({0, 0, 0.1}, 0.4), counter_at({0.1, 0, 0.5}, 0.6, {1, 0, 2})};
    setup.counters[1].name = "tilted";
    auto ball = std::make_shared<const TriangleMesh>(testing::sphere_mesh({0, 0, 0.5}, 0.35, 2));
    setup.counters.push_back({"plane", PlaneCounter{{0, 0, 0.2}, {1, 0, 3}}, {{PassageQuantity::speed, {0, 5}, 10}}});
    setup.counters.push_back({"gate", RectangleCounter{{0, 0, 0.3}, {0, 0, 1}, {1, 1, 0}, {0.8, 0.6}}});
    setup.counters.push_back({"box", BoxCounter{{0, 0, 0.5}, {0.6, 0.6, 0.6}}, {{PassageQuantity::time, {0, 1}, 8}}});
    setup.counters.push_back({"ball", MeshCounter{std::move(ball)}});
    return setup;
}

/// Returns numbers as text with every bit.
std::string bits_of(std::initializer_list<double> numbers) {
    std::string text;
    for (const double number : numbers) {
        char word[40];
        std::snprintf(word, sizeof word, " %a", number);
        text += word;
    }
    return text;
}

std::string bits_of(const RunningMean& mean) {
    return bits_of({static_cast<double>(mean.count), mean.mean, mean.squares});
}

std::string bits_of(const PassageStatistics& s) {
    return bits_of(
               {s.momentum.x, s.momentum.y, s.momentum.z, s.kinetic_energy, s.spin_energy, s.first_time, s.last_time}) +
           bits_of(s.speed) + bits_of(s.angle) + bits_of(s.radius) + bits_of(s.spin);
}

/// Returns all totals as text with every bit.
std::string text_of(const std::vector<CounterTotals>& all) {
    std::string text;
    for (const CounterTotals& totals : all) {
        text += totals.name + " " + std::to_string(totals.forward) + " " + std::to_string(totals.backward) + "\n";
        text += bits_of({totals.forward_mass, totals.backward_mass, static_cast<double>(totals.particles)}) + "\n";
        text += bits_of(totals.forward_statistics) + "\n" + bits_of(totals.backward_statistics) + "\n";
        text += bits_of(totals.first_passage) + bits_of(totals.residence);
        for (const PassageHistogram& histogram : totals.histograms) {
            for (const auto* const bins : {&histogram.forward, &histogram.backward}) {
                for (const std::uint64_t count : *bins) text += " " + std::to_string(count);
            }
        }
        text += "\n";
    }
    return text;
}

bool has_passages_of_all(const std::vector<CounterTotals>& all) {
    return std::ranges::all_of(all, [](const CounterTotals& c) { return c.forward > 0 && c.backward > 0; });
}

TEST(Counters, TotalsDoNotDependOnThreadsSwitchesOrVerification) {
    for (const ResponseKind kind : response_kinds()) {
        SCOPED_TRACE(name_of(kind));
        const auto run = [&](int threads, const std::function<void(SimulationSetup&)>& change) {
            const ThreadLimit limit(threads);
            SimulationSetup setup = rain(kind);
            change(setup);
            const Simulation simulation = finished(std::move(setup));
            EXPECT_TRUE(has_passages_of_all(simulation.counters()));
            return text_of(simulation.counters());
        };
        const std::string one = run(1, [](SimulationSetup&) {});
        EXPECT_EQ(run(2, [](SimulationSetup&) {}), one);
        EXPECT_EQ(run(7, [](SimulationSetup&) {}), one);
        EXPECT_EQ(run(2, [](SimulationSetup& s) { s.options.verify = true; }), one);
        EXPECT_EQ(run(2, [](SimulationSetup& s) { s.acceleration.look_ahead = false; }), one);
        EXPECT_EQ(run(2, [](SimulationSetup& s) { s.acceleration.sleeping = false; }), one);
    }
}

// With drag, particles fly in free spaces beside the mesh.
TEST(Counters, TotalsUnderDragDoNotDependOnKnownFreeSpace) {
    const auto run = [](const std::function<void(SimulationSetup&)>& change) {
        SimulationSetup setup = rain();
        setup.forces.push_back(make_linear_drag(0.05));
        auto ground = std::make_shared<const TriangleMesh>(testing::floor_mesh(1.0, 8));
        setup.colliders = {{"ground", MeshShape{std::move(ground), {}, "", {}}, 0}};
        change(setup);
        const Simulation simulation = finished(std::move(setup));
        EXPECT_TRUE(has_passages_of_all(simulation.counters()));
        return text_of(simulation.counters());
    };
    const std::string one = run([](SimulationSetup&) {});
    EXPECT_EQ(run([](SimulationSetup& s) { s.acceleration.look_ahead = false; }), one);
    EXPECT_EQ(run([](SimulationSetup& s) { s.acceleration.culling = false; }), one);
    EXPECT_EQ(run([](SimulationSetup& s) { s.options.verify = true; }), one);
}

TEST(Counters, FreeFlightsAreMeasuredLikeQueriedFlightsByAllIntegrators) {
    for (std::size_t kind = 0; kind < integrator_names().size(); ++kind) {
        SCOPED_TRACE(integrator_names()[kind]);
        const auto run = [&](bool look_ahead) {
            SimulationSetup setup = rain();
            setup.options.integrator = static_cast<IntegratorKind>(kind);
            setup.acceleration.look_ahead = look_ahead;
            return text_of(finished(std::move(setup)).counters());
        };
        EXPECT_EQ(run(true), run(false));
    }
}

TEST(Counters, RunWithCountersHasTheBitsOfARunWithout) {
    const Simulation counted = finished(rain());
    SimulationSetup setup = rain();
    setup.counters.clear();
    const Simulation plain = finished(std::move(setup));
    EXPECT_EQ(counted.state_hash(), plain.state_hash());
    EXPECT_TRUE(plain.counters().empty());
}

TEST(Counters, DeferredStepsCountLikeSingleSteps) {
    SimulationSetup setup = rain();
    setup.bounds.reset();
    const std::string single = text_of(finished(std::move(setup)).counters());
    SimulationSetup again = rain();
    again.bounds.reset();
    Simulation simulation(std::move(again));
    simulation.advance(1000);
    EXPECT_EQ(text_of(simulation.counters()), single);
}

std::vector<std::byte> saved(const Simulation& simulation) {
    std::vector<std::byte> bytes;
    simulation.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    return bytes;
}

void restore(Simulation& simulation, const std::vector<std::byte>& bytes) {
    std::size_t at = 0;
    simulation.restore([&](std::span<std::byte> part) {
        if (bytes.size() - at < part.size()) throw InputError("the file ends too early");
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
}

TEST(Counters, SavedRunContinuesWithTheSameTotals) {
    Simulation whole(rain());
    while (whole.step_index() < 30) whole.step();
    Simulation resumed(rain());
    restore(resumed, saved(whole));
    EXPECT_EQ(text_of(resumed.counters()), text_of(whole.counters()));
    while (!whole.finished()) whole.step();
    while (!resumed.finished()) resumed.step();
    EXPECT_EQ(text_of(resumed.counters()), text_of(whole.counters()));
}

TEST(Counters, StateOfOtherCountersIsRefused) {
    const std::vector<std::byte> bytes = saved(Simulation(rain()));
    for (const bool has_none : {true, false}) {
        SimulationSetup setup = rain();
        has_none ? setup.counters.clear() : void(std::get<DiskCounter>(setup.counters[0].shape).radius = 0.3);
        Simulation other(std::move(setup));
        try {
            restore(other, bytes);
            ADD_FAILURE();
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()),
                      "the state belongs to other options, materials, bodies, bounds or counters");
        }
    }
}

TEST(Counters, StoppedStepIsNotCounted) {
    Simulation whole(rain());
    while (!whole.finished()) whole.step();
    Simulation stopped(rain());
    std::atomic<int> left = 0;
    int stops = 0;
    for (int k = 1; !stopped.finished(); ++k) {
        left = k % 3 == 0 ? 2 : 1000000;  // every third attempt ends within its step
        try {
            stopped.advance(1, {}, [&] { return --left > 0; });
        } catch (const StoppedError&) {
            ++stops;
        }
    }
    EXPECT_GT(stops, 5);
    EXPECT_EQ(text_of(stopped.counters()), text_of(whole.counters()));
}

TEST(Counters, BalanceHoldsForSpheresThatMeet) {
    for (const PairMethod method : {PairMethod::events, PairMethod::contacts, PairMethod::automatic}) {
        SimulationSetup setup = testing::Gas{0.2, 100, 0.9}.setup(0.2, test::scaled(20));
        setup.options.particle_contacts->method = method;
        setup.counters = {counter_at({0, 0, 0.3}, 1e3, {0.1, 0, 1}), counter_at({0, 0, 0}, 1e3, {1, 0, 0})};
        setup.counters[1].name = "x";
        expect_balance(std::move(setup), static_cast<std::size_t>(test::scaled(20)));
    }
}

TEST(Counters, BalanceHoldsForSprings) {
    SimulationSetup setup = setup_of(0.01, 2.0, {.name = "m", .restitution = 0.5, .friction = 0.3}, {0, 0, -kG});
    setup.colliders.push_back(floor_plane());
    for (int k = 0; k < 10; ++k) {
        setup.particles.push_back(particle_of({0.1 * k, 0, 0.5 + 0.02 * k}, {0, 0, 1.0 + k}));
        if (k == 0) continue;
        setup.springs.push_back({static_cast<std::uint64_t>(k - 1), static_cast<std::uint64_t>(k), 0.1, 300.0, 0.1});
    }
    setup.counters = {counter_at({0, 0, 0.6}, 1e3)};
    expect_balance(std::move(setup), 10);
}

TEST(Counters, ChildrenOfCloudsCount) {
    // A child circles its parent at rest once per second, and passes the plane of the disk twice per turn.
    SimulationSetup setup = setup_of(0.05, 3.3);
    EmitterDescription parent;
    parent.name = "parent";
    parent.shape = PointShape{{0, 0, 0}};
    parent.burst = 1;
    setup.emitters.push_back(parent);
    EmitterDescription child;
    child.name = "child";
    child.shape = BoxShape{{0.1, 0, 0.4}, {0, 0, 0}};
    ParentRule rule;
    rule.on = BirthEvent::birth;
    rule.count = {1.0, 0.0};
    rule.cloud = CloudRule{};
    rule.cloud->turning = {0, 2.0 * std::numbers::pi, 0};
    child.parent = rule;
    setup.emitters.push_back(child);
    setup.counters = {counter_at({0, 0, 0}, 1.0)};
    const Simulation simulation = finished(std::move(setup));
    EXPECT_EQ(simulation.counters()[0].backward, 4U);
    EXPECT_EQ(simulation.counters()[0].forward, 3U);
}

TEST(Counters, SharedRunIsRefused) {
    testing::on_ranks(2, [&](const std::shared_ptr<Ranks>& ranks) {
        SimulationSetup setup = rain();
        setup.ranks = ranks;
        try {
            const Simulation simulation(std::move(setup));
            ADD_FAILURE();
        } catch (const InputError& error) {
            EXPECT_EQ(std::string(error.what()),
                      "counters: ranks: found 2, expected 1 (run it in one process, with threads): each process counts "
                      "only its own particles");
        }
    });
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
