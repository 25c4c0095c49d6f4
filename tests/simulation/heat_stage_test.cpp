// Temperatures in a running simulation: saved and restored, inherited by children, and for particles that come and go.
#include "ricochet/simulation/heat_stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "ricochet/simulation.h"
#include "support/simulations.h"

namespace ricochet {
namespace RICOCHET_FILE {

using testing::particle_of;
using testing::setup_of;

constexpr double kRate = 0.8;  // 1/s, for every ball of radius r and mass 4 pi r^2

/// Returns heat settings that cool a ball by exp(-kRate t) to 300 K, if its mass equals its surface.
HeatSettings steady_cooling() {
    HeatSettings heat;
    heat.specific_heat = 1.0;
    heat.ambient_temperature = 300.0;
    heat.convection = Convection{};
    heat.convection->coefficient = kRate;
    return heat;
}

double mass_of(double radius) { return 4.0 * std::acos(-1.0) * radius * radius; }

SimulationSetup cooling_setup(double time_step, double duration) {
    SimulationSetup setup = setup_of(time_step, duration, {"floor", 0.6, 0.2}, {0, 0, -9.81});
    setup.attributes.push_back({"temperature", 1, {500.0, 0, 0}});
    setup.heat = steady_cooling();
    return setup;
}

/// Returns the temperature of a ball that started 200 K above the surroundings.
double after(double seconds) { return 300.0 + 200.0 * std::exp(-kRate * seconds); }

double temperature(const Simulation& simulation, std::size_t i) {
    return simulation.particles().attributes.value(0, i).x;
}

EmitterDescription balls(double radius) {
    EmitterDescription emitter;
    emitter.shape = PointShape{{0, 0, 5}};
    emitter.radius = {radius, 0.0};
    emitter.mass = {mass_of(radius), 0.0};
    return emitter;
}

TEST(HeatStage, ParticlesCoolFromBirthToDeath) {
    SimulationSetup setup = cooling_setup(0.25, 1.0);
    EmitterDescription emitter = balls(0.1);
    emitter.rate = {3.0, 0.0};  // born at 1/6, 1/2 and 5/6 s
    setup.emitters.push_back(emitter);
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    ASSERT_EQ(simulation.particles().size(), 3U);
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(temperature(simulation, i), after(1.0 - simulation.particles().birth_time[i]), 1e-9);
    }
}

TEST(HeatStage, ChildrenOfADeathInheritTheTemperatureOfTheirParent) {
    SimulationSetup setup = cooling_setup(0.25, 1.0);
    setup.emitters.push_back(balls(0.1));
    setup.emitters[0].burst = 1;
    setup.emitters[0].lifetime = {0.6, 0.0};
    EmitterDescription child = balls(0.05);
    child.parent = ParentRule{};
    child.parent->on = BirthEvent::death;
    child.parent->count = {2.0, 0.0};
    setup.emitters.push_back(child);
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    ASSERT_EQ(simulation.particles().size(), 2U);
    EXPECT_NEAR(temperature(simulation, 0), after(1.0), 1e-9);
    EXPECT_NEAR(temperature(simulation, 1), after(1.0), 1e-9);
}

TEST(HeatStage, AddedPointsKeepTheirTemperature) {
    SimulationSetup setup = cooling_setup(0.1, 1.0);
    setup.particles.push_back(particle_of({0, 0, 9}, {}, 0.1));
    setup.particles[0].mass = mass_of(0.1);
    Simulation simulation(std::move(setup));
    simulation.step();
    (void)simulation.add_particle(particle_of({0, 0, 9}));
    while (!simulation.finished()) simulation.step();
    EXPECT_NEAR(temperature(simulation, 0), after(1.0), 1e-9);
    EXPECT_EQ(temperature(simulation, 1), 500.0);
}

std::vector<std::byte> saved(const Simulation& simulation) {
    std::vector<std::byte> bytes;
    simulation.save([&](std::span<const std::byte> part) { bytes.insert(bytes.end(), part.begin(), part.end()); });
    return bytes;
}

/// Returns balls that bounce and slide on a floor and lose heat to a wind and by radiation.
SimulationSetup busy_setup() {
    SimulationSetup setup = cooling_setup(0.01, 1.0);
    setup.colliders.push_back({"floor", PlaneShape{{}, {0, 0, 1}}, 0});
    EmitterDescription emitter = balls(0.02);
    emitter.shape = BoxShape{{0, 0, 0.5}, {1, 1, 0.5}};
    emitter.rate = {80.0, 10.0};
    emitter.speed = {2.0, 1.0};
    setup.emitters.push_back(emitter);
    setup.heat->convection = Convection{};
    setup.heat->convection->flow = make_wind({3, 0, 0});
    setup.heat->emissivity = 0.9;
    setup.heat->impact_fraction = 0.5;
    setup.heat->friction_fraction = 0.5;
    return setup;
}

TEST(HeatStage, SavedStateContinuesWithTheSameBits) {
    Simulation whole(busy_setup());
    while (whole.step_index() < 50) whole.step();
    const std::vector<std::byte> bytes = saved(whole);
    while (!whole.finished()) whole.step();
    EXPECT_GT(whole.statistics().contacts, 50U);
    Simulation resumed(busy_setup());
    std::size_t at = 0;
    resumed.restore([&](std::span<std::byte> part) {
        std::memcpy(part.data(), bytes.data() + at, part.size());
        at += part.size();
    });
    while (!resumed.finished()) resumed.step();
    EXPECT_EQ(saved(resumed), saved(whole));
}

TEST(HeatStage, InvalidSetupsAreRefused) {
    const auto refusal = [](auto change) {
        SimulationSetup setup = cooling_setup(0.1, 1.0);
        setup.particles.push_back(particle_of({0, 0, 9}, {}, 0.1));
        change(setup);
        try {
            const Simulation simulation(std::move(setup));
        } catch (const InputError& error) {
            return std::string(error.what());
        }
        return std::string("nothing");
    };
    EXPECT_EQ(refusal([](SimulationSetup&) {}), "nothing");
    const auto expect = [&](auto change, const char* words) {
        const std::string line = refusal(change);
        EXPECT_NE(line.find(words), std::string::npos) << line;
    };
    expect([](SimulationSetup& s) { s.heat->specific_heat = 0.0; }, "heat: specific_heat: found 0");
    expect([](SimulationSetup& s) { s.heat->ambient_temperature = -1.0; }, "heat: ambient_temperature: found -1");
    expect([](SimulationSetup& s) { s.heat->emissivity = NAN; }, "heat: emissivity: found nan");
    expect([](SimulationSetup& s) { s.heat->convection->coefficient = -2.0; },
           "heat.convection: coefficient: found -2");
    expect([](SimulationSetup& s) { s.heat->convection->prandtl = 0.0; }, "heat.convection: prandtl: found 0");
    expect([](SimulationSetup& s) { s.attributes.clear(); }, "none that is named \"temperature\"");
    expect([](SimulationSetup& s) { s.particles[0].radius = 0.0; }, "particle 0: radius: found 0");
    expect([](SimulationSetup& s) { s.particles[0].attributes = {{-4.0, 0, 0}}; }, "particle 0: temperature: found -4");
    expect(
        [](SimulationSetup& s) {
            s.heat->friction_fraction = 0.5;
            s.springs.push_back({0, 0, 1.0, 1.0, 0.0});
        },
        "particles that act on each other");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
