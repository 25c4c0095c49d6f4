// Spheres of several materials. The pair of materials determines impacts and pressing contact.
#include <gtest/gtest.h>

#include <cmath>
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

constexpr double kSteel = 0.0;
constexpr double kGlass = 1.0;

/// Returns a setup with the materials steel and glass.
SimulationSetup two_materials(double time_step, double duration, std::vector<MaterialPair> pairs,
                              const Vec3& gravity = {}) {
    SimulationSetup setup = setup_of(time_step, duration, {}, gravity);
    setup.options.resting_speed = 0.0;
    setup.options.verify = true;
    setup.options.particle_contacts = PairContactSettings{.restitution = 0.75};
    setup.options.particle_contacts->materials = {"steel", "glass"};
    setup.options.particle_contacts->pairs = std::move(pairs);
    setup.attributes = {{std::string(kMaterialAttribute), 1, {}}};
    return setup;
}

Particle made_of(double material, const Vec3& position, const Vec3& velocity, double radius = 0.1) {
    Particle particle = particle_of(position, velocity, radius);
    particle.attributes = {{material, 0.0, 0.0}};
    return particle;
}

Simulation run(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    EXPECT_EQ(simulation.statistics().pair_violations, 0U);
    EXPECT_EQ(simulation.statistics().violations, 0U);
    return simulation;
}

TEST(PairMaterials, SpheresReboundWithTheRestitutionOfTheirPair) {
    SimulationSetup setup =
        two_materials(0.25, 1.0, {{"glass", "glass", {0.25, 0.0, 0.0}}, {"glass", "steel", {0.5, 0.0, 0.0}}});
    const std::vector<std::pair<double, double>> pairs = {
        {kSteel, kSteel}, {kSteel, kGlass}, {kGlass, kSteel}, {kGlass, kGlass}};
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const double y = static_cast<double>(k);
        setup.particles.push_back(made_of(pairs[k].first, {0, y, 0}, {1, 0, 0}));
        setup.particles.push_back(made_of(pairs[k].second, {0.5, y, 0}, {-1, 0, 0}));
    }
    const Simulation simulation = run(std::move(setup));
    const std::vector<double> restitutions = {0.75, 0.5, 0.5, 0.25};
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        EXPECT_NEAR(simulation.particles().velocity[2 * k].x, -restitutions[k], 1e-13) << k;
        EXPECT_NEAR(simulation.particles().velocity[2 * k + 1].x, restitutions[k], 1e-13) << k;
    }
}

// The spheres graze at 45 degrees. The normal impulse of equal spheres of 1 kg is (1 + e) times half the approach
// speed.
TEST(PairMaterials, FrictionAndRollingResistanceFollowThePair) {
    SimulationSetup setup =
        two_materials(0.25, 0.5, {{"steel", "steel", {0.75, 0.1, 0.0}}, {"steel", "glass", {0.75, 0.05, 0.0}}});
    const double a = 0.2 / std::sqrt(2.0);
    const std::vector<std::pair<double, double>> pairs = {{kSteel, kSteel}, {kSteel, kGlass}, {kGlass, kGlass}};
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const double y = static_cast<double>(k);
        setup.particles.push_back(made_of(pairs[k].first, {0, y, 0}, {}));
        setup.particles.push_back(made_of(pairs[k].second, {a + 0.25, y + a, 0}, {-1, 0, 0}));
    }
    const Simulation simulation = run(std::move(setup));
    const double push = 1.75 * 0.5 / std::sqrt(2.0);
    const std::vector<double> frictions = {0.1, 0.05, 0.0};
    for (std::size_t k = 0; k < pairs.size(); ++k) {
        const double turning = frictions[k] * push * 0.1 / (0.4 * 0.1 * 0.1);
        for (const std::size_t i : {2 * k, 2 * k + 1}) {
            EXPECT_NEAR(std::fabs(simulation.particles().spin[i].z), turning, 1e-12) << k;
        }
    }
}

// A small sphere lies on a fixed sphere of 10 m, at first like on a slope. It slides if friction cannot make it roll,
// and rolls if it can.
TEST(PairMaterials, PressingSphereSlidesOrRollsByThePair) {
    SimulationSetup setup = two_materials(
        1e-4, 0.02, {{"steel", "steel", {0.0, 0.05, 0.0}}, {"steel", "glass", {0.0, 0.5, 0.0}}}, {0, 0, -9.81});
    setup.options.particle_contacts->method = PairMethod::contacts;
    const double slope = 0.5;
    const Vec3 normal{std::sin(slope), 0.0, std::cos(slope)};
    const Vec3 down{std::cos(slope), 0.0, -std::sin(slope)};
    for (const double material : {kSteel, kGlass}) {
        const Vec3 center{0.0, 30.0 * material, 0.0};
        setup.particles.push_back(made_of(kSteel, center, {}, 10.0));
        setup.particles.back().pinned = true;
        setup.particles.push_back(made_of(material, center + 10.1 * normal, {}));
    }
    const Simulation simulation = run(std::move(setup));
    const double slides = 9.81 * (std::sin(slope) - 0.05 * std::cos(slope)) * 0.02;
    const double rolls = 9.81 * std::sin(slope) * 0.02 / 1.4;
    EXPECT_NEAR(dot(simulation.particles().velocity[1], down), slides, 1e-4 * slides);
    EXPECT_NEAR(dot(simulation.particles().velocity[3], down), rolls, 1e-4 * rolls);
    EXPECT_NEAR(0.1 * simulation.particles().spin[3].y, rolls, 1e-4 * rolls);
}

TEST(PairMaterials, ChildrenHaveTheMaterialOfTheirParent) {
    SimulationSetup setup = two_materials(0.05, 0.5, {});
    setup.colliders = {{"wall", PlaneShape{{1, 0, 0}, {-1, 0, 0}}}};
    EmitterDescription source;
    source.name = "source";
    source.burst = 1;
    source.radius.mean = 0.05;
    source.speed.mean = 5.0;
    source.attributes = {{std::string(kMaterialAttribute), {kGlass, 0, 0}, {}}};
    EmitterDescription shards;
    shards.name = "shards";
    shards.parent.emplace();
    shards.parent->on = BirthEvent::impact;
    shards.parent->count = {3.0, 0.0};
    shards.radius.mean = 0.01;
    setup.emitters = {source, shards};
    Simulation simulation(std::move(setup));
    while (!simulation.finished()) simulation.step();
    ASSERT_GT(simulation.particles().size(), 1U);
    for (std::size_t i = 0; i < simulation.particles().size(); ++i) {
        EXPECT_EQ(simulation.particles().attributes.value(0, i).x, kGlass);
    }
}

std::string refusal_of(SimulationSetup setup) {
    try {
        const Simulation simulation{std::move(setup)};
    } catch (const InputError& error) {
        return error.what();
    }
    return {};
}

TEST(PairMaterials, InvalidMaterialIsRefusedByName) {
    EXPECT_EQ(refusal_of(two_materials(0.25, 1.0, {})), "");
    const auto expect = [&](const auto& change, const char* part) {
        SimulationSetup setup = two_materials(0.25, 1.0, {});
        change(setup);
        const std::string line = refusal_of(std::move(setup));
        EXPECT_NE(line.find(part), std::string::npos) << line << " has no " << part;
    };
    using S = SimulationSetup;
    expect([](S& s) { s.attributes.clear(); }, "found none that is named \"material\"");
    expect([](S& s) { s.attributes[0].components = 3; }, "found a vector, expected one component");
    expect([](S& s) { s.attributes[0].fallback.x = 2.0; }, "expected a whole number below 2");
    expect([](S& s) { s.particles = {made_of(0.5, {}, {})}; }, "material: found 0.5");
    expect([](S& s) { s.particles = {made_of(-1.0, {}, {})}; }, "material: found -1");
    expect([](S& s) { s.options.particle_contacts->materials = {"a", "a"}; }, "expected names, each once");
    expect([](S& s) { s.options.particle_contacts->pairs = {{"steel", "wood", {}}}; }, "found \"wood\"");
    expect([](S& s) { s.options.particle_contacts->pairs = {{"steel", "steel", {1.5, 0.0, 0.0}}}; }, "restitution");
    expect(
        [](S& s) {
            s.options.particle_contacts->pairs = {{"steel", "glass", {}}, {"glass", "steel", {}}};
        },
        "expected each pair once");
    Simulation simulation(two_materials(0.25, 1.0, {}));
    EXPECT_THROW(simulation.add_particle(made_of(7.0, {}, {})), InputError);
    EXPECT_NO_THROW(simulation.add_particle(made_of(kGlass, {}, {})));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
