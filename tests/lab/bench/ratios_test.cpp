#include "lab/bench/ratios.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "support/temporary_folder.h"

namespace ricochet::bench {
namespace RICOCHET_FILE {

Row row_of(const char* name, double raw, std::optional<double> native) {
    Row row;
    row.suite = "quick";
    row.name = name;
    row.ratio_raw = raw;
    row.ratio_native_bounces = native;
    return row;
}

SuiteRatios ratios_of(const std::vector<Row>& rows) { return ratios_of(rows, "quick", "machine-2t", "1.2.3"); }

TEST(BenchRatios, AreReadBackFromTheirFile) {
    const SuiteRatios ratios = ratios_of({row_of("gas", 0.1 + 0.2, 1.0 / 3.0), row_of("hail", 2.0, std::nullopt)});
    const test::TemporaryFolder folder;
    const SuiteRatios back = read_ratios(folder.write("ratios.json", to_json(ratios)), "quick");
    EXPECT_EQ(back.suite, "quick");
    EXPECT_EQ(back.machine, "machine-2t");
    EXPECT_EQ(back.version, "1.2.3");
    ASSERT_EQ(back.cases.size(), 2U);
    EXPECT_EQ(back.cases[0].name, "gas");
    EXPECT_EQ(back.cases[0].raw, 0.1 + 0.2);
    EXPECT_EQ(back.cases[0].native_bounces, 1.0 / 3.0);
    EXPECT_EQ(back.cases[1].native_bounces, std::nullopt);
}

TEST(BenchRatios, UseTheFirstRowOfACase) {
    const SuiteRatios ratios = ratios_of({row_of("gas", 1.0, 2.0), row_of("gas", 3.0, 4.0), row_of("hail", 5.0, 6.0)});
    ASSERT_EQ(ratios.cases.size(), 2U);
    EXPECT_EQ(ratios.cases[0].raw, 1.0);
    EXPECT_EQ(ratios.cases[1].raw, 5.0);
}

TEST(BenchRatios, AreRefusedInOneLineForAnotherKindOfFile) {
    const test::TemporaryFolder folder;
    const std::string start = R"({"suite": "quick", "machine": "m", "ricochet": "1")";
    const std::vector<std::string> wrong = {
        "",
        "ratio",
        "[]",
        "{}",
        start + "}",
        start + R"(, "cases": []})",
        start + R"(, "cases": {"gas": 1}})",
        start + R"(, "cases": {"gas": {}}})",
        start + R"(, "cases": {"gas": {"ratio_raw": 1}}})",
        start + R"(, "cases": {"gas": {"ratio_raw": 0, "ratio_native_bounces": 1}}})",
        start + R"(, "cases": {"gas": {"ratio_raw": -1, "ratio_native_bounces": 1}}})",
        start + R"(, "cases": {"gas": {"ratio_raw": "1", "ratio_native_bounces": 1}}})",
        start + R"(, "cases": {"gas": {"ratio_raw": 1e999, "ratio_native_bounces": 1}}})",
        R"({"suite": "gas", "machine": "m", "ricochet": "1", "cases": {}})",
        R"({"suite": "quick", "machine": 1, "ricochet": "1", "cases": {}})",
    };
    for (const std::string& text : wrong) {
        SCOPED_TRACE(text);
        const auto path = folder.write("ratios.json", text);
        try {
            (void)read_ratios(path, "quick");
            ADD_FAILURE();
        } catch (const InputError& error) {
            const std::string message = error.what();
            EXPECT_EQ(message.find(path.string()), 0U) << message;
            EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        }
    }
    EXPECT_THROW((void)read_ratios(folder.path("missing.json"), "quick"), InputError);
    EXPECT_THROW((void)read_ratios(folder.path(""), "quick"), InputError);
}

TEST(BenchRatios, FallOnlyBeyondTheTolerance) {
    const SuiteRatios before = ratios_of({row_of("gas", 1.0, 2.0), row_of("hail", 4.0, 8.0)});
    const SuiteRatios now = ratios_of({row_of("gas", 0.75, 1.49), row_of("hail", 40.0, 6.0)});
    const std::vector<RatioChange> changes = compare_ratios(before, now, 0.25);
    ASSERT_EQ(changes.size(), 4U);
    EXPECT_EQ(changes[0].name, "gas");
    EXPECT_EQ(changes[0].ratio, "ratio_raw");
    EXPECT_EQ(changes[0].before, 1.0);
    EXPECT_EQ(changes[0].now, 0.75);
    EXPECT_FALSE(changes[0].fell);  // the loss equals the tolerance
    EXPECT_EQ(changes[1].ratio, "ratio_native_bounces");
    EXPECT_TRUE(changes[1].fell);
    EXPECT_FALSE(changes[2].fell);  // it rose
    EXPECT_FALSE(changes[3].fell);
    const auto strict = compare_ratios(before, now, 0.0);
    EXPECT_EQ(std::count_if(strict.begin(), strict.end(), [](const RatioChange& c) { return c.fell; }), 3);
}

TEST(BenchRatios, ListCasesOnOneSideOnlyAsNotFallen) {
    const SuiteRatios before = ratios_of({row_of("gone", 1.0, std::nullopt), row_of("gas", 1.0, 1.0)});
    const SuiteRatios now = ratios_of({row_of("new", 0.1, 0.1), row_of("gas", 1.0, std::nullopt)});
    const std::vector<RatioChange> changes = compare_ratios(before, now, 0.1);
    ASSERT_EQ(changes.size(), 5U);
    EXPECT_EQ(changes[0].name, "gone");
    EXPECT_EQ(changes[0].now, std::nullopt);
    EXPECT_EQ(changes[2].name, "gas");
    EXPECT_EQ(changes[2].now, std::nullopt);
    EXPECT_EQ(changes[3].name, "new");
    EXPECT_EQ(changes[3].before, std::nullopt);
    for (const RatioChange& change : changes) EXPECT_FALSE(change.fell);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
