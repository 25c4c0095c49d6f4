#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "cli/run_program.h"
#include "geometry/mesh_files.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;
using test::TemporaryFolder;

constexpr const char* kScene = R"({"ricochet": 1, "simulation": {"time_step": 0.1, "duration": 1},
    "colliders": [{"name": "floor", "type": "plane", "normal": [0, 0, 1]}],
    "particles": [{"position": [0, 0, 1]}, {"position": [1, 0, 1]}]})";

TEST(ViewCommand, WritesThePageOfARunBesideItsFolder) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("drop.json", kScene).string();
    const std::string output = folder.path("out").string();
    ASSERT_EQ(run_ricochet({"run", scene, "--output", output, "--quiet"}).exit_code, 0);
    const ProgramResult result = run_ricochet({"view", output + "/"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("11 frames"), std::string::npos) << result.output;
    const std::string page = folder.read("out.html");
    EXPECT_TRUE(page.starts_with("<!doctype html>"));
    EXPECT_NE(page.find("<title>drop - Ricochet</title>"), std::string::npos);
    EXPECT_TRUE(page.ends_with("</html>\n"));
}

TEST(ViewCommand, RunsASceneFirst) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("drop.json", kScene).string();
    const std::string page = folder.path("p.html").string();
    const std::string run = folder.path("kept").string();
    const ProgramResult result = run_ricochet({"view", scene, "--output", page, "--run-output", run, "--set",
                                               "simulation.duration=0.5", "--color-by", "age"});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_NE(result.output.find("6 frames"), std::string::npos) << result.output;
    EXPECT_TRUE(std::filesystem::exists(folder.path("kept/summary.json")));
    EXPECT_NE(folder.read("p.html").find(R"("colorBy":"age")"), std::string::npos);
}

TEST(ViewCommand, ShowsMeshesOfARunInPieces) {
    const TemporaryFolder folder;
    const std::string shard = folder.write("shard.obj", test::kObjTetrahedron).string();
    const std::string scene = folder.write("drop.json", kScene).string();
    for (const std::string pieces : {"false", "true"}) {
        const ProgramResult result =
            run_ricochet({"view", scene, "--output", folder.path(pieces + ".html").string(), "--run-output",
                          folder.path("run-" + pieces).string(), "--set", "output.pieces=" + pieces, "--set",
                          R"(picture={"particles": "meshes", "mesh": ")" + shard + R"("})"});
        EXPECT_EQ(result.exit_code, 0) << result.errors;
    }
    EXPECT_EQ(folder.read("true.html").size(), folder.read("false.html").size());
}

TEST(ViewCommand, RefusesUnsuitableInputWithOneLine) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("drop.json", kScene).string();
    const std::string run = folder.path("run").string();
    ASSERT_EQ(run_ricochet({"run", scene, "--output", run, "--quiet"}).exit_code, 0);
    std::filesystem::create_directory(folder.path("empty"));
    std::filesystem::create_directory(folder.path("folder.html"));
    const std::string empty = folder.path("empty").string();
    const std::string page = folder.path("page.html").string();
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
        {{"view", empty, "--output", page}, "holds no frames"},
        {{"view", run + "x", "--output", page}, "there is neither a run's folder nor a scene"},
        {{"view", run, "--output", folder.path("folder.html").string()}, "is a folder"},
        {{"view", run, "--output", folder.path("page.txt").string()}, ".html"},
        {{"view", run, "--output", page, "--budget", "0.5"}, "--budget"},
        {{"view", run, "--output", page, "--color-by", "heat"}, "it has: speed"},
        {{"view", run, "--output", page, "--color-map", "grey"}, "viridis"},
        {{"view", run, "--output", page, "--set", "simulation.seed=3"}, "--set"},
        {{"view", run, "--output", page, "--run-output", empty}, "--run-output"},
    };
    for (const auto& [arguments, expected] : cases) {
        const ProgramResult result = run_ricochet(arguments);
        EXPECT_EQ(result.exit_code, 2) << expected;
        EXPECT_NE(result.errors.find(expected), std::string::npos) << result.errors;
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_FALSE(std::filesystem::exists(page)) << expected;
    }
}

TEST(ViewCommand, KeepsAnOlderPageIfTheNewOneFails) {
    const TemporaryFolder folder;
    const std::string scene = folder.write("drop.json", kScene).string();
    const std::string run = folder.path("run").string();
    ASSERT_EQ(run_ricochet({"run", scene, "--output", run, "--quiet"}).exit_code, 0);
    (void)folder.write("run.html", "older");
    (void)folder.write("run/particles_000005.vtp", "broken");
    const ProgramResult result = run_ricochet({"view", run});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(folder.read("run.html"), "older");
    for (const auto& entry : std::filesystem::directory_iterator(folder.path(""))) {
        EXPECT_EQ(entry.path().string().find(".partial"), std::string::npos) << entry.path();
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
