// Tests that work beyond the available memory ends with one line.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"
#include "support/counts.h"
#include "support/memory_ceiling.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::kSanitized;
using test::MemoryCeiling;
using test::ProgramResult;
using test::run_ricochet;
using test::TemporaryFolder;

void expect_refused(const ProgramResult& result, const std::string& by) {
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.output, "");
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
    EXPECT_NE(result.errors.find(by), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find(" of memory, expected at most "), std::string::npos) << result.errors;
}

TEST(MemoryOfPrograms, EveryCommandRefusesASceneThatDoesNotFitByItsKey) {
    if (kSanitized) GTEST_SKIP() << "sanitizers reserve terabytes: a program with a ceiling does not start";
    const TemporaryFolder folder;
    const std::string scene =
        folder.write("s.json", R"({"ricochet": 1, "emitters": [{"type": "point", "burst": 4000000000}]})").string();
    const std::string output = folder.path("out").string();
    const MemoryCeiling ceiling(1e9);
    const std::string by = "ricochet: " + scene + ":1:57: emitters[0].burst: with 100000000 particles alive at a time";
    expect_refused(run_ricochet({"check", scene}), by);
    expect_refused(run_ricochet({"run", scene, "--output", output}), by);
    expect_refused(run_ricochet({"compare", scene, "--output", output}), by);
    EXPECT_FALSE(std::filesystem::exists(output)) << "nothing was begun";
    // Settings from the command line count too.
    const std::string small = "emitters[0].burst=1500000";
    EXPECT_EQ(run_ricochet({"check", scene, "--set", small}).exit_code, 0);
}

TEST(MemoryOfPrograms, PicturesAndFilmsThatDoNotFitAreRefusedByTheirSize) {
    if (kSanitized) GTEST_SKIP() << "sanitizers reserve terabytes: a program with a ceiling does not start";
    const TemporaryFolder folder;
    const std::string scene = folder
                                  .write("s.json", R"({"ricochet": 1, "simulation": {"duration": 0.01},
                                                       "particles": [{"position": [0, 0, 0]}]})")
                                  .string();
    const std::string output = folder.path("out").string();
    ASSERT_EQ(run_ricochet({"run", scene, "--output", output, "--quiet"}).exit_code, 0);
    const MemoryCeiling ceiling(1e9);
    for (const char* const name : {"picture.png", "film.mp4"}) {
        const std::string target = folder.path(name).string();
        expect_refused(run_ricochet({"render", output, "--output", target, "--size", "16384x16384"}),
                       "ricochet: --size 16384x16384: asks for about ");
        EXPECT_FALSE(std::filesystem::exists(target));
    }
    // The layer of soft discs needs more memory than the picture.
    const std::string target = folder.path("picture.png").string();
    expect_refused(run_ricochet({"render", output, "--output", target, "--size", "6000x6000", "--draw", "glow"}),
                   "ricochet: --size 6000x6000: asks for about 4.32 GB");
}

TEST(MemoryOfPrograms, TheEstimateIsCloseToTheUseOfARun) {
    const TemporaryFolder folder;
    const std::string scene = folder
                                  .write("s.json", R"({"ricochet": 1, "simulation": {"duration": 0.05},
    "colliders": [{"type": "plane", "normal": [0, 0, 1]}],
    "emitters": [{"type": "box", "center": [0, 0, 5], "size": [1, 1, 1], "burst": 250000}]})")
                                  .string();
    const std::string checked = run_ricochet({"check", scene}).output;
    EXPECT_NE(checked.find(", about 107 MB of memory\n"), std::string::npos) << checked;
    if (kSanitized) return;  // sanitizers need memory of their own
    ASSERT_EQ(run_ricochet({"run", scene, "--output", folder.path("out").string(), "--quiet"}).exit_code, 0);
    const auto summary = nlohmann::json::parse(folder.read("out/summary.json"));
    const auto peak = summary["peak_memory_bytes"].get<double>();
    EXPECT_GT(107e6, 0.7 * peak);
    EXPECT_LT(107e6, 1.5 * peak);
}

// The program must not crash whichever allocation fails. It prints one line and leaves no partial file under a final
// name.
TEST(MemoryOfPrograms, ARunThatRunsOutOfMemoryAnywhereEndsWithOneLine) {
    if (kSanitized) GTEST_SKIP() << "sanitizers reserve terabytes: a program with a ceiling does not start";
    const TemporaryFolder folder;
    std::string mesh;
    for (int i = 0; i < 100; ++i) {
        for (int j = 0; j < 100; ++j) mesh += "v " + std::to_string(i) + " " + std::to_string(j) + " 0\n";
    }
    for (int i = 0; i + 1 < 100; ++i) {
        for (int j = 1; j < 100; ++j) {
            const int a = 100 * i + j;
            mesh += "f " + std::to_string(a) + " " + std::to_string(a + 100) + " " + std::to_string(a + 101) + " " +
                    std::to_string(a + 1) + "\n";
        }
    }
    (void)folder.write("grid.obj", mesh);
    const std::string scene = folder
                                  .write("s.json", R"({"ricochet": 1, "simulation": {"duration": 0.05},
    "colliders": [{"type": "mesh", "file": "grid.obj"}], "output": {"contacts": true},
    "emitters": [{"type": "box", "center": [50, 50, 0.6], "size": [1, 1, 0.1], "burst": 20000, "velocity": [0, 0, -100]}]})")
                                  .string();
    const std::string output = folder.path("out").string();
    int ended_well = 0;
    int ended_with_a_line = 0;
    for (int megabytes = 10; megabytes <= 250; megabytes += 6) {
        SCOPED_TRACE(megabytes);
        const MemoryCeiling ceiling(1e6 * megabytes);
        const ProgramResult result = run_ricochet({"run", scene, "--output", output, "--threads", "2", "--quiet"});
        ASSERT_TRUE(result.exit_code >= 0 && result.exit_code <= 2) << result.exit_code << result.errors;
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), result.exit_code == 0 ? 0 : 1)
            << result.errors;
        (result.exit_code == 0 ? ended_well : ended_with_a_line) += 1;
        EXPECT_EQ(std::filesystem::exists(folder.path("out/summary.json")), result.exit_code == 0);
    }
    EXPECT_GT(ended_well, 0);
    EXPECT_GT(ended_with_a_line, 0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
