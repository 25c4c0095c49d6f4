#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/run_program.h"
#include "geometry/temporary_folder.h"

namespace ricochet {
namespace {

TEST(BenchCommand, MeasuresTheQuickSuiteAndWritesItsNumbers) {
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

}  // namespace
}  // namespace ricochet
