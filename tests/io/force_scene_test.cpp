#include "io/force_scene.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/io/scene.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Lines = std::vector<std::string>;
using test::ForceSceneFolder;
using test::kForceScene;

const ForceInput kState{{0.3, 0.4, 0.5}, {1, -2, 3}, 2.0, 0.1, 0.7, 1};

FlowPointer storm() {
    return make_scaled_flow(
        make_flow_sum({make_gusty_wind({1, 2, 3}, {0.5, 2.0, 0.25}), make_vortex({{1, 0, 0}, {0, 0, 1}, 3.0, 0.5}),
                       make_vortex({{}, {0, 1, 0}, 3.0, 0.5, VortexProfile::lamb_oseen}),
                       make_source({0, 1, 0}, -2.0, 0.1), make_rotation({0, 0, 1}, {0, 0, 2}),
                       make_shear({0, 0, 1}, {2, 0, 0}, {0, 0, 3}), make_turbulence({9, 0.5, 0.3, 4, 0.8, 1.0}),
                       make_flow_past_sphere({0, 0, 9}, 0.5, {1, 0, 0}),
                       make_grid_flow({{}, {1, 1, 1}, {2, 1, 1}, {{}, {2, 4, 6}}}, OutsideGrid::zero)}),
        0.5);
}

TEST(ForceScene, KeysMakeEveryForce) {
    const ForceSceneFolder folder;
    const SceneDescription scene = parse_scene(kForceScene, folder.path("s.json"));
    EXPECT_EQ(scene.warnings, Lines{});
    const FlowPointer breeze = make_wind({2, 0, 0});
    std::vector<std::unique_ptr<Force>> expected;
    expected.push_back(make_gravity({0, 0, -9.81}));
    expected.push_back(make_linear_drag(0.5, breeze));
    expected.push_back(make_linear_drag(0.25, make_grid_flow({{}, {1, 1, 1}, {2, 1, 1}, {{}, {2, 4, 6}}})));
    expected.push_back(make_quadratic_drag(0.1, storm()));
    expected.push_back(make_sphere_drag(0.47, 1.2));
    expected.push_back(make_stokes_drag(1e-3));
    expected.push_back(make_schiller_naumann_drag(1000.0, 1e-3, breeze));
    expected.push_back(make_buoyancy(1000.0, {0, 0, -9.81}));
    expected.push_back(make_point_gravity({{{1, 0, 0}, 3.0, 0.1}, {{0, 1, 0}, -1.0, 0.0}}));
    expected.push_back(make_radial_force({{0, 0, 1}, 2.0, 1.0, 0.1, 2.0}));
    expected.push_back(make_swirl({1, 0, 0}, {0, 0, 1}, 3.0, 0.5));
    expected.push_back(make_field_force(make_rotation({}, {0, 0, 1}), FieldMeaning::force));
    expected.push_back(make_lorentz_force({0.5, {1, 0, 0}, {0, 0, 2}}));
    expected.push_back(make_anchor({{0, 0, 5}, 10.0, 1.0, 0.1, {1}}));
    ASSERT_EQ(scene.setup.forces.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(scene.setup.forces[i]->acceleration(kState), expected[i]->acceleration(kState)) << i;
        EXPECT_EQ(scene.setup.forces[i]->is_steady(), expected[i]->is_steady()) << i;
        EXPECT_EQ(scene.setup.forces[i]->is_uniform(), expected[i]->is_uniform()) << i;
    }
}

TEST(ForceScene, AnchorHoldsTheParticlesThatItNames) {
    SceneDescription scene = parse_scene(R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 1},
        "forces": [{"type": "anchor", "position": [0, 0, 0], "stiffness": 3, "particles": [1, 2]}],
        "particles": [{"position": [1, 0, 0]}, {"position": [1, 0, 0]}, {"position": [1, 0, 0]}]})",
                                         "s.json");
    Simulation simulation(std::move(scene.setup));
    while (!simulation.finished()) simulation.step();
    const auto& particles = simulation.particles();
    EXPECT_EQ(particles.position[0], (Vec3{1, 0, 0}));
    EXPECT_LT(particles.position[1].x, 0.5);
    EXPECT_EQ(particles.position[2], particles.position[1]);
}

// Returns all errors of a scene with these members, without the file's name.
Lines errors_of(const std::string& members) {
    const ForceSceneFolder folder;
    try {
        (void)parse_scene("{\"ricochet\": 1, \"particles\": [{\"position\": [0, 0, 0]}], " + members + "}",
                          folder.path("s.json"));
        return {};
    } catch (const SceneError& error) {
        Lines lines;
        for (std::string line : error.messages()) {
            line.erase(0, line.find(": ") + 2);
            lines.push_back(line);
        }
        return lines;
    }
}

TEST(ForceScene, WrongValuesAreNamedByTheirPath) {
    EXPECT_EQ(errors_of(R"("forces": [{"type": "drag", "coefficient": 1, "flow": {"type": "sum", "parts": [
                  {"type": "vortex", "axis": [0, 0, 0], "circulation": 1, "core_radius": 0}]}}])"),
              (Lines{"forces[0].flow.parts[0].axis: found a vector of no length, expected [x, y, z], not all zero",
                     "forces[0].flow.parts[0].core_radius: found 0, expected a number > 0 (m)"}));
    EXPECT_EQ(errors_of(R"("flows": {"a": {"type": "turbulence", "speed": 1, "length": 1, "octaves": 17}})"),
              (Lines{"flows.a.octaves: found 17, expected a whole number >= 1 and <= 16"}));
    EXPECT_EQ(
        errors_of(R"("forces": [{"type": "anchor", "position": [0, 0, 0], "stiffness": 1, "particles": [1, -1]}])"),
        (Lines{"forces[0].particles: found -1 in the list, expected a list of whole numbers, at least one"}));
    EXPECT_EQ(errors_of(R"("forces": [{"type": "quadratic_drag"}])"),
              (Lines{"forces[0]: found none of the keys \"coefficient\", \"drag_coefficient\", expected exactly one of "
                     "them"}));
    EXPECT_EQ(errors_of(R"("forces": [{"type": "stokes_drag", "flow": 3}])"),
              (Lines{"forces[0].flow: found 3, expected an object {...} (flow), or one of the names in \"flows\""}));
    EXPECT_EQ(errors_of(R"("forces": [{"type": "point_gravity", "attractors": [{"position": [0, 0, 0]}]}])"),
              (Lines{"forces[0].attractors[0].strength: missing, expected a number (m^3/s^2)"}));
}

TEST(ForceScene, FlowInAForceWithoutOneIsNamed) {
    EXPECT_EQ(errors_of(R"("forces": [{"type": "gravity", "acceleration": [0, 0, -9.81],
                             "flow": {"type": "uniform", "velocity": [1, 0, 0]}}])"),
              (Lines{"forces[0].flow: not a key of type \"gravity\", it belongs to \"drag\", \"quadratic_drag\", "
                     "\"stokes_drag\", \"schiller_naumann_drag\", \"field\""}));
}

TEST(ForceScene, MissingFlowsAreNamed) {
    EXPECT_EQ(errors_of(R"("flows": {"breeze": {"type": "uniform", "velocity": [1, 0, 0]}},
                           "forces": [{"type": "drag", "coefficient": 1, "flow": "breze"}])"),
              (Lines{"forces[0].flow: there is no flow \"breze\"; did you mean \"breeze\"?"}));
    EXPECT_EQ(errors_of(R"("forces": [{"type": "field", "flow": "wind"}])"),
              (Lines{"forces[0].flow: there is no flow \"wind\", the scene has none"}));
}

TEST(ForceScene, ErrorsOfAGridsFileAreNamed) {
    const Lines missing = errors_of(R"("forces": [{"type": "field", "flow": {"type": "grid", "file": "winds.vti"}}])");
    ASSERT_EQ(missing.size(), 1U);
    EXPECT_EQ(missing[0].find("forces[0].flow.file: there is no file "), 0U) << missing[0];
    EXPECT_NE(missing[0].find("did you mean \"wind.vti\"?"), std::string::npos) << missing[0];
    const Lines unnamed =
        errors_of(R"("forces": [{"type": "field", "flow": {"type": "grid", "file": "wind.vti", "array": "u"}}])");
    ASSERT_EQ(unnamed.size(), 1U);
    EXPECT_NE(unnamed[0].find("no array \"u\" in <PointData>"), std::string::npos) << unnamed[0];
}

TEST(ForceScene, ExamplesOfTheDocumentAreValid) {
    const ForceSceneFolder folder;
    std::ifstream page(RICOCHET_SOURCE_DIR "/docs/forces.md");
    std::string forces;
    std::string flows;
    bool in_flows = false;
    int examples = 0;
    for (std::string line; std::getline(page, line);) {
        in_flows = in_flows || line == "## Flows";
        if (line.rfind("    {\"type\"", 0) != 0) continue;
        if (in_flows) {
            flows += fmt::format("{}\"flow {}\": {}", flows.empty() ? "" : ", ", examples, line);
        } else {
            forces += (forces.empty() ? "" : ", ") + line;
        }
        ++examples;
    }
    EXPECT_GE(examples, 20);
    const std::string scene = fmt::format(
        "{{\"ricochet\": 1, \"attributes\": {{\"temperature\": {{}}}}, \"flows\": {{{}}}, \"forces\": [{}]}}", flows,
        forces);
    try {
        (void)parse_scene(scene, folder.path("s.json"));
    } catch (const SceneError& error) {
        for (const std::string& message : error.messages()) ADD_FAILURE() << message;
    }
}

TEST(ForceScene, ForcesThatNeedARadiusGiveAWarningForPoints) {
    const auto warnings = [](const char* radius) {
        return parse_scene(std::string(R"({"ricochet": 1, "forces": [{"type": "stokes_drag"}],
                                           "particles": [{"position": [0, 0, 0], "radius": )") +
                               radius + "}]}",
                           "s.json")
            .warnings;
    };
    EXPECT_EQ(warnings("0.1"), Lines{});
    ASSERT_EQ(warnings("0").size(), 1U);
    EXPECT_NE(warnings("0")[0].find("forces[0].type: "), std::string::npos);
}

TEST(ForceScene, IdsThatNoParticleHasGiveAWarning) {
    const auto warnings = [](const std::string& list, const std::string& ids, const std::string& more) {
        const std::string own = list == "forces" ? R"("acceleration": [0, 0, -1], )" : "";
        const std::string particles = R"("particles": [{"position": [0, 0, 0]}, {"position": [1, 0, 0]}])";
        const std::string force = R"({"type": "gravity", )" + own + R"("particles": )" + ids + "}";
        return parse_scene(R"({"ricochet": 1, )" + particles + ", \"" + list + "\": [" + force + "]" + more + "}",
                           "s.json")
            .warnings;
    };
    const std::string tap = R"(, "emitters": [{"type": "point", "rate": 1}])";
    for (const std::string list : {"forces", "particle_forces"}) {
        EXPECT_EQ(warnings(list, "[0, 1]", ""), Lines{});
        EXPECT_EQ(warnings(list, "[0, 5]", tap), Lines{}) << "born later";
        ASSERT_EQ(warnings(list, "[0, 5]", "").size(), 1U);
        EXPECT_NE(warnings(list, "[0, 5]", "")[0].find(list + "[0].particles: no particle has the id 5"),
                  std::string::npos);
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
