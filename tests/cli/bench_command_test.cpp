#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::ProgramResult;
using test::run_ricochet;

TEST(BenchCommand, RefusesWrongArgumentsInOneLineBeforeAnythingRuns) {
    const test::TemporaryFolder folder;
    const std::string file = folder.write("file", "no ratios").string();
    const std::string ratios =
        folder.write("ratios.json", R"({"suite": "quick", "machine": "m", "ricochet": "1", "cases": {}})").string();
    const std::vector<std::vector<std::string>> wrong = {
        {"--suite", "juggle"},
        {"--suite", ""},
        {"--threads", "0"},
        {"--threads", "1,"},
        {"--threads", "1,two"},
        {"--threads", "2000"},
        {"--repeats", "0"},
        {"--repeats", "1.5"},
        {"--repeats", "100000"},
        {"--repeats", "-1"},
        {"--json", folder.path("").string()},
        {"--results", file},
        {"--results", file + "/below"},
        {"--compare", file},
        {"--compare", folder.path("missing.json").string()},
        {"--compare", folder.path("").string()},
        {"--suite", "gas", "--compare", ratios},
        {"--suite", "load", "--compare", ratios},
        {"--suite", "load", "--write-ratios", folder.path("new.json").string()},
        {"--tolerance", "0.1"},
        {"--compare", ratios, "--tolerance", "1"},
        {"--compare", ratios, "--tolerance", "-0.1"},
        {"--compare", ratios, "--tolerance", "much"},
        {"--write-ratios", folder.path("").string()},
        {"quick"},
    };
    for (std::vector<std::string> arguments : wrong) {
        SCOPED_TRACE(arguments.back());
        arguments.insert(arguments.begin(), "bench");
        const ProgramResult result = run_ricochet(arguments);
        EXPECT_EQ(result.exit_code, 2);
        EXPECT_EQ(result.output, "");
        EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
        EXPECT_EQ(result.errors.rfind("ricochet: ", 0), 0U) << result.errors;
    }
    EXPECT_FALSE(std::filesystem::exists(folder.path("new.json")));
}

TEST(BenchCommand, RefusesAnUnwritableFileBeforeItMeasures) {
    const test::TemporaryFolder folder;
    const ProgramResult result = run_ricochet({"bench", "--json", folder.path("missing/bench.json").string()});
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_EQ(std::count(result.errors.begin(), result.errors.end(), '\n'), 1) << result.errors;
}

TEST(BenchCommand, ListsItsSuitesInTheHelp) {
    const ProgramResult result = run_ricochet({"bench", "--help"});
    EXPECT_EQ(result.exit_code, 0);
    for (const char* suite : {"gas", "settle", "hail", "rain", "pinball", "wedge", "size", "count", "threads", "radius",
                              "response", "load", "quick"}) {
        EXPECT_NE(result.output.find(suite), std::string::npos) << suite;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
