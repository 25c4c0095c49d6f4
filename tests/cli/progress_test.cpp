#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

const std::string kScene = R"({"ricochet": 1, "simulation": {"time_step": 0.01, "duration": 0.05},
    "colliders": [{"type": "plane", "normal": [0, 0, 1]}], "particles": [{"position": [0, 0, 1]}]})";

TEST(Progress, IsShownInAPipeOnlyIfRequested) {
    const test::TemporaryFolder folder;
    const std::string scene = folder.write("s.json", kScene);
    const std::string out = folder.path("out").string();
    for (const std::string when : {"auto", "never"}) {
        EXPECT_EQ(test::run_ricochet({"run", scene, "--output", out, "--progress", when}).errors, "") << when;
    }
    const auto shown = test::run_ricochet({"run", scene, "--output", out, "--progress", "always", "--quiet"});
    EXPECT_EQ(shown.exit_code, 0);
    EXPECT_EQ(shown.output, "");
    EXPECT_NE(shown.errors.find("step 1 of 5"), std::string::npos) << shown.errors;
    EXPECT_EQ(shown.errors.find_first_of("\r\033"), std::string::npos) << "made for a terminal";
    EXPECT_EQ(std::count(shown.errors.begin(), shown.errors.end(), '\n'), 1) << shown.errors;
    const auto drawn = test::run_ricochet({"render", out, "--output", folder.path("p.png").string(), "--size", "32x32",
                                           "--samples", "1", "--progress", "always"});
    EXPECT_NE(drawn.errors.find("picture 1 of 1"), std::string::npos) << drawn.errors;
}

TEST(Progress, RefusesUnknownValuesBeforeTheRun) {
    const test::TemporaryFolder folder;
    const std::string scene = folder.write("s.json", kScene);
    const std::string out = folder.path("out").string();
    const auto result = test::run_ricochet({"run", scene, "--output", out, "--progress", "yes"});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors, "ricochet: --progress: found \"yes\", expected auto, always or never\n");
    EXPECT_FALSE(std::filesystem::exists(out));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
