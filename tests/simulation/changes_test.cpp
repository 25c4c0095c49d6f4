// Particles, forces and callbacks that change between steps.
#include <gtest/gtest.h>

#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/simulation.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr Vec3 kDown{0, 0, -9.81};

std::vector<std::unique_ptr<Force>> gravity(const Vec3& acceleration) {
    std::vector<std::unique_ptr<Force>> forces;
    forces.push_back(make_gravity(acceleration));
    return forces;
}

Particle ball(const Vec3& position, const Vec3& velocity = {}) {
    Particle particle;
    particle.position = position;
    particle.velocity = velocity;
    particle.radius = 0.01;
    return particle;
}

/// Returns balls that bounce and come to rest in a box without a lid.
SimulationSetup box_of_balls(std::size_t count) {
    SimulationSetup setup;
    setup.options.time_step = 0.01;
    setup.options.duration = 3.0;
    setup.options.seed = 3;
    setup.forces = gravity(kDown);
    Material soft;
    soft.restitution = 0.5;
    soft.friction = 0.4;
    setup.materials.push_back(soft);
    setup.colliders.push_back({"box", CuboidShape{{4, 4, 4}, {}}, 0});
    for (std::size_t k = 0; k < count; ++k) {
        const auto x = static_cast<double>(k);
        setup.particles.push_back(ball({-1.5 + 0.0031 * x, 1.5 - 0.0027 * x, -1.0 + 0.0023 * x}, {0.5, -0.3, 0.1}));
    }
    return setup;
}

/// Adds and removes particles and changes forces between steps. Returns the final state hash.
std::uint64_t changing_run(SimulationSetup setup, int threads, bool at_once) {
    const ThreadLimit limit(threads);
    Simulation simulation(std::move(setup));
    std::uint64_t contacts = 0;
    simulation.on_contact([&](std::span<const ContactRecord> records) {
        for (const ContactRecord& record : records) contacts = contacts * 31 + record.particle + 1;
    });
    const auto change = [&] {
        const std::uint64_t step = simulation.step_index();
        if (step == 40) (void)simulation.add_particle(ball({0.1, 0.2, 0.3}, {1, 2, 3}));
        if (step == 70) {
            EXPECT_EQ(simulation.remove_particles(std::vector<std::uint64_t>{3, 5, 99999}), 2U);
        }
        if (step == 150) simulation.set_forces(gravity({3.0, 0.0, -9.0}));
        if (step == 220) simulation.set_forces({});
        return true;
    };
    if (at_once) {
        simulation.advance(simulation.step_count(), change);
    } else {
        while (!simulation.finished()) {
            simulation.step();
            (void)change();
        }
    }
    EXPECT_EQ(simulation.statistics().removed, 2U);
    return simulation.state_hash() ^ contacts;
}

TEST(Changes, BitsDoNotDependOnThreadsSwitchesOrCalls) {
    const std::uint64_t expected = changing_run(box_of_balls(700), 1, false);
    for (const int threads : {2, 7}) EXPECT_EQ(changing_run(box_of_balls(700), threads, false), expected) << threads;
    EXPECT_EQ(changing_run(box_of_balls(700), 2, true), expected);
    for (int without = 0; without < 5; ++without) {
        SimulationSetup setup = box_of_balls(700);
        setup.acceleration.look_ahead = without != 0;
        setup.acceleration.deferred_steps = without != 1;
        setup.acceleration.sleeping = without != 2;
        setup.acceleration.spatial_order = without != 3;
        setup.acceleration.culling = without != 4;
        EXPECT_EQ(changing_run(std::move(setup), 2, true), expected) << without;
    }
}

TEST(Changes, ParticleIsBornWhenItIsAdded) {
    SimulationSetup setup = box_of_balls(1);
    Simulation simulation(std::move(setup));
    simulation.advance(10);
    Particle late = ball({0, 0, 1});
    late.birth_time = -5.0;
    late.lifetime = 0.2;
    const std::uint64_t id = simulation.add_particle(late);
    EXPECT_EQ(id, 1U);
    EXPECT_EQ(simulation.particles().birth_time[1], simulation.time());
    EXPECT_EQ(simulation.statistics().emitted, 2U);
    simulation.advance(19);
    EXPECT_EQ(simulation.particles().size(), 2U);
    simulation.advance(2);
    EXPECT_EQ(simulation.particles().size(), 1U);
    EXPECT_FALSE(simulation.remove_particle(id));
    EXPECT_TRUE(simulation.remove_particle(0));
    EXPECT_EQ(simulation.particles().size(), 0U);
    simulation.step();
}

TEST(Changes, NewForcesWakeSleepersAndChangeFreeFlights) {
    SimulationSetup setup = box_of_balls(0);
    setup.particles.push_back(ball({0, 0, -1.99}));
    setup.particles.push_back(ball({1, 1, 1.9}, {0, 0, 0}));
    Simulation simulation(std::move(setup));
    simulation.advance(20);
    EXPECT_EQ(simulation.statistics().asleep, 1U);
    simulation.set_forces(gravity({0, 0, 9.81}));
    EXPECT_EQ(simulation.statistics().asleep, 0U);
    const double height = simulation.particles().position[0].z;
    const double speed = simulation.particles().velocity[1].z;
    simulation.advance(10);
    EXPECT_GT(simulation.particles().position[0].z, height + 0.01);
    EXPECT_NEAR(simulation.particles().velocity[1].z, speed + 0.981, 1e-9);
    simulation.set_forces({});
    const Vec3 velocity = simulation.particles().velocity[0];
    simulation.advance(3);
    EXPECT_EQ(simulation.particles().velocity[0], velocity);
}

TEST(Changes, WeightOfSleepersIsRecordedUntilTheyAreRemoved) {
    const auto impulse = [](bool sleeping) {
        SimulationSetup setup = box_of_balls(0);
        setup.materials[0].restitution = 0.0;
        setup.acceleration.sleeping = sleeping;
        setup.particles.push_back(ball({0.3, 0.1, -1.99}));
        Simulation simulation(std::move(setup));
        simulation.advance(100);
        EXPECT_TRUE(simulation.remove_particle(0));
        EXPECT_EQ(simulation.statistics().resting, 0U);
        simulation.advance(100);
        Vec3 sum;
        for (const Vec3& part : simulation.triangle_totals(0).impulse) sum += part;
        return sum;
    };
    EXPECT_NEAR(impulse(true).z, -9.81, 1e-6);
    EXPECT_NEAR(impulse(true).z, impulse(false).z, 1e-9);
}

TEST(Changes, SavedStateIncludesChangesExceptForces) {
    const auto finish = [](Simulation& simulation) {
        simulation.set_forces(gravity({1, 0, -5}));
        simulation.advance(simulation.step_count());
        return simulation.state_hash();
    };
    Simulation first(box_of_balls(50));
    first.advance(60);
    (void)first.add_particle(ball({0.5, 0.5, 0.5}, {0, 0, 4}));
    EXPECT_TRUE(first.remove_particle(7));
    first.advance(5);
    std::vector<std::byte> bytes;
    first.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    Simulation second(box_of_balls(50));
    std::size_t read = 0;
    second.restore([&](std::span<std::byte> part) {
        std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(read), part.size(), part.begin());
        read += part.size();
    });
    EXPECT_EQ(second.state_hash(), first.state_hash());
    EXPECT_EQ(second.statistics().removed, 1U);
    EXPECT_EQ(finish(second), finish(first));
}

TEST(Changes, AddedParticlesMoveCoupledAndRemovedOnesLoseTheirSprings) {
    SimulationSetup setup = box_of_balls(3);
    setup.springs.push_back({0, 1, 0.01, 10.0, 0.1});
    setup.springs.push_back({1, 2, 0.01, 10.0, 0.1});
    Simulation simulation(std::move(setup));
    simulation.advance(5);
    EXPECT_TRUE(simulation.remove_particle(2));
    (void)simulation.add_particle(ball({0, 0, 0}));
    simulation.advance(5);
    EXPECT_EQ(simulation.statistics().springs_lost, 1U);
    EXPECT_TRUE(simulation.springs().is_intact(0));
}

std::string what_run_error_says(const std::function<void()>& call) {
    try {
        call();
    } catch (const RunError& error) {
        return error.what();
    }
    return "no RunError";
}

TEST(Changes, ChangesInAStepOrAfterAFailedOneAreRefusedWithTheReason) {
    SimulationSetup setup;
    Simulation* running = nullptr;
    std::string within;
    setup.forces.push_back(make_acceleration([&](const ForceInput&) -> Vec3 {
        within = what_run_error_says([&] { running->add_particle({}); });
        throw std::runtime_error("no force today");
    }));
    setup.particles.emplace_back();
    Simulation simulation(std::move(setup));
    running = &simulation;
    EXPECT_THROW(simulation.step(), std::runtime_error);
    EXPECT_NE(within.find("between its steps"), std::string::npos) << within;
    for (const std::string& after : {what_run_error_says([&] { simulation.add_particle({}); }),
                                     what_run_error_says([&] { simulation.remove_particle(0); }),
                                     what_run_error_says([&] { simulation.set_forces({}); })}) {
        EXPECT_NE(after.find("the last step or restore() of this simulation has ended with an error"),
                  std::string::npos)
            << after;
    }
}

TEST(OnContact, CallbackGetsTheRecordsOfEveryStepInOrder) {
    SimulationSetup setup = box_of_balls(300);
    setup.options.record_contacts = true;
    Simulation recorded(std::move(setup));
    Simulation called(box_of_balls(300));
    std::vector<std::pair<double, std::uint64_t>> expected;
    std::vector<std::pair<double, std::uint64_t>> seen;
    called.on_contact([&](std::span<const ContactRecord> records) {
        EXPECT_FALSE(records.empty());
        for (const ContactRecord& record : records) seen.emplace_back(record.time, record.particle);
    });
    for (int k = 0; k < 200; ++k) {
        recorded.step();
        for (const ContactRecord& record : recorded.contact_records()) {
            expected.emplace_back(record.time, record.particle);
        }
    }
    called.advance(200);
    EXPECT_FALSE(expected.empty());
    EXPECT_EQ(seen, expected);
    EXPECT_EQ(called.state_hash(), recorded.state_hash());
    called.on_contact({});
    called.advance(50);
    EXPECT_EQ(seen.size(), expected.size());
    EXPECT_TRUE(called.contact_records().empty());
}

TEST(OnContact, CallbackMayChangeTheSimulationButNotStepIt) {
    Simulation simulation(box_of_balls(20));
    std::size_t removed = 0;
    simulation.on_contact([&](std::span<const ContactRecord> records) {
        EXPECT_THROW(simulation.step(), RunError);
        EXPECT_THROW(simulation.advance(2), RunError);
        removed += simulation.remove_particle(records.front().particle) ? 1U : 0U;
    });
    simulation.advance(simulation.step_count());
    EXPECT_GT(removed, 0U);
    EXPECT_EQ(simulation.particles().size(), 20U - removed);
    EXPECT_EQ(simulation.statistics().removed, removed);
}

TEST(OnContact, ExceptionOfACallbackLeavesACompletedStep) {
    Simulation plain(box_of_balls(20));
    Simulation simulation(box_of_balls(20));
    simulation.on_contact([](std::span<const ContactRecord>) { throw std::runtime_error("stop"); });
    EXPECT_THROW(simulation.advance(simulation.step_count()), std::runtime_error);
    simulation.on_contact({});
    simulation.advance(simulation.step_count());
    plain.advance(plain.step_count());
    EXPECT_EQ(simulation.state_hash(), plain.state_hash());
}

TEST(ContactCallback, CallbackMayReplaceOrRemoveItself) {
    SimulationSetup setup;
    setup.options.time_step = 0.01;
    setup.options.duration = 2.0;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.materials.push_back({"wall", 0.9});
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    setup.particles.emplace_back().position = {0, 0, 0.2};
    Simulation simulation(std::move(setup));
    std::vector<std::string> calls;
    const std::string long_enough_to_be_elsewhere(100, 'x');
    simulation.on_contact([&, long_enough_to_be_elsewhere](std::span<const ContactRecord> records) {
        simulation.on_contact([&](std::span<const ContactRecord>) {
            calls.emplace_back("second");
            simulation.on_contact({});
        });
        calls.emplace_back("first " + std::to_string(records.size()) + long_enough_to_be_elsewhere.substr(99));
    });
    simulation.advance(simulation.step_count());
    EXPECT_EQ(calls, (std::vector<std::string>{"first 1x", "second"}));
}

TEST(ReleasedParticles, ReleasedParticlesKeepTheirMemoryAndTheRunItsBits) {
    Simulation lending(box_of_balls(40));
    Simulation plain(box_of_balls(40));
    for (int round = 0; round < 4; ++round) {
        const Vec3* lent = lending.particles().position.data();
        const std::vector<Vec3> before = lending.particles().position;
        const Particles released = lending.release_particles();
        lending.advance(40);
        plain.advance(40);
        EXPECT_EQ(released.position.data(), lent);
        EXPECT_EQ(released.position, before);
        EXPECT_NE(lending.particles().position.data(), lent);
        ASSERT_EQ(lending.state_hash(), plain.state_hash());
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
