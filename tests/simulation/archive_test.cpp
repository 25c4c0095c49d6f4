// A simulation that is saved, restored in another one and continued gives the same bits as one that was never stopped.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/core/hash.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/random.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simple_meshes.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns a setup with all features: emitters with rates, children, attributes, springs, rest, random walls, totals.
SimulationSetup busy_setup(ResponseKind response = ResponseKind::exact) {
    SimulationSetup setup;
    setup.options.time_step = 0.01;
    setup.options.duration = 1.5;
    setup.options.seed = 11;
    setup.options.response = response;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    Material rough;
    rough.restitution = 0.4;
    rough.friction = 0.3;
    rough.diffuse = 0.2;
    rough.absorption = 0.01;
    setup.materials.push_back(rough);
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    setup.attributes.push_back({"temperature", 1, {300.0, 0, 0}});
    setup.attributes.push_back({"mood", 3, {1, 2, 3}});
    EmitterDescription emitter;
    emitter.shape = DiskShape{{0, 0, 1}, {0, 0, -1}, 0.5};
    emitter.rate = {300.0, 60.0};
    emitter.lifetime = {0.9, 0.3};
    emitter.radius = {0.01, 0.005};
    emitter.attributes.push_back({"temperature", {400.0, 0, 0}, {50.0, 0, 0}});
    setup.emitters.push_back(emitter);
    for (int i = 0; i < 6; ++i) {
        Particle particle;
        particle.position = {0.2 * i, 1.0, 0.4};
        particle.mass = 0.1;
        particle.pinned = i == 0;
        particle.attributes = {{100.0 + i, 0, 0}};
        setup.particles.push_back(particle);
        if (i == 0) continue;
        Spring spring{static_cast<std::uint64_t>(i - 1), static_cast<std::uint64_t>(i), 0.2, 60.0, 0.2};
        if (i == 3) spring.breaking_stretch = 0.05;
        setup.springs.push_back(spring);
    }
    return setup;
}

std::vector<std::byte> saved(const Simulation& simulation) {
    std::vector<std::byte> bytes;
    simulation.save([&](std::span<const std::byte> part) {
        EXPECT_FALSE(part.empty());
        bytes.insert(bytes.end(), part.begin(), part.end());
    });
    return bytes;
}

void restore(Simulation& simulation, const std::vector<std::byte>& bytes) {
    std::size_t at = 0;
    simulation.restore([&](std::span<std::byte> part) {
        EXPECT_FALSE(part.empty());
        if (bytes.size() - at < part.size()) throw InputError("the file ends too early");
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
    EXPECT_EQ(at, bytes.size());
}

void run_to(Simulation& simulation, std::uint64_t step) {
    while (simulation.step_index() < step) simulation.step();
}

TEST(SavedSimulation, ContinuationHasTheSameBitsForAnyResponseAndThreads) {
    for (const ResponseKind kind : response_kinds()) {
        SCOPED_TRACE(name_of(kind));
        Simulation whole(busy_setup(kind));
        run_to(whole, 60);
        const std::vector<std::byte> bytes = saved(whole);
        run_to(whole, 150);
        EXPECT_GT(whole.statistics().contacts, 50U);

        const ThreadLimit limit(3);
        Simulation resumed(busy_setup(kind));
        restore(resumed, bytes);
        EXPECT_EQ(resumed.step_index(), 60U);
        EXPECT_EQ(saved(resumed), bytes);
        run_to(resumed, 150);
        EXPECT_EQ(resumed.state_hash(), whole.state_hash());
        // Compares every column, counter and total, because the hash does not cover all of them.
        EXPECT_EQ(saved(resumed), saved(whole));
    }
}

TEST(SavedSimulation, AttributesAndBrokenSpringsAreKept) {
    Simulation whole(busy_setup());
    run_to(whole, 100);
    EXPECT_EQ(whole.statistics().springs_broken, 1U);
    Simulation resumed(busy_setup());
    restore(resumed, saved(whole));
    EXPECT_FALSE(resumed.springs().is_intact(2));
    ASSERT_EQ(resumed.particles().size(), whole.particles().size());
    for (std::size_t i = 0; i < whole.particles().size(); ++i) {
        EXPECT_EQ(resumed.particles().attributes.at(i), whole.particles().attributes.at(i));
    }
    EXPECT_EQ(resumed.particles().attributes.value(0, 1).x, 101.0);
    EXPECT_EQ(resumed.triangle_totals(0).hits, whole.triangle_totals(0).hits);
    EXPECT_EQ(resumed.triangle_totals(0).impulse, whole.triangle_totals(0).impulse);
    EXPECT_EQ(resumed.triangle_totals(0).lasting_impulse, whole.triangle_totals(0).lasting_impulse);
}

TEST(SavedSimulation, VerificationStartsFromTheRestoredState) {
    Simulation whole(busy_setup());
    run_to(whole, 60);
    SimulationSetup setup = busy_setup();
    setup.options.verify = true;
    Simulation resumed(std::move(setup));
    restore(resumed, saved(whole));
    run_to(resumed, 150);
    run_to(whole, 150);
    EXPECT_EQ(resumed.statistics().violations, 0U);
    EXPECT_EQ(resumed.state_hash(), whole.state_hash());
}

TEST(SavedSimulation, OtherSetupAndTruncatedStateAreRefused) {
    Simulation whole(busy_setup());
    run_to(whole, 20);
    std::vector<std::byte> bytes = saved(whole);
    SimulationSetup other = busy_setup();
    other.options.time_step = 0.02;
    Simulation with_other_step(std::move(other));
    EXPECT_THROW(restore(with_other_step, bytes), InputError);
    SimulationSetup fewer = busy_setup();
    fewer.springs.pop_back();
    Simulation with_fewer_springs(std::move(fewer));
    EXPECT_THROW(restore(with_fewer_springs, bytes), InputError);
    bytes.pop_back();
    Simulation same(busy_setup());
    EXPECT_THROW(restore(same, bytes), InputError);
}

TEST(SavedSimulation, OtherOptionsMaterialsAndBoundsAreRefused) {
    Simulation whole(busy_setup());
    run_to(whole, 20);
    const std::vector<std::byte> bytes = saved(whole);
    const std::vector<std::function<void(SimulationSetup&)>> changes{
        [](SimulationSetup& s) { s.options.seed += 1; },
        [](SimulationSetup& s) { s.options.integrator = IntegratorKind::midpoint; },
        [](SimulationSetup& s) { s.options.bounce_budget += 1; },
        [](SimulationSetup& s) { s.materials[0].restitution *= 0.5; },
        [](SimulationSetup& s) {
            s.bounds = Box3{{-1e3, -1e3, -1e3}, {1e3, 1e3, 1234.0}};
        }};
    for (const auto& change : changes) {
        SimulationSetup other = busy_setup();
        change(other);
        Simulation simulation(std::move(other));
        EXPECT_THROW(restore(simulation, bytes), InputError);
    }
}

/// Returns a setup with a floor in the last of two frames, and a wall in the first.
SimulationSetup moving_setup(const std::vector<FrameDescription>& frames) {
    SimulationSetup setup = busy_setup();
    setup.frames = std::make_shared<const FrameTree>(frames);
    setup.colliders[0].frame = frames.back().name;
    setup.colliders.push_back({"wall", PlaneShape{{-3, 0, 0}, {1, 0, 0}}, 0, frames.front().name});
    return setup;
}

std::vector<FrameDescription> table_on_a_base() {
    const CurveKey<Vec3> begin{0.0, {}};
    return {{"base", "", {}, {0, 0, 1}, 0.0, {Spin{{0, 0, 1}, 10.0}, Oscillation{{0.1, 0, 0}, 1.0, 0.0}}},
            {"table",
             "base",
             {},
             {0, 0, 1},
             0.0,
             {KeyedTranslation{KeyedCurve<Vec3>({begin, {1.0, {0, 0, 0.1}}})}, Swing{{1, 0, 0}, 2.0, 1.0, 0.0},
              KeyedRotation{{0, 0, 1}, KeyedCurve<double>({{0.0, 0.0}, {2.0, 30.0}})}}}};
}

TEST(SavedSimulation, OtherMotionOfCollidersIsRefused) {
    const CurveKey<Vec3> begin{0.0, {}};
    const std::vector<FrameDescription> frames = table_on_a_base();
    Simulation whole(moving_setup(frames));
    run_to(whole, 20);
    const std::vector<std::byte> bytes = saved(whole);
    using Frames = std::vector<FrameDescription>;
    const std::vector<std::function<void(Frames&)>> changes{
        [](Frames& f) {
            f[0].motions[0] = Spin{{0, 0, 1}, 11.0};
        },
        [](Frames& f) {
            f[0].motions[0] = Spin{{0, 0, -1}, 10.0};
        },
        [](Frames& f) {
            f[0].motions[1] = Oscillation{{0.1, 0, 0}, 1.0, 1.0};
        },
        [](Frames& f) {
            f[0].motions[1] = Oscillation{{0.2, 0, 0}, 1.0, 0.0};
        },
        [](Frames& f) { std::swap(f[0].motions[0], f[0].motions[1]); },
        [&](Frames& f) {
            f[1].motions[0] = KeyedTranslation{KeyedCurve<Vec3>({begin, {1.0, {0, 0, 0.2}}})};
        },
        [&](Frames& f) {
            f[1].motions[0] = KeyedTranslation{
                KeyedCurve<Vec3>({begin, {1.0, {0, 0, 0.1}}}, Interpolation::linear, CurveEnds::repeat)};
        },
        [](Frames& f) {
            f[1].motions[1] = Swing{{1, 0, 0}, 2.0, 1.5, 0.0};
        },
        [](Frames& f) {
            f[1].motions[2] = KeyedRotation{{0, 0, 1}, KeyedCurve<double>({{0.0, 0.0}, {3.0, 30.0}})};
        },
        [](Frames& f) { f[1].motions.pop_back(); },
        [](Frames& f) { f[1].translation.z = -0.5; },
        [](Frames& f) { f[1].rotation_degrees = 1.0; },
        [](Frames& f) { f[1].parent.clear(); }};
    for (std::size_t k = 0; k < changes.size(); ++k) {
        Frames other = frames;
        changes[k](other);
        Simulation simulation(moving_setup(other));
        EXPECT_THROW(restore(simulation, bytes), InputError) << "change " << k;
    }
}

TEST(SavedSimulation, ExchangedFramesAreRefusedAndRenamedOnesAreNot) {
    using Frames = std::vector<FrameDescription>;
    const Frames frames = table_on_a_base();
    Simulation whole(moving_setup(frames));
    run_to(whole, 20);
    const std::vector<std::byte> bytes = saved(whole);
    SimulationSetup exchanged = moving_setup(frames);
    std::swap(exchanged.colliders[0].frame, exchanged.colliders[1].frame);
    Simulation with_others(std::move(exchanged));
    EXPECT_THROW(restore(with_others, bytes), InputError);
    // Names have no effect on motion.
    Frames renamed = frames;
    renamed[0].name = renamed[1].parent = "ground";
    Simulation same(moving_setup(renamed));
    restore(same, bytes);
    run_to(whole, 40);
    run_to(same, 40);
    EXPECT_EQ(same.state_hash(), whole.state_hash());
}

TEST(SavedSimulation, DamagedByteIsRefused) {
    Simulation whole(busy_setup());
    run_to(whole, 3);
    std::vector<std::byte> bytes = saved(whole);
    const std::size_t every = std::max<std::size_t>(1, bytes.size() / 200);
    for (std::size_t k = 0; k < bytes.size(); k += every) {
        bytes[k] ^= std::byte{0x81};
        Simulation same(busy_setup());
        EXPECT_THROW(restore(same, bytes), InputError) << "byte " << k << " of " << bytes.size();
        bytes[k] ^= std::byte{0x81};
    }
    Simulation same(busy_setup());
    restore(same, bytes);
    EXPECT_EQ(same.state_hash(), whole.state_hash());
}

/// Writes the valid checksum of a modified state.
void sign(std::vector<std::byte>& bytes) {
    constexpr std::size_t kSize = sizeof(std::uint64_t);
    StateHash checksum;
    checksum.add(std::span(bytes).first(bytes.size() - kSize));
    const std::uint64_t value = checksum.value();
    std::memcpy(bytes.data() + bytes.size() - kSize, &value, kSize);
}

// The checksum protects against accidents. A forged state with a valid checksum is refused, or is an ordinary state.
TEST(SavedSimulation, ForgedStateIsRefusedOrContinues) {
    Simulation whole(busy_setup());
    run_to(whole, 40);
    const std::vector<std::byte> bytes = saved(whole);
    const int cases = test::scaled(300 * test::case_factor(20));
    int refused = 0;
    for (int k = 0; k < cases; ++k) {
        RandomSequence random(17, 3, static_cast<std::uint64_t>(k));
        std::vector<std::byte> forged = bytes;
        const int changes = 1 + static_cast<int>(3 * random.uniform());
        for (int c = 0; c < changes; ++c) {
            const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(forged.size() - 8));
            forged[at] ^= std::byte{1} << static_cast<int>(8 * random.uniform());
        }
        sign(forged);
        Simulation same(busy_setup());
        try {
            restore(same, forged);
            for (int step = 0; step < 3; ++step) same.step();
        } catch (const InputError&) {
            ++refused;
        } catch (const RunError&) {  // the motion diverges
        }
    }
    EXPECT_GT(refused, 0);
    EXPECT_LT(refused, cases);
}

TEST(SavedSimulation, ParticleOutOfRangeIsRefused) {
    const auto setup = [] {
        SimulationSetup one;
        one.particles.push_back({0, {0.123456789, 0, 0}, {}, 1.0, 0.987654321});
        return one;
    };
    for (const double value : {0.123456789, 0.987654321}) {
        for (const double other : {2.0, 1e80, -1.0}) {
            SCOPED_TRACE(::testing::Message() << other << " instead of " << value);
            std::vector<std::byte> bytes = saved(Simulation(setup()));
            const auto written = std::as_bytes(std::span(&value, 1));
            const auto found = std::search(bytes.begin(), bytes.end(), written.begin(), written.end());
            ASSERT_NE(found, bytes.end());
            std::memcpy(&*found, &other, sizeof(other));
            sign(bytes);
            Simulation same(setup());
            const bool is_good = other == 2.0 || (other == -1.0 && value == 0.123456789);
            if (is_good) {
                EXPECT_NO_THROW(restore(same, bytes));
            } else {
                EXPECT_THROW(restore(same, bytes), InputError);
            }
        }
    }
}

TEST(SavedSimulation, EmittersThatHaveEmittedRefuseAState) {
    Simulation whole(busy_setup());
    run_to(whole, 3);
    EXPECT_THROW(restore(whole, saved(whole)), InputError);
}

TEST(SavedSimulation, RunContinuesAfterAnErrorInsideAStep) {
    bool fails = false;
    const auto setup = [&fails] {
        SimulationSetup made;
        made.options.time_step = 0.1;
        made.options.duration = 2.0;
        made.forces.push_back(make_acceleration([&fails](const ForceInput&) {
            if (fails) throw std::runtime_error("no force today");
            return Vec3{0, 0, -1};
        }));
        made.particles.emplace_back();
        return made;
    };
    Simulation simulation(setup());
    simulation.step();
    const std::vector<std::byte> kept = saved(simulation);
    fails = true;
    EXPECT_THROW(simulation.step(), std::runtime_error);
    fails = false;
    EXPECT_THROW(simulation.step(), RunError);
    restore(simulation, kept);
    simulation.advance(simulation.step_count());
    Simulation reference(setup());
    reference.advance(reference.step_count());
    EXPECT_TRUE(simulation.finished());
    EXPECT_EQ(simulation.state_hash(), reference.state_hash());
}

// Inside advance(), particles in free flight are some steps behind. The end of the call makes these steps.
TEST(SavedSimulation, RestoreBetweenTheStepsOfAnAdvanceContinuesWithTheSameBits) {
    const auto setup = [] {
        SimulationSetup made;
        made.options.time_step = 0.02;
        made.options.duration = 4.0;
        made.forces.push_back(make_gravity({0, 0, -9.81}));
        made.materials.emplace_back();
        made.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
        for (int i = 0; i < 50; ++i) made.particles.emplace_back().position = {0.1 * i, 0, 0.3 + 0.1 * i};
        return made;
    };
    Simulation reference(setup());
    reference.advance(reference.step_count());
    Simulation simulation(setup());
    simulation.advance(20);
    const std::vector<std::byte> kept = saved(simulation);
    std::uint64_t calls = 0;
    simulation.advance(1000, [&] {
        if (++calls == 37) restore(simulation, kept);
        return true;
    });
    EXPECT_EQ(calls, simulation.step_count() - 20 + 37);
    EXPECT_TRUE(simulation.finished());
    EXPECT_EQ(simulation.state_hash(), reference.state_hash());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
