// Comparisons of scenes with springs, custom solvers or child particles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "lab/compare/comparison.h"
#include "ricochet/core/error.h"
#include "ricochet/io/scene.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

/// Returns the plan for the given steps, in s, in descending order.
ComparisonPlan plan_of(const SimulationSetup& setup, const std::string& responses, const std::vector<double>& steps) {
    ComparisonRequest request;
    request.responses = responses;
    request.repeats = "1";
    request.time_steps = std::to_string(0.5 * setup.options.duration);
    ComparisonPlan plan = make_plan(request, setup.options);
    plan.time_steps = steps;
    plan.reference_step = 0.5 * steps.back();
    return plan;
}

Simulation finished(SimulationSetup setup) {
    Simulation simulation(std::move(setup));
    simulation.advance(simulation.step_count());
    return simulation;
}

/// A pinned rope of 20 nodes that swings down onto a floor.
SimulationSetup rope(double time_step, double stiffness = 500.0) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = 0.6;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.materials.push_back({.name = "wood", .restitution = 0.5, .friction = 0.3});
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0});
    for (std::uint64_t i = 0; i < 20; ++i) {
        Particle particle;
        particle.position = {0.05 * static_cast<double>(i), 0.0, 0.6};
        particle.mass = 0.02;
        particle.pinned = i == 0;
        setup.particles.push_back(particle);
        if (i > 0) setup.springs.push_back({i - 1, i, 0.05, stiffness, 0.1});
    }
    return setup;
}

TEST(ComparisonOfSprings, ExactRowsAreTheRunItself) {
    for (const double step : {0.002, 0.001}) {
        const auto comparison = compare_responses(rope(step), plan_of(rope(step), "exact", {step}));
        const Simulation alone = finished(rope(step));
        EXPECT_EQ(comparison->rows[0].figures.state_hash, alone.state_hash());
        EXPECT_EQ(comparison->rows[0].figures.statistics.contacts, alone.statistics().contacts);
    }
}

TEST(ComparisonOfSprings, ADivergingRopeIsReported) {
    const auto exploding = [] { return rope(0.02, 5e4); };
    EXPECT_THROW(finished(exploding()), DivergedError);
    EXPECT_THROW((void)compare_responses(exploding(), plan_of(exploding(), "exact", {0.02})), DivergedError);
}

/// Returns the message of the error that ends a comparison.
std::string end_of_comparison(const ComparisonPlan& plan) {
    try {
        (void)compare_responses(rope(0.02, 5e4), plan);
    } catch (const DivergedError& error) {
        return error.what();
    }
    return "nothing";
}

// The reference's step is short enough for the springs, but the steps of the rows are too long.
TEST(ComparisonOfSprings, ReportsTheDivergingRowAndARemedy) {
    ComparisonPlan plan = plan_of(rope(0.02, 5e4), "rollback", {0.02});
    plan.reference_step = 5e-4;
    const std::string row = end_of_comparison(plan);
    EXPECT_NE(row.find("a row, rollback at 0.02 s, cannot be compared: at t = "), std::string::npos) << row;
    EXPECT_NE(row.find("use a shorter time step"), std::string::npos) << row;
    EXPECT_NE(row.find("--time-steps"), std::string::npos) << row;
    EXPECT_EQ(row.find('\n'), std::string::npos) << row;
    plan.reference_step = 0.01;
    const std::string reference = end_of_comparison(plan);
    EXPECT_NE(reference.find("the reference, exact at 0.01 s, cannot be compared: "), std::string::npos) << reference;
}

TEST(ComparisonOfSprings, ASolverOfTheUsersOwnStepsEveryRow) {
    const auto still = [] {
        SimulationSetup setup = rope(0.01);
        setup.solver = [](ParticleSystem&, double) {};  // no particle ever moves
        return setup;
    };
    const auto comparison = compare_responses(still(), plan_of(still(), "exact", {0.01}));
    EXPECT_EQ(comparison->rows[0].figures.state_hash, finished(still()).state_hash());
    EXPECT_EQ(comparison->rows[0].figures.statistics.contacts, 0U);
}

std::vector<std::filesystem::path> shipped_scenes() {
    std::vector<std::filesystem::path> scenes;
    const std::filesystem::path folder = std::filesystem::path(RICOCHET_SOURCE_DIR) / "scenes";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() == ".json") scenes.push_back(entry.path());
    }
    std::sort(scenes.begin(), scenes.end());
    return scenes;
}

TEST(ComparisonOfShippedScenes, ExactRowsEndInTheStateOfTheRun) {
    const double steps = test::is_long_run() ? 8.0 : 2.0;
    ASSERT_GT(shipped_scenes().size(), 20U);
    for (const std::filesystem::path& file : shipped_scenes()) {
        SCOPED_TRACE(file.string());
        const auto setup_of = [&] {
            SimulationSetup setup = read_scene(file, {}).setup;
            setup.options.response = ResponseKind::exact;
            setup.options.duration = std::min(setup.options.duration, steps * setup.options.time_step);
            return setup;
        };
        const double step = setup_of().options.time_step;
        const auto comparison = compare_responses(setup_of(), plan_of(setup_of(), "exact", {step}));
        EXPECT_EQ(comparison->rows[0].figures.state_hash, finished(setup_of()).state_hash());
    }
}

/// Rockets that shatter on a floor. Their short-lived pieces emit sparks at impacts and leave a trail.
SimulationSetup fireworks(double time_step) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = 0.9;
    setup.options.seed = 5;
    setup.forces.push_back(make_gravity({0, 0, -9.81}));
    setup.materials.push_back({.name = "stone", .restitution = 0.7, .friction = 0.1});
    setup.colliders.push_back({"floor", PlaneShape{{0, 0, 0}, {0, 0, 1}}, 0});
    EmitterDescription rockets;
    rockets.name = "rockets";
    rockets.shape = PointShape{{0, 0, 0.8}};
    rockets.rate = {60.0, 0.0};
    rockets.velocity = {0.5, 0.1, -1.0};
    rockets.speed = {0.5, 0.5};
    const auto child = [](const std::string& name, std::uint32_t parent, BirthEvent on, bool share, double count) {
        EmitterDescription emitter;
        emitter.name = name;
        ParentRule rule;
        rule.emitter = parent;
        rule.on = on;
        rule.share = share;
        rule.count = {count, 0.0};
        emitter.parent = rule;
        emitter.speed = {1.0, 0.3};
        emitter.lifetime = {0.15, 0.05};
        return emitter;
    };
    setup.emitters = {rockets, child("pieces", 0, BirthEvent::impact, true, 3.0),
                      child("sparks", 1, BirthEvent::impact, false, 2.0)};
    EmitterDescription trail = child("trail", 0, BirthEvent::life, false, 1.0);
    trail.rate = {45.0, 0.0};
    setup.emitters.push_back(trail);
    return setup;
}

TEST(ComparisonOfChildren, ExactAgainstItselfAtOtherStepsMatchesEveryParticle) {
    const ComparisonPlan plan = plan_of(fireworks(0.02), "exact", {0.02, 0.008});
    const auto comparison = compare_responses(fireworks(0.02), plan);
    EXPECT_GT(comparison->reference.figures.statistics.children, 150U);
    for (const ComparisonRow& row : comparison->rows) {
        EXPECT_EQ(row.figures.statistics.emitted, comparison->reference.figures.statistics.emitted);
        EXPECT_EQ(row.figures.alive, comparison->reference.figures.alive);
        EXPECT_EQ(row.errors.position.count, row.figures.alive);
        EXPECT_EQ(row.errors.impacts_missed, 0U);
        EXPECT_EQ(row.errors.impacts_extra, 0U);
        EXPECT_LT(row.errors.position.largest, 1e-9);
        EXPECT_LT(row.errors.impact.largest, 1e-9);
    }
}

TEST(ComparisonOfChildren, CountsChildrenMissingFromAResponse) {
    const auto comparison = compare_responses(fireworks(0.02), plan_of(fireworks(0.02), "project", {0.02}));
    const ComparisonRow& row = comparison->rows[0];
    EXPECT_GT(row.errors.position.count, 0U);
    EXPECT_LE(row.errors.position.count, std::min(row.figures.alive, comparison->reference.figures.alive));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
