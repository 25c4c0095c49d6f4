// Heat in scenes: the effect of each key, and one-line errors for invalid values.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

#include "io/heat_scene.h"
#include "io/scene_errors.h"
#include "ricochet/io/scene.h"
#include "ricochet/simulation.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::errors_of;
using test::kHeatScene;
using test::Lines;

/// Returns a scene of one ball with this heat and further members.
std::string scene_with(const std::string& heat, const std::string& more = "",
                       const std::string& attributes = R"("temperature": {})") {
    return R"({"ricochet": 1, "attributes": {)" + attributes + R"(}, "heat": {)" + heat + "}, " + more +
           R"("particles": [{"position": [0, 0, 1], "radius": 0.01}]})";
}

TEST(HeatScene, KeysSetTheHeat) {
    const SimulationSetup setup = parse_scene(kHeatScene, "s.json").setup;
    ASSERT_TRUE(setup.heat.has_value());
    EXPECT_EQ(setup.heat->specific_heat, 460.0);
    EXPECT_EQ(setup.heat->ambient_temperature, 290.0);
    EXPECT_EQ(setup.heat->emissivity, 0.7);
    EXPECT_EQ(setup.heat->impact_fraction, 0.5);
    EXPECT_EQ(setup.heat->friction_fraction, 0.4);
    ASSERT_TRUE(setup.heat->convection.has_value());
    const Convection& convection = *setup.heat->convection;
    EXPECT_FALSE(convection.coefficient.has_value());
    EXPECT_EQ(convection.conductivity, 0.03);
    EXPECT_EQ(convection.density, 1.1);
    EXPECT_EQ(convection.viscosity, 2e-5);
    EXPECT_EQ(convection.prandtl, 0.7);
    ASSERT_NE(convection.flow, nullptr);
    EXPECT_EQ(convection.flow->velocity({}, 0.0), (Vec3{1, 0, 0}));
}

TEST(HeatScene, SceneRunsAndFindsAFlowByItsName) {
    SceneDescription scene = parse_scene(scene_with(R"("specific_heat": 460, "convection": {"flow": "breeze"})",
                                                    R"("flows": {"breeze": {"type": "uniform", "velocity": [1, 0, 0]}},
                      "simulation": {"time_step": 0.1, "duration": 1},)",
                                                    R"("temperature": {"default": 400})"),
                                         "s.json");
    EXPECT_EQ(scene.warnings, Lines{});
    EXPECT_EQ(scene.setup.heat->convection->flow->velocity({}, 0.0), (Vec3{1, 0, 0}));
    Simulation simulation(std::move(scene.setup));
    while (!simulation.finished()) simulation.step();
    const double h = heat_transfer_coefficient({}, 0.01, 1.0);
    const double rate = h * 4.0 * std::acos(-1.0) * 1e-4 / 460.0;
    EXPECT_NEAR(simulation.particles().attributes.value(0, 0).x, 293.15 + 106.85 * std::exp(-rate), 1e-10);
}

TEST(HeatScene, InvalidHeatIsRefusedInOneLine) {
    const std::string radiates = R"("specific_heat": 460, "emissivity": 1)";
    EXPECT_EQ(errors_of(scene_with(R"("emissivity": 1)")),
              (Lines{"heat.specific_heat: missing, expected a number >= 0.001 and <= 1000000000000 (J/(kg K))"}));
    EXPECT_EQ(errors_of(scene_with(radiates, "", R"("heat": {})")),
              (Lines{"heat: attributes: found none that is named \"temperature\", expected it to be declared: it is "
                     "what heat changes, in K"}));
    EXPECT_EQ(errors_of(scene_with(radiates, "", R"("temperature": {"components": 3})")),
              (Lines{"heat: attribute \"temperature\": found a vector, expected one component (K)"}));
    EXPECT_EQ(
        errors_of(scene_with(radiates, "", R"("temperature": {"default": -5})")),
        (Lines{"heat: default of the attribute \"temperature\": found -5, expected a number from 0 to 1e+12 (K)"}));
    EXPECT_EQ(errors_of(scene_with(R"("specific_heat": 460)")),
              (Lines{"heat: convection, emissivity, impact_fraction and friction_fraction: found none, expected at "
                     "least one of them: nothing would change a temperature"}));
    EXPECT_EQ(errors_of(scene_with(R"("specific_heat": 460, "convection": {"coefficient": 9, "prandtl": 0.7})")),
              (Lines{"heat.convection.prandtl: has no part beside a `coefficient`, expected one of the two"}));
    EXPECT_EQ(errors_of(scene_with(R"("specific_heat": 460, "emissivity": 1.5)")),
              (Lines{"heat.emissivity: found 1.5, expected a number >= 0 and <= 1"}));
    EXPECT_EQ(errors_of(scene_with(radiates, R"("emitters": [{"name": "sparks", "type": "point", "rate": 1}],)")),
              (Lines{"heat: emitter \"sparks\": radius: found 0, expected more than 0 (m): convection and radiation, "
                     "which `heat` has, go by a particle's surface"}));
}

TEST(HeatScene, HeatIsRefusedIfTheSurfacesShareIsUnknown) {
    const std::string rubs = R"("specific_heat": 460, "friction_fraction": 1)";
    const auto refusal = [&](const std::string& more) {
        const Lines lines = errors_of(scene_with(rubs, more));
        return lines.size() == 1 ? lines[0] : std::to_string(lines.size()) + " lines";
    };
    EXPECT_NE(refusal(R"("simulation": {"response": "project"},)").find("found project, expected the response exact"),
              std::string::npos);
    EXPECT_NE(refusal(R"("particle_contacts": {},)").find("found particle_contacts, expected none"), std::string::npos);
    EXPECT_NE(refusal(R"("particle_forces": [{"type": "gravity"}],)").find("found particles that act on each other"),
              std::string::npos);
    EXPECT_NE(refusal(R"("materials": {"hot": {"diffuse": 1, "wall_temperature": 400}},)").find("wall_temperature"),
              std::string::npos);
}

TEST(HeatScene, BuoyancyUsesADeclaredTemperature) {
    const std::string forces =
        R"("forces": [{"type": "thermal_buoyancy", "ambient_temperature": 250, "gravity": [0, 0, -10]}], )";
    const auto scene = [&](const std::string& attributes, const std::string& more = "") {
        return R"({"ricochet": 1, )" + forces + attributes + more + R"("particles": [{"position": [0, 0, 1]}]})";
    };
    const std::string declared = R"("attributes": {"temperature": {"default": 500}}, )";
    const SimulationSetup setup = parse_scene(scene(declared), "s.json").setup;
    ForceInput input{{}, {}, 1.0, 0.0, 0.0};
    input.temperature = 500.0;
    EXPECT_EQ(setup.forces.at(0)->acceleration(input), Vec3(0, 0, 20));
    EXPECT_EQ(errors_of(scene("")), (Lines{"forces: thermal buoyancy: attributes: found none that is named "
                                           "\"temperature\", expected it to be declared: the lift goes by it, in K"}));
    EXPECT_EQ(errors_of(scene(declared, R"("particle_contacts": {}, )")).size(), 1U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
