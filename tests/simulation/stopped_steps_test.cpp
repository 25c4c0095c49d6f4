// A stopped step leaves the state of the last whole step. The run continues from there with the same bits.
#include <gtest/gtest.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/parallel.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/springs.h"
#include "ricochet/simulation.h"
#include "support/counts.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kStep = 0.01;
constexpr std::uint64_t kSteps = 60;

/// Returns particles that rain onto a floor.
SimulationSetup rain(double radius) {
    SimulationSetup setup = setup_of(kStep, static_cast<double>(kSteps) * kStep,
                                     {.name = "floor", .restitution = 0.5, .friction = 0.2}, {0, 0, -9.81});
    setup.colliders = {{"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0}};
    EmitterDescription emitter;
    emitter.shape = BoxShape{{0, 0, 1}, {2, 2, 0.5}};
    emitter.rate = {400.0, 0.0};
    emitter.radius = {radius, 0.0};
    setup.emitters.push_back(std::move(emitter));
    return setup;
}

SimulationSetup meeting_rain() {
    SimulationSetup setup = rain(0.05);
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.5, .friction = 0.3};
    return setup;
}

SimulationSetup free_flight() {
    SimulationSetup setup = setup_of(kStep, static_cast<double>(kSteps) * kStep, {}, {0, 0, -1});
    for (int k = 0; k < 700; ++k) setup.particles.push_back(particle_of({0.1 * k, 0, 0}, {1, 0.01 * k, 0}));
    return setup;
}

SimulationSetup rope(IntegratorKind kind) {
    SimulationSetup setup = setup_of(kStep, static_cast<double>(kSteps) * kStep, {}, {0, 0, -9.81});
    setup.options.integrator.kind = kind;
    setup.colliders = {{"floor", PlaneShape{{0, 0, -0.4}, {0, 0, 1}}, 0}};
    RopeSettings settings;
    settings.from = {0, 0, 0};
    settings.to = {1, 0, 0};
    settings.nodes = 20;
    settings.mass = 1.0;
    settings.stiffness = 100.0;
    settings.damping = 0.1;
    SpringBody body = make_rope(settings);
    setup.particles = std::move(body.particles);
    setup.springs = std::move(body.springs);
    return setup;
}

SimulationSetup orbits() {
    SimulationSetup setup = setup_of(kStep, static_cast<double>(kSteps) * kStep);
    setup.options.integrator.kind = IntegratorKind::dormand_prince;
    setup.forces.push_back(make_point_gravity({{{0, 0, 0}, 1.0, 0.0}}));
    for (int k = 1; k < 300; ++k) setup.particles.push_back(particle_of({0.01 * k + 0.2, 0, 0}, {0, 1, 0}));
    return setup;
}

struct Case {
    std::string name;
    std::function<SimulationSetup()> setup;
};

std::vector<Case> cases() {
    return {{"rain", [] { return rain(0.0); }},
            {"spheres that meet", meeting_rain},
            {"free flight", free_flight},
            {"rope", [] { return rope(IntegratorKind::velocity_verlet); }},
            {"implicit rope", [] { return rope(IntegratorKind::implicit_euler); }},
            {"orbits", orbits},
            {"verified rain", [] {
                 SimulationSetup setup = rain(0.02);
                 setup.options.verify = true;
                 return setup;
             }}};
}

std::uint64_t hash_after(const Case& c, std::uint64_t steps) {
    Simulation simulation(c.setup());
    for (std::uint64_t k = 0; k < steps; ++k) simulation.step();
    return simulation.state_hash();
}

TEST(StoppedSteps, StoppedStepLeavesTheStateOfTheLastWholeStep) {
    for (const Case& c : cases()) {
        for (const int threads : {1, 3}) {
            const ThreadLimit limit(threads);
            Simulation simulation(c.setup());
            // The step is stopped repeatedly, each time at another call of the callback.
            std::atomic<std::uint64_t> asked = 0;
            std::uint64_t period = 1;
            std::uint64_t stops = 0;
            while (!simulation.finished()) {
                SCOPED_TRACE(c.name + ", threads " + std::to_string(threads) + ", step " +
                             std::to_string(simulation.step_index()));
                try {
                    asked = 0;
                    simulation.advance(
                        kSteps, [] { return true; }, [&] { return ++asked != period; });
                } catch (const StoppedError&) {
                    ++stops;
                    ASSERT_EQ(simulation.state_hash(), hash_after(c, simulation.step_index()));
                }
                period = 2 * period + 3;
            }
            EXPECT_GT(stops, 2U) << c.name;
            EXPECT_EQ(simulation.state_hash(), hash_after(c, kSteps)) << c.name;
            EXPECT_EQ(simulation.statistics().steps, kSteps) << c.name;
            EXPECT_EQ(simulation.statistics().violations, 0U) << c.name;
        }
    }
}

TEST(StoppedSteps, ContactsOfAStoppedStepAreReportedOnce) {
    const auto count_of = [](bool stops) {
        Simulation simulation(rain(0.0));
        std::uint64_t contacts = 0;
        simulation.on_contact([&](std::span<const ContactRecord> records) { contacts += records.size(); });
        std::uint64_t asked = 0;
        std::uint64_t period = 100;
        const ThreadLimit one(1);
        while (!simulation.finished()) {
            try {
                simulation.advance(
                    kSteps, [] { return true; }, [&] { return !stops || ++asked % period != 0; });
            } catch (const StoppedError&) {
                period *= 2;
            }
        }
        return std::pair(contacts, simulation.statistics().contacts);
    };
    const auto undisturbed = count_of(false);
    EXPECT_GT(undisturbed.first, 0U);
    EXPECT_EQ(count_of(true), undisturbed);
}

// A state stored before a change must not be restored.
TEST(StoppedSteps, ChangesBetweenStepsAreKept) {
    Simulation simulation(free_flight());
    bool has_changed = false;
    const auto change = [&] {
        if (!std::exchange(has_changed, true)) simulation.add_particle(particle_of({0, 0, 5}));
        return simulation.step_index() < 5;
    };
    try {
        simulation.advance(kSteps, change, [&] { return !has_changed; });
    } catch (const StoppedError&) {
    }
    EXPECT_GE(simulation.step_index(), 1U);
    EXPECT_EQ(simulation.particles().size(), 701U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
