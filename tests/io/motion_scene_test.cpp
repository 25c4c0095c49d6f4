// Scenes with particles in a flow.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/scene_errors.h"
#include "ricochet/io/scene.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::errors_of;
using test::Lines;

std::string scene_of(const std::string& simulation, const std::string& more = "") {
    return R"({"ricochet": 1, "flows": {"stream": {"type": "uniform", "velocity": [1, 2, 3]}},
  "particles": [{"position": [0, 0, 1]}],
  "simulation": {)" +
           simulation + "}" + more + "}";
}

TEST(MotionScene, FlowByNameOrInlineMovesTheParticles) {
    for (const char* flow : {R"("stream")", R"({"type": "uniform", "velocity": [1, 2, 3]})"}) {
        const SceneDescription scene =
            parse_scene(scene_of(std::string(R"("motion": "flow", "flow": )") + flow), "s.json");
        const SimulationOptions& options = scene.setup.options;
        ASSERT_NE(options.flow, nullptr);
        EXPECT_EQ(options.flow->velocity({}, 0.0), Vec3(1, 2, 3));
        EXPECT_EQ(options.walls, WallRule::slide);
        EXPECT_EQ(options.integrator.kind, IntegratorKind::rk4);  // the default
        EXPECT_NO_THROW(Simulation(parse_scene(scene_of(R"("motion": "flow", "flow": "stream")"), "s.json").setup));
    }
    const SceneDescription stop = parse_scene(
        scene_of(R"("motion": "flow", "flow": "stream", "walls": "stop", "integrator": "midpoint")"), "s.json");
    EXPECT_EQ(stop.setup.options.walls, WallRule::stop);
    EXPECT_EQ(stop.setup.options.integrator.kind, IntegratorKind::midpoint);
}

TEST(MotionScene, ForcesMoveTheParticlesByDefault) {
    for (const char* simulation : {"", R"("motion": "forces")"}) {
        const SceneDescription scene = parse_scene(scene_of(simulation), "s.json");
        EXPECT_EQ(scene.setup.options.flow, nullptr);
        EXPECT_EQ(scene.setup.options.integrator.kind, IntegratorKind::ballistic);
    }
}

TEST(MotionScene, FeaturesIncompatibleWithAFlowAreRefused) {
    const std::string carried = R"("motion": "flow", "flow": "stream")";
    EXPECT_EQ(errors_of(scene_of(R"("motion": "flow")")),
              (Lines{"simulation.flow: missing, expected the flow that carries the particles"}));
    EXPECT_EQ(errors_of(scene_of(R"("motion": "flow", "flow": "steam")")),
              (Lines{"simulation.flow: there is no flow \"steam\"; did you mean \"stream\"?"}));
    for (const std::string kind : {"ballistic", "symplectic_euler", "velocity_verlet"}) {
        std::string keys = carried;
        keys.append(R"(, "integrator": ")").append(kind).append("\"");
        EXPECT_EQ(errors_of(scene_of(keys)),
                  (Lines{"simulation.integrator: found \"" + kind +
                         "\", which has no meaning where a flow carries the particles, expected \"forward_euler\", "
                         "\"midpoint\", \"rk4\" or \"dormand_prince\""}));
    }
    EXPECT_EQ(errors_of(scene_of(carried + R"(, "response": "penalty")")),
              (Lines{"simulation.response: found \"penalty\", expected \"exact\": a flow carries the particles"}));
    EXPECT_EQ(errors_of(scene_of(carried, R"(, "forces": [{"type": "gravity", "acceleration": [0, 0, -1]}])")),
              (Lines{"forces: a flow carries the particles, forces would do nothing: expected none"}));
    EXPECT_EQ(errors_of(scene_of(R"("walls": "stop")")),
              (Lines{"simulation.walls: only goes together with \"motion\": \"flow\""}));
    EXPECT_EQ(errors_of(scene_of(R"("motion": "forces", "flow": "stream")")),
              (Lines{"simulation.flow: only goes together with \"motion\": \"flow\""}));
}

TEST(MotionScene, WallsThatCannotAbsorbOrShatterParticlesInAFlowGiveAWarning) {
    const std::string parents = R"("emitters": [{"name": "a", "type": "point", "center": [0, 0, 1], "burst": 1},)";
    const std::string walls = R"(, "materials": {"sink": {"absorption": 0.5}}, "colliders": [{"type": "plane",
        "normal": [0, 0, 1], "material": "sink"}], )" +
                              parents;
    const std::string child = R"({"type": "child", "parent": "a", "on": "impact", "count": 2, "share": )";
    const std::string carried = R"("motion": "flow", "flow": "stream")";
    const SceneDescription shared = parse_scene(scene_of(carried, walls + child + "true}]"), "s.json");
    ASSERT_EQ(shared.warnings.size(), 2U);
    EXPECT_NE(shared.warnings[0].find("materials.sink.absorption: a flow carries the particles"), std::string::npos)
        << shared.warnings[0];
    EXPECT_NE(shared.warnings[1].find("emitters[1].on: a flow carries the particles"), std::string::npos)
        << shared.warnings[1];
    EXPECT_EQ(parse_scene(scene_of(carried, walls + child + "false}]"), "s.json").warnings.size(), 1U);
    EXPECT_EQ(parse_scene(scene_of("", walls + child + "true}]"), "s.json").warnings.size(), 0U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
