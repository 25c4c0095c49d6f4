#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "inspect/scene_schema.h"
#include "io/sample_scene.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;
using test::SampleFolder;

std::ptrdiff_t lines_of(const std::string& text) { return std::count(text.begin(), text.end(), '\n'); }

TEST(CheckCommand, SummarizesAValidSceneInOneLine) {
    const SampleFolder folder;
    const std::string scene = folder.write("s.json", test::kSampleScene).string();
    const ProgramResult result = run_ricochet({"check", scene});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.output, scene +
                                 ": ok: 2 colliders (4 triangles), 6 emitters, 2 explicit particles, 2 forces, 200 "
                                 "steps of 0.01 s, about 12 MB of memory\n");
    EXPECT_EQ(result.errors, "");
}

TEST(CheckCommand, PrintsEachErrorOnItsOwnLineAndEndsWithTwo) {
    const SampleFolder folder;
    const std::string scene =
        folder.write("s.json", R"({"ricochet": 1, "forcs": [], "simulation": {"seed": -1}, "output": {"every": 0}})")
            .string();
    const ProgramResult result = run_ricochet({"check", scene});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(lines_of(result.errors), 3);
    EXPECT_NE(result.errors.find("ricochet: " + scene + ":1:17: forcs: unknown key; did you mean \"forces\"?\n"),
              std::string::npos)
        << result.errors;
}

TEST(CheckCommand, PrintsWarningsAndStillEndsWithZero) {
    const SampleFolder folder;
    const std::string scene = folder.write("s.json", "{\"ricochet\": 1}").string();
    const ProgramResult result = run_ricochet({"check", scene});
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_EQ(result.errors,
              "ricochet: warning: " + scene + ": the scene has neither emitters nor particles, nothing will move\n");
    EXPECT_EQ(lines_of(result.output), 1);
}

TEST(CheckCommand, TakesOverridesBeforeAndAfterTheScene) {
    const SampleFolder folder;
    const std::string scene = folder.write("s.json", test::kSampleScene).string();
    for (const std::vector<std::string>& arguments :
         {std::vector<std::string>{"check", scene, "--set", "simulation.time_step=0.5", "--set", "emitters=[]"},
          {"check", "--set", "simulation.time_step=0.5", "--set", "emitters=[]", scene}}) {
        const ProgramResult result = run_ricochet(arguments);
        EXPECT_EQ(result.exit_code, 0) << result.errors;
        EXPECT_NE(result.output.find("0 emitters"), std::string::npos) << result.output;
        EXPECT_NE(result.output.find("4 steps of 0.5 s"), std::string::npos) << result.output;
    }
    const ProgramResult wrong = run_ricochet({"check", scene, "--set", "simulation.time_step=0"});
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_EQ(wrong.errors, "ricochet: " + scene +
                                ": --set simulation.time_step=0: simulation.time_step: found 0, expected a number > 0 "
                                "(s)\n");
}

TEST(CheckCommand, FindsErrorsThatOnlyTheSimulationDetects) {
    const SampleFolder folder;
    const std::string scene = folder.write("s.json", test::kSampleScene).string();
    const ProgramResult result = run_ricochet({"check", scene, "--set", "colliders[1].position=[9e74, 9e74, 9e74]",
                                               "--set", "emitters=[]", "--set", "colliders[1].scale=9e74"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(lines_of(result.errors), 1);
    EXPECT_EQ(result.errors.rfind("ricochet: " + scene + ": ", 0), 0U) << result.errors;
    EXPECT_NE(result.errors.find("rock"), std::string::npos) << result.errors;
}

TEST(CheckCommand, SaysWhatToDoWithAMeshInPlaceOfAScene) {
    const SampleFolder folder;
    const std::string mesh = folder.write("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").string();
    const ProgramResult result = run_ricochet({"check", mesh});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors, "ricochet: " + mesh +
                                 ": found a mesh file, expected a scene: `ricochet info` describes a mesh, and "
                                 "`ricochet new` writes a scene with it\n");
}

TEST(CheckCommand, AsksForANameInPlaceOfAnEmptyOne) {
    const SampleFolder folder;
    const std::string scene = folder.write("s.json", test::kSampleScene).string();
    for (const std::vector<std::string>& words : {std::vector<std::string>{"check", ""},
                                                  {"run", "", "--output", folder.path("out").string()},
                                                  {"run", scene, "--output", ""}}) {
        const ProgramResult result = run_ricochet(words);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(lines_of(result.errors), 1) << result.errors;
        EXPECT_NE(result.errors.find("empty name"), std::string::npos) << result.errors;
    }
}

TEST(SchemaCommand, PrintsTheSchemaAndTheReference) {
    EXPECT_EQ(run_ricochet({"schema"}).output, scene_schema());
    EXPECT_EQ(run_ricochet({"schema", "--markdown"}).output, scene_reference());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
