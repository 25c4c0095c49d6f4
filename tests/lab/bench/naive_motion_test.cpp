// Tests the naive treatment of moving colliders that the benchmark compares with. It works in simple cases and loses
// particles in others.
#include "lab/bench/naive_motion.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "lab/bench/case_run.h"
#include "lab/bench/measurement.h"
#include "lab/bench/moving_case.h"
#include "lab/bench/small_cases.h"
#include "support/simple_meshes.h"

namespace ricochet::bench {
namespace RICOCHET_FILE {

/// Returns a box of 2 m that is centred on the origin at 0 s and moves along x at the given speed, in m/s.
NaiveMotion box_at(double speed) {
    const KeyedTranslation translation{KeyedCurve<Vec3>({{0.0, {}}, {100.0, {100.0 * speed, 0, 0}}})};
    const auto frames = std::make_shared<const FrameTree>(
        std::vector<FrameDescription>{{"box", "", {}, {0, 0, 1}, 0.0, {translation}}});
    const auto mesh = std::make_shared<const TriangleMesh>(testing::box_mesh({-1, -1, -1}, {1, 1, 1}));
    return NaiveMotion({{"box", MeshShape{mesh, {}, ""}, 0, "box"}}, frames);
}

TEST(NaiveMotion, BouncesOffARecedingWall) {
    NaiveMotion motion = box_at(-0.5);
    std::vector<Flight> flights{{{3.9, 0.2, 0.1}, {-2.0, 0.0, 0.0}}};
    // From 1.75 s to 2 s the particle moves from 0.4 m to -0.1 m. The wall is at 0 then.
    EXPECT_EQ(motion.run(flights, {0.0, 0.25, 12, 1.0}), 1U);
    EXPECT_NEAR(flights[0].velocity.x, 1.0, 1e-12);  // v + 2 (w - v)
    EXPECT_NEAR(flights[0].position.x, 1.0, 1e-5);
}

TEST(NaiveMotion, StaysInsideABoxAtRest) {
    NaiveMotion motion = box_at(0.0);
    std::vector<Flight> flights{{{0.1, 0.2, 0.3}, {1.0, 0.7, -0.4}}, {{-0.5, 0.2, 0.3}, {-0.3, 0.7, 0.4}}};
    EXPECT_GT(motion.run(flights, {0.0, 0.1, 100, 1.0}), 10U);
    for (const Flight& flight : flights) EXPECT_LT(max_abs(flight.position), 1.0);
}

// A fast wall passes over a slow particle, because no ray of the particle crosses the wall.
TEST(NaiveMotion, LosesParticlesThatAWallPassesOver) {
    NaiveMotion motion = box_at(1.0);
    std::vector<Flight> flights{{{0.0, 0.2, 0.1}, {0.0, 0.0, 0.0}}};
    EXPECT_EQ(motion.run(flights, {0.0, 0.25, 12, 1.0}), 0U);
    EXPECT_EQ(flights[0].position, Vec3(0.0, 0.2, 0.1));  // the box is at 3 m
}

std::vector<Case> small_moving_cases() {
    std::vector<Case> cases = cases_of("moving");
    for (Case& c : cases) {
        c = small_copy(c, 60, 2000);
        c.steps = std::min<std::uint64_t>(c.steps, 6);
    }
    return cases;
}

TEST(BenchCases, MovingCasesAreListedBesideTheCaseAtRest) {
    const std::vector<Case> cases = cases_of("moving");
    ASSERT_EQ(cases.size() % 2, 0U);
    for (std::size_t k = 0; k < cases.size(); k += 2) {
        Case moving = cases[k + 1];
        EXPECT_EQ(cases[k].moves, Moves::nothing);
        EXPECT_NE(moving.moves, Moves::nothing);
        EXPECT_FALSE(cases[k].looks_ahead);
        moving.moves = cases[k].moves;
        moving.name = cases[k].name;
        EXPECT_EQ(moving.base, cases[k].base);
        EXPECT_EQ(moving.time_step, cases[k].time_step);
        EXPECT_EQ(moving.particles, cases[k].particles);
        EXPECT_EQ(make_setup(cases[k], make_mesh(small_copy(cases[k], 1, 2000))).frames, nullptr);
    }
}

TEST(BenchCases, MovingCasesLoseNoParticle) {
    for (const Case& c : small_moving_cases()) {
        SCOPED_TRACE(c.name);
        const auto mesh = make_mesh(c);
        SimulationSetup setup = make_setup(c, mesh);
        setup.options.verify = true;
        setup.particles = make_particles(c, *mesh);
        Simulation simulation(std::move(setup));
        while (!simulation.finished()) simulation.step();
        EXPECT_EQ(simulation.statistics().violations, 0U);
        EXPECT_EQ(simulation.statistics().squeezed, 0U);
    }
}

TEST(Measurement, ReportsCostsAndLeaksOfTheNaiveMethodForMovingCases) {
    std::uint64_t lost = 0;
    for (const std::vector<Case>& full : groups_of("moving")) {
        std::vector<Case> group;
        for (const Case& c : full) group.push_back(small_copy(c, 200, 2000));
        const auto rows = measure_group(group, {{1}, 1});
        ASSERT_TRUE(rows.has_value());
        ASSERT_EQ(rows->size(), 2U);
        SCOPED_TRACE((*rows)[1].name);
        EXPECT_EQ((*rows)[0].ratio_rest, 1.0);
        EXPECT_FALSE((*rows)[0].ratio_naive.has_value());
        EXPECT_GT((*rows)[1].ratio_rest.value_or(0.0), 0.0);
        EXPECT_GT((*rows)[1].ratio_naive.value_or(0.0), 0.0);
        EXPECT_EQ((*rows)[1].naive_leaks.has_value(), group[0].ground == Ground::cavity);
        lost += (*rows)[1].naive_leaks.value_or(0);
        // A collider that moves far away changes no bit.
        if (group[1].moves == Moves::bystander) {
            EXPECT_EQ((*rows)[0].state_hash, (*rows)[1].state_hash);
        }
    }
    EXPECT_GT(lost, 0U);
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
