#include "lab/compare/plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "ricochet/core/error.h"

namespace ricochet {
namespace RICOCHET_FILE {

SimulationOptions scene() {
    SimulationOptions options;
    options.time_step = 0.01;
    options.duration = 2.0;
    return options;
}

std::string error_of(const ComparisonRequest& request, const SimulationOptions& options = scene()) {
    try {
        (void)make_plan(request, options);
    } catch (const InputError& error) {
        return error.what();
    }
    return "no error";
}

TEST(ComparisonPlan, RunsAllResponsesAtFourStepsAroundTheScenes) {
    const ComparisonPlan plan = make_plan({}, scene());
    ASSERT_EQ(plan.responses.size(), 4U);
    EXPECT_EQ(name_of(plan.responses[0]) + name_of(plan.responses[1]) + name_of(plan.responses[2]) +
                  name_of(plan.responses[3]),
              "exactrollbackprojectpenalty");
    EXPECT_EQ(plan.time_steps, (std::vector{0.02, 0.01, 0.005, 0.0025}));
    EXPECT_EQ(plan.reference_step, 0.00125);
    EXPECT_EQ(plan.shown_step, 0.01);
    EXPECT_EQ(plan.repeats, 3U);
}

TEST(ComparisonPlan, SortsStepsAndDropsDuplicates) {
    ComparisonRequest request;
    request.time_steps = "0.1,0.4,0.2,0.1";
    request.responses = "penalty,exact,penalty";
    const ComparisonPlan plan = make_plan(request, scene());
    EXPECT_EQ(plan.time_steps, (std::vector{0.4, 0.2, 0.1}));
    EXPECT_EQ(plan.responses.size(), 2U);
    EXPECT_EQ(plan.shown_step, 0.2);  // the middle one, because the list does not contain the scene's step
}

TEST(ComparisonPlan, LeavesOutUsualStepsBeyondTheDuration) {
    SimulationOptions options = scene();
    options.duration = 0.015;
    EXPECT_EQ(make_plan({}, options).time_steps.front(), 0.01);
}

TEST(ComparisonPlan, TheGlobalRollbackIsASeparateResponse) {
    ComparisonRequest request;
    request.responses = "rollback,rollback:global";
    const ComparisonPlan plan = make_plan(request, scene());
    ASSERT_EQ(plan.responses.size(), 2U);
    EXPECT_FALSE(options_for(scene(), plan.responses[0], 0.1).rollback.global);
    const SimulationOptions global = options_for(scene(), plan.responses[1], 0.1);
    EXPECT_TRUE(global.rollback.global);
    EXPECT_EQ(global.response, ResponseKind::rollback);
    EXPECT_EQ(global.time_step, 0.1);
}

TEST(ComparisonPlan, RefusesBadListsByTheirOption) {
    struct Case {
        ComparisonRequest request;
        const char* expected;
    };
    for (const Case& c : {
             Case{{.responses = "exakt"}, "--responses: unknown response \"exakt\"; expected exact, rollback,"},
             Case{{.responses = ""}, "--responses \"\": found an empty entry"},
             Case{{.responses = "exact,,project"}, "--responses \"exact,,project\": found an empty entry"},
             Case{{.time_steps = ""}, "--time-steps \"\": found an empty entry"},
             Case{{.time_steps = "0.1,"}, "--time-steps \"0.1,\": found an empty entry"},
             Case{{.time_steps = "0"}, "--time-steps: found \"0\", expected a number > 0"},
             Case{{.time_steps = "-0.1"}, "--time-steps: found \"-0.1\", expected a number > 0"},
             Case{{.time_steps = "nan"}, "--time-steps: found \"nan\""},
             Case{{.time_steps = "inf"}, "--time-steps: found \"inf\""},
             Case{{.time_steps = "1s"}, "--time-steps: found \"1s\""},
             Case{{.time_steps = "3"}, "--time-steps: a step of 3 s is longer than the scene's duration of 2 s"},
             Case{{.reference_step = "0.1"}, "--reference-step: 0.1 s is coarser"},
             Case{{.reference_step = "x"}, "--reference-step: found \"x\""},
             Case{{.repeats = "0"}, "--repeats: found \"0\", expected a whole number from 1 to 1000"},
             Case{{.repeats = "1001"}, "--repeats: found \"1001\""},
         }) {
        const std::string error = error_of(c.request);
        EXPECT_EQ(error.rfind(c.expected, 0), 0U) << error;
        EXPECT_EQ(std::count(error.begin(), error.end(), '\n'), 0);
    }
    SimulationOptions empty = scene();
    empty.duration = 0.0;
    EXPECT_NE(error_of({}, empty).find("duration is 0 s"), std::string::npos);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
