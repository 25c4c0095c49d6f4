#include "lab/study/study_plan.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "ricochet/core/error.h"
#include "support/temporary_folder.h"

namespace ricochet {
namespace RICOCHET_FILE {

using Texts = std::vector<std::string>;

StudyPlan plan_of(const std::string& text) {
    const test::TemporaryFolder folder;
    return read_study(folder.write("study.json", text));
}

/// Returns the message of a refusal, after the name of the file.
std::string refusal_of(const std::string& text) {
    try {
        (void)plan_of(text);
    } catch (const InputError& error) {
        const std::string message = error.what();
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        const std::size_t end = message.find("study.json: ");
        return end == std::string::npos ? message : message.substr(end + 12);
    }
    return "";
}

std::string study_with(const std::string& axes, const std::string& more = "") {
    return R"({"ricochet_study": 1, "scene": "a.json", "axes": [)" + axes + R"(], "results": ["contacts"])" + more +
           "}";
}

TEST(StudyPlan, HasTheKeysOfTheFile) {
    const StudyPlan plan = plan_of(R"({"ricochet_study": 1, "scene": "a/b.json", "set": {"output.every": 100},
        "axes": [{"key": "materials.m.friction", "values": [0.1, 0.25]}, {"key": "simulation.response",
        "values": ["exact", "project"]}], "repeats": 3, "seed": 7, "results": ["contacts", "counters.out.forward"]})");
    EXPECT_EQ(plan.scene.filename(), "b.json");
    EXPECT_EQ(plan.overrides, Texts{"output.every=100"});
    ASSERT_EQ(plan.axes.size(), 2U);
    EXPECT_EQ(plan.axes[0].key, "materials.m.friction");
    EXPECT_EQ(plan.axes[0].values, (Texts{"0.1", "0.25"}));
    EXPECT_EQ(plan.axes[1].values, (Texts{R"("exact")", R"("project")"}));
    EXPECT_EQ(plan.repeats, 3U);
    EXPECT_EQ(plan.seed, std::optional<std::uint64_t>(7));
    EXPECT_EQ(plan.results, (Texts{"contacts", "counters.out.forward"}));
}

TEST(StudyPlan, SpacesValuesEqually) {
    const StudyPlan linear = plan_of(study_with(R"({"key": "a", "from": 1, "to": 2, "count": 5})"));
    EXPECT_EQ(linear.axes[0].values, (Texts{"1", "1.25", "1.5", "1.75", "2"}));
    const StudyPlan log = plan_of(study_with(R"({"key": "a", "from": 1, "to": 16, "count": 3, "spacing": "log"})"));
    EXPECT_EQ(log.axes[0].values, (Texts{"1", "4", "16"}));
}

TEST(StudyPlan, RunsAreAllCombinationsWithTheLastAxisFastest) {
    StudyPlan plan;
    plan.overrides = {"x=0"};
    plan.axes = {{"a", {"1", "2"}}, {"b", {"3", "4", "5"}}};
    plan.repeats = 2;
    plan.seed = 10;
    const std::vector<StudyRun> runs = runs_of(plan);
    ASSERT_EQ(runs.size(), 12U);
    EXPECT_EQ(runs[0].overrides, (Texts{"x=0", "a=1", "b=3", "simulation.seed=10"}));
    EXPECT_EQ(runs[1].overrides, (Texts{"x=0", "a=1", "b=3", "simulation.seed=11"}));
    EXPECT_EQ(runs[11].overrides, (Texts{"x=0", "a=2", "b=5", "simulation.seed=11"}));
    EXPECT_EQ(runs[11].number, 12U);
    EXPECT_EQ(runs[11].study_case, 6U);
    EXPECT_EQ(runs[11].repeat, 2U);
}

TEST(StudyPlan, OneRepeatKeepsTheSeedOfTheScene) {
    const StudyPlan plan = plan_of(study_with(R"({"key": "a", "values": [1]})"));
    EXPECT_EQ(runs_of(plan).at(0).overrides, Texts{"a=1"});
    const StudyPlan repeated = plan_of(study_with(R"({"key": "a", "values": [1]})", R"(, "repeats": 2)"));
    EXPECT_EQ(runs_of(repeated).at(1).overrides, (Texts{"a=1", "simulation.seed=1"}));
}

TEST(StudyPlan, RefusesInvalidStudiesInOneLine) {
    const std::string axis = R"({"key": "a", "values": [1]})";
    EXPECT_EQ(refusal_of("{"), "not valid JSON at byte 2");
    EXPECT_EQ(refusal_of(R"({"repeats": 1, "repeats": 2})"), R"(the key "repeats" is there twice, expected it once)");
    EXPECT_EQ(refusal_of(R"({"ricochet": 1})"),
              "ricochet: this is a scene, expected a study; `ricochet run` runs a scene");
    EXPECT_EQ(refusal_of(study_with(axis, R"(, "set": {"a": 2})")),
              R"(set: "a" is also an axis, expected one of them)");
    EXPECT_EQ(refusal_of(study_with(R"({"key": "a", "values": [1, 2, 1]})")),
              "axes[0].values: 1 is there twice, expected each value once");
    EXPECT_EQ(refusal_of(study_with(R"({"key": "simulation.seed", "values": [1]})", R"(, "repeats": 2)")),
              R"(repeats: found beside the key "simulation.seed", which repeats set, expected `seed` instead)");
    EXPECT_EQ(refusal_of("[]"), "found a list of 0, expected an object");
    EXPECT_EQ(refusal_of("{}"), "ricochet_study: is missing, expected to be given; see docs/studies.md");
    EXPECT_EQ(refusal_of(study_with("")), "axes: found a list of 0, expected a list with at least one entry");
    EXPECT_EQ(refusal_of(study_with(axis, R"(, "repeats": 0)")),
              "repeats: found 0, expected a whole number from 1 to 10000");
    EXPECT_EQ(refusal_of(study_with(axis + "," + axis)), R"(axes: "a" is there twice, expected each key once)");
    EXPECT_EQ(refusal_of(study_with(R"({"key": "a", "values": []})")),
              "axes[0].values: found a list of 0, expected a list with at least one entry");
    EXPECT_EQ(refusal_of(study_with(R"({"key": "a", "values": [1], "from": 1})")),
              "axes[0].from: found beside `values`, expected one of them");
    EXPECT_EQ(refusal_of(study_with(R"({"key": "a", "from": 0, "to": 1, "count": 3, "spacing": "log"})")),
              R"(axes[0].from: expected numbers > 0 with the spacing "log")");
    EXPECT_EQ(refusal_of(study_with(R"({"key": "a", "from": 0, "to": 1, "count": 1})")),
              "axes[0].count: found 1, expected a whole number from 2 to 100000");
    EXPECT_NE(refusal_of(study_with(axis, R"(, "axis": 1)")).find("axis: unknown key; known keys: "),
              std::string::npos);
    const std::string many = R"({"key": "KEY", "from": 0, "to": 1, "count": 1000})";
    std::string other = many;
    other.replace(other.find("KEY"), 3, "b");
    EXPECT_EQ(refusal_of(study_with(many + "," + other)),
              "axes: more than 100000 runs, expected fewer values or repeats");
}

TEST(StudyPlan, AMissingFileIsRefused) {
    EXPECT_THROW((void)read_study("/nowhere/study.json"), InputError);
    EXPECT_THROW((void)read_study("/"), InputError);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
