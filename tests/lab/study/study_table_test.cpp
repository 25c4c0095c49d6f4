#include "lab/study/study_table.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace ricochet {
namespace RICOCHET_FILE {

TEST(StudyTable, FindsNumbersInASummaryByTheirPath) {
    const std::string summary =
        R"({"contacts": 3, "interrupted": false, "response": "exact", "energy": {"kinetic": 1.5},
        "counters": [{"name": "in", "forward": 1}, {"name": "out", "forward": 2}], "floor.a": {"impulse": [4, 5]}})";
    EXPECT_EQ(number_in_summary(summary, "contacts"), std::optional(3.0));
    EXPECT_EQ(number_in_summary(summary, "interrupted"), std::optional(0.0));
    EXPECT_EQ(number_in_summary(summary, "energy.kinetic"), std::optional(1.5));
    EXPECT_EQ(number_in_summary(summary, "counters.out.forward"), std::optional(2.0));
    EXPECT_EQ(number_in_summary(summary, "counters.1.forward"), std::optional(2.0));
    EXPECT_EQ(number_in_summary(summary, "floor.a.impulse.1"), std::optional(5.0));
    for (const char* path : {"response", "counters", "counters.none.forward", "contacts.more", "energy", "", "."}) {
        EXPECT_FALSE(number_in_summary(summary, path)) << path;
    }
    EXPECT_FALSE(number_in_summary("no JSON", "contacts"));
}

/// A study with two cases of three repeats.
StudyPlan small_plan() {
    StudyPlan plan;
    plan.axes = {{"key, with comma", {"1", "\"a\""}}};
    plan.repeats = 3;
    plan.results = {"contacts"};
    return plan;
}

std::vector<StudyOutcome> small_outcomes() {
    return {{{1.0}, ""}, {{2.0}, ""}, {{6.0}, ""}, {{5.0}, ""}, {{}, "failed, \"badly\""}, {{}, "failed"}};
}

// The standard error of 1, 2, 6 is sqrt(((-2)^2 + (-1)^2 + 3^2) / (3 * 2)).
TEST(StudyTable, HasMeansAndStandardErrorsOfTheRunsThatSucceed) {
    const StudyPlan plan = small_plan();
    const std::vector<StudyRow> rows = study_rows(plan, runs_of(plan), small_outcomes());
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows[0].runs, 3U);
    EXPECT_EQ(rows[0].results[0].mean, 3.0);
    EXPECT_DOUBLE_EQ(rows[0].results[0].error.value(), std::sqrt(14.0 / 6.0));
    EXPECT_EQ(rows[1].runs, 1U);
    EXPECT_EQ(rows[1].failed, 2U);
    EXPECT_EQ(rows[1].results[0].mean, 5.0);
    EXPECT_FALSE(rows[1].results[0].error);
}

TEST(StudyTable, WritesCsvThatReadersCanSplit) {
    const StudyPlan plan = small_plan();
    const std::vector<StudyRun> runs = runs_of(plan);
    const std::vector<StudyRow> rows = study_rows(plan, runs, small_outcomes());
    EXPECT_EQ(study_csv(plan, rows),
              "case,\"key, with comma\",runs,failed,contacts,contacts_error\n"
              "1,1,3,0,3,1.5275252316519468\n"
              "2,a,1,2,5,\n");
    EXPECT_EQ(study_runs_csv(plan, runs, small_outcomes()),
              "run,case,repeat,\"key, with comma\",contacts,failure\n"
              "1,1,1,1,1,\n2,1,2,1,2,\n3,1,3,1,6,\n4,2,1,a,5,\n"
              "5,2,2,a,,\"failed, \"\"badly\"\"\"\n6,2,3,a,,failed\n");
}

TEST(StudyTable, ScriptHasALineForEachCombinationOfTheOtherAxes) {
    StudyPlan plan;
    plan.axes = {{"x", {"1", "2"}}, {"it's", {"\"a\"", "\"b\""}}};
    plan.results = {"contacts", "energy"};
    const std::vector<StudyRun> runs = runs_of(plan);
    const std::vector<StudyOutcome> outcomes(4, StudyOutcome{{3.0, 4.0}, ""});
    const std::string script = study_script(plan, study_rows(plan, runs, outcomes));
    EXPECT_NE(script.find("title 'it''s = a', $line0_2"), std::string::npos) << script;
    EXPECT_NE(script.find("$line1_1 << END\n1 4 0\n2 4 0\nEND\n"), std::string::npos) << script;
    EXPECT_EQ(study_pictures(plan), (std::vector<std::string>{"study_1.png", "study_2.png"}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
