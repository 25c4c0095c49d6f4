#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

TEST(BenchCommandLong, MeasuresTheQuickSuiteAndWritesItsNumbers) {
    const test::TemporaryFolder folder;
    const std::string file = folder.path("bench.json").string();
    const test::ProgramResult result =
        test::run_ricochet({"bench", "--suite", "quick", "--repeats", "1", "--threads", "1,2", "--json", file});
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    EXPECT_EQ(result.errors, "");
    const auto rows = nlohmann::json::parse(folder.read("bench.json"));
    ASSERT_EQ(rows.size(), 6U);
    for (std::size_t i = 0; i < rows.size(); i += 2) {
        EXPECT_EQ(rows[i]["threads"], 1);
        EXPECT_EQ(rows[i + 1]["threads"], 2);
        EXPECT_EQ(rows[i]["state_hash"], rows[i + 1]["state_hash"]);
        EXPECT_NE(result.output.find(rows[i]["state_hash"].get<std::string>()), std::string::npos) << result.output;
    }
}

TEST(BenchCommandLong, WritesResultsAndRatiosAndDetectsFallenRatios) {
    const test::TemporaryFolder folder;
    const std::string results = folder.path("deep/results").string();
    const std::string ratios = folder.path("ratios.json").string();
    const auto first = test::run_ricochet({"bench", "--repeats", "1", "--results", results, "--write-ratios", ratios});
    ASSERT_EQ(first.exit_code, 0) << first.errors;
    const std::filesystem::path machine = *std::filesystem::directory_iterator(results);
    EXPECT_TRUE(std::filesystem::exists(machine / "quick.csv"));
    EXPECT_TRUE(std::filesystem::exists(machine / "quick.gp"));
    auto json = nlohmann::json::parse(folder.read("ratios.json"));
    EXPECT_EQ(json["cases"].size(), 3U);
    json["cases"]["gas"]["ratio_raw"] = 1e9;  // larger than any measured ratio
    (void)folder.write("fast.json", json.dump());
    json["cases"] = {{"gas", {{"ratio_raw", 1e-9}, {"ratio_native_bounces", 1e-9}}}};
    (void)folder.write("slow.json", json.dump());
    const auto compare = [&](const char* name) {
        return test::run_ricochet({"bench", "--repeats", "1", "--compare", folder.path(name).string()});
    };
    const auto fell = compare("fast.json");
    EXPECT_EQ(fell.exit_code, 1);
    EXPECT_EQ(fell.errors, "");
    EXPECT_NE(fell.output.find("fell"), std::string::npos) << fell.output;
    EXPECT_EQ(compare("slow.json").exit_code, 0);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
