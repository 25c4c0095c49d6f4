#include "lab/compare/comparison.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

#include "lab/compare/comparison_files.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kGravity = 9.81;
constexpr double kHeight = 1.0;
constexpr double kDuration = 0.6;  // the first impact is at sqrt(2 h / g) = 0.45 s, the others follow shortly after

SimulationSetup falling_points() {
    SimulationSetup setup;
    setup.options.time_step = 0.02;
    setup.options.duration = kDuration;
    setup.forces.push_back(make_gravity({0, 0, -kGravity}));
    setup.materials.push_back({.name = "elastic"});
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0});
    for (int i = 0; i < 20; ++i) {
        Particle particle;
        particle.position = {0.1 * i, 0, kHeight + 0.01 * i};
        particle.velocity = {0.5, 0, 0};
        setup.particles.push_back(particle);
    }
    return setup;
}

ComparisonPlan plan_of(const std::string& responses, const std::string& steps = "0.005,0.02") {
    ComparisonRequest request;
    request.responses = responses;
    request.time_steps = steps;
    request.repeats = "1";
    return make_plan(request, falling_points().options);
}

Comparison compared(const std::string& responses) {
    auto comparison = compare_responses(falling_points(), plan_of(responses));
    return std::move(comparison.value());
}

// Returns compare.csv without the columns of run times.
std::string numbers_of(const Comparison& comparison) {
    std::string text;
    for (const ComparisonRow* row : comparison.listed_rows()) {
        for (const ComparisonColumn& column : comparison_columns()) {
            if (std::string(column.name).rfind("cost_", 0) == 0) continue;
            std::ostringstream cell;
            cell.precision(17);
            std::visit([&](const auto& value) { cell << value; }, column.cell(*row, comparison));
            text += cell.str() + ",";
        }
        text += "\n";
    }
    return text;
}

TEST(Comparison, RowsAreInTheOrderOfThePlanAndStepsDescend) {
    const Comparison comparison = compared("project,exact");
    ASSERT_EQ(comparison.rows.size(), 4U);
    EXPECT_EQ(name_of(comparison.rows[0].response), "project");
    EXPECT_EQ(name_of(comparison.rows[2].response), "exact");
    for (const std::size_t i : {0U, 2U}) {
        EXPECT_EQ(comparison.rows[i].time_step, 0.02);
        EXPECT_EQ(comparison.rows[i + 1].time_step, 0.005);
    }
}

TEST(Comparison, ExactIsRunAsTheBaseEvenIfNotRequested) {
    const Comparison comparison = compared("project");
    EXPECT_EQ(comparison.rows.size(), 4U);
    ASSERT_EQ(comparison.listed_rows().size(), 2U);
    EXPECT_EQ(name_of(comparison.listed_rows()[0]->response), "project");
    EXPECT_GT(comparison.listed_rows()[0]->cost.ratio_at_equal_step, 0.0);
    EXPECT_EQ(comparison_csv(comparison).find("exact"), std::string::npos);
}

TEST(Comparison, ExactUnderGravityAloneIsRightToRoundingAtAnyStep) {
    const Comparison comparison = compared("exact");
    for (const ComparisonRow* row : comparison.listed_rows()) {
        EXPECT_EQ(row->errors.position.count, 20U);
        EXPECT_LT(row->errors.position.largest, 1e-12);
        EXPECT_LT(row->errors.impact.largest, 1e-12);
        EXPECT_LT(row->errors.energy_largest, 1e-12);
        EXPECT_EQ(row->errors.impacts_missed + row->errors.impacts_extra, 0U);
        EXPECT_EQ(row->figures.tunnel.tunnelled, 0U);
        EXPECT_EQ(row->figures.statistics.penetrations, 0U);
        EXPECT_EQ(row->cost.ratio_at_equal_step, 1.0);
    }
}

TEST(Comparison, ProjectPenetratesByNoMoreThanTheDistanceOfAStep) {
    const Comparison comparison = compared("project");
    const double fastest = std::sqrt(2.0 * kGravity * (kHeight + 0.2));
    for (const ComparisonRow* row : comparison.listed_rows()) {
        EXPECT_GT(row->figures.statistics.penetration_deepest, 0.0);
        EXPECT_LE(row->figures.statistics.penetration_deepest, (fastest + kGravity * row->time_step) * row->time_step);
        EXPECT_GT(row->errors.position.largest, 1e-6);
        EXPECT_LE(row->errors.impact.largest, row->time_step * (1.0 + 1e-9));  // detected at the end of the step
        EXPECT_EQ(row->errors.impact.count, 20U);
        EXPECT_EQ(row->equal_error_step, 0.02);  // exact is better even at the longest step
    }
}

TEST(Comparison, AThinPlateIsJumpedIfAStepIsLongerThanItsThickness) {
    SimulationSetup setup = falling_points();
    setup.colliders[0] = {"plate", CuboidShape{{10, 10, 0.001}, {}}, 0};
    const auto comparison = compare_responses(std::move(setup), plan_of("project", "0.02"));
    ASSERT_TRUE(comparison);
    EXPECT_GT(comparison->rows[0].figures.tunnel.jumped, 10U);
    EXPECT_EQ(comparison->rows[0].figures.tunnel.tunnelled, comparison->rows[0].figures.tunnel.jumped);
    EXPECT_EQ(comparison->rows[1].figures.tunnel.tunnelled, 0U);  // exact
}

TEST(Comparison, ASoftPlateIsCrossedInSeveralSegments) {
    for (const bool ball : {false, true}) {
        SimulationSetup setup = falling_points();
        setup.options.penalty.stiffness = 1.0;
        ColliderShape shape = CuboidShape{{10, 10, 0.1}, {}};
        if (ball) shape = BallShape{0.05, {.position = {0.25, 0, 0}}};
        setup.particles.resize(1);
        setup.colliders[0] = {"body", shape, 0};
        const auto comparison = compare_responses(std::move(setup), plan_of("penalty", "0.01"));
        ASSERT_TRUE(comparison);
        EXPECT_EQ(comparison->rows[0].figures.tunnel.passed, 1U) << ball;
        EXPECT_EQ(comparison->rows[0].figures.tunnel.jumped, 0U) << ball;
        EXPECT_EQ(comparison->rows[0].figures.tunnel.tunnelled, 1U) << ball;
    }
}

TEST(Comparison, GivesTheSameNumbersTwice) {
    const std::string responses = "exact,rollback,rollback:global,project,penalty";
    const std::string first = numbers_of(compared(responses));
    EXPECT_EQ(first, numbers_of(compared(responses)));
    EXPECT_NE(first.find("rollback:global"), std::string::npos);
}

TEST(Comparison, EveryColumnIsInTheDocument) {
    std::ifstream file(RICOCHET_SOURCE_DIR "/docs/compare.md");
    const std::string document{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    for (const ComparisonColumn& column : comparison_columns()) {
        EXPECT_NE(document.find("`" + std::string(column.name) + "`"), std::string::npos) << column.name;
    }
}

TEST(Comparison, EndsIfTheHookRequestsIt) {
    std::size_t calls = 0;
    const auto stopped = compare_responses(falling_points(), plan_of("exact"), [&](const ComparisonProgress& progress) {
        EXPECT_LE(progress.run, progress.runs);
        return ++calls < 300;
    });
    EXPECT_FALSE(stopped);
    EXPECT_EQ(calls, 300U);
}

TEST(Comparison, PlotsOfZerosOrNoDataHavePlainAxes) {
    const std::string script = comparison_script(compared("exact"));
    EXPECT_NE(script.find("exact (0 everywhere)"), std::string::npos);
    EXPECT_NE(script.find("set yrange [-0.05:1]"), std::string::npos);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
