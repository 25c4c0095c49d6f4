// A ball is dropped on a floor. Its impacts, its apexes, the time to rest and the path length match the closed form.
// The result must not depend on the time step and the triangulation of the floor.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "collision/worlds.h"
#include "ricochet/simulation.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

constexpr double kG = 9.81;
constexpr double kHeight = 1.0;
const double kFall = std::sqrt(2.0 * kHeight / kG);

struct Bounce {
    double time;
    double rebound;  // in m/s
    [[nodiscard]] double apex() const { return rebound * rebound / (2.0 * kG); }
};

struct Drop {
    std::vector<Bounce> bounces;
    bool rests = false;
    double end_height = 0.0;
};

Drop drop(ColliderDescription floor, double restitution, double time_step, double duration) {
    SimulationSetup setup;
    setup.options.time_step = time_step;
    setup.options.duration = duration;
    setup.options.record_contacts = true;
    setup.forces.push_back(make_gravity({0, 0, -kG}));
    setup.materials.push_back({"floor", restitution, 0.0});
    setup.colliders.push_back(std::move(floor));
    Particle ball;
    ball.position = {0.3, -0.2, kHeight};
    setup.particles.push_back(ball);
    Simulation simulation(std::move(setup));
    Drop result;
    while (!simulation.finished()) {
        simulation.step();
        for (const ContactRecord& record : simulation.contact_records()) {
            result.bounces.push_back({record.time, record.velocity_after.z});
        }
    }
    result.rests = simulation.particles().resting[0] != 0;
    result.end_height = simulation.particles().position[0].z;
    return result;
}

ColliderDescription plane() { return testing::plane_collider({0, 0, 0}, {0, 0, 1}); }
double time_to_rest(double e) { return kFall * (1.0 + e) / (1.0 - e); }

class DroppedBall : public ::testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Restitutions, DroppedBall, ::testing::Values(0.5, 0.8, 0.9),
                         [](const auto& e) { return fmt::format("e{}", std::lround(10.0 * e.param)); });

// Impact n occurs at t0 (1 + 2 (e + ... + e^(n - 1))). The apex after it has the height h e^(2n).
TEST_P(DroppedBall, MatchesTheClosedFormOfImpactsAndApexesAtAnyTimeStep) {
    const double e = GetParam();
    for (const double time_step : {1e-4, 1e-3, 1.0 / 60.0, 0.1, 1.0}) {
        SCOPED_TRACE(time_step);
        const Drop dropped = drop(plane(), e, time_step, 1.01 * time_to_rest(e));
        double time = kFall;
        double apex = kHeight;
        ASSERT_GE(dropped.bounces.size(), 9U);
        for (const Bounce& bounce : dropped.bounces) {
            apex *= e * e;
            EXPECT_NEAR(bounce.time, time, apex > 1e-3 ? 1e-11 * time : 1e-8);
            EXPECT_NEAR(bounce.apex(), apex, apex > 1e-3 ? 1e-11 * apex : 1e-11);
            time += 2.0 * std::sqrt(2.0 * apex / kG);
        }
    }
}

TEST_P(DroppedBall, ComesToRestAtTheTimeAndPathLengthOfTheSeries) {
    const double e = GetParam();
    const double total = time_to_rest(e);
    for (const double time_step : {1e-4, 1.0 / 60.0, 1.0}) {
        SCOPED_TRACE(time_step);
        // Without tangential motion, rebounds below v = 1 mm/s already count as rest. They last for the last 2 v / (g
        // (1 - e)) seconds.
        EXPECT_FALSE(drop(plane(), e, time_step, total - 2.1e-3 / (kG * (1.0 - e))).rests);
        const Drop dropped = drop(plane(), e, time_step, total + 2e-4);
        EXPECT_TRUE(dropped.rests);
        EXPECT_LT(dropped.end_height, 1e-14);
        const Bounce& last = dropped.bounces.back();
        EXPECT_NEAR(last.time + 2.0 * last.rebound / (kG * (1.0 - e)), total, 1e-8);
        double translation = kHeight;
        for (const Bounce& bounce : dropped.bounces) translation += 2.0 * bounce.apex();
        translation += 2.0 * last.apex() * e * e / (1.0 - e * e);
        EXPECT_NEAR(translation, kHeight * (1.0 + e * e) / (1.0 - e * e), 1e-10);
    }
}

TEST_P(DroppedBall, TakesTheTabulatedTimeAndPathLength) {
    struct Row {
        double e, time, translation;
    };
    for (const Row& row : {Row{0.5, 1.354571, 1.666667}, Row{0.8, 4.063713, 4.555556}, Row{0.9, 8.578949, 9.526316}}) {
        if (row.e != GetParam()) continue;
        const Drop dropped = drop(plane(), row.e, 0.01, row.time + 0.02);
        const Bounce& last = dropped.bounces.back();
        EXPECT_NEAR(last.time + 2.0 * last.rebound / (kG * (1.0 - row.e)), row.time, 1e-6);
        double translation = kHeight;
        for (const Bounce& bounce : dropped.bounces) translation += 2.0 * bounce.apex();
        EXPECT_NEAR(translation, row.translation, 2e-6);
    }
}

void expect_same_bits(const Drop& a, const Drop& b) {
    ASSERT_EQ(a.bounces.size(), b.bounces.size());
    for (std::size_t k = 0; k < a.bounces.size(); ++k) {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(a.bounces[k].time), std::bit_cast<std::uint64_t>(b.bounces[k].time));
        EXPECT_EQ(std::bit_cast<std::uint64_t>(a.bounces[k].rebound),
                  std::bit_cast<std::uint64_t>(b.bounces[k].rebound));
    }
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.end_height), std::bit_cast<std::uint64_t>(b.end_height));
}

TEST(DroppedBallOnMeshes, BouncesWithTheSameBitsOnAPlaneTwoTrianglesAndTwoMillion) {
    const int cells = test::kSanitized || !test::kOptimised ? 64 : 1024;
    for (const double e : test::chosen_cases<double>({0.9, 0.5, 1.0}, 3)) {
        SCOPED_TRACE(e);
        const Drop on_plane = drop(plane(), e, 0.01, 5.0);
        expect_same_bits(on_plane, drop(testing::mesh_collider(testing::floor_mesh(8.0, 1)), e, 0.01, 5.0));
        expect_same_bits(on_plane, drop(testing::mesh_collider(testing::floor_mesh(8.0, cells)), e, 0.01, 5.0));
    }
}

TEST(ElasticBall, KeepsItsHeightForTenThousandBounces) {
    const double period = 2.0 * kFall;
    for (const double time_step : {1.0 / 60.0, 0.25, 2.0}) {
        SCOPED_TRACE(time_step);
        const auto bounces = static_cast<std::size_t>(test::scaled(10000));
        const Drop dropped = drop(plane(), 1.0, time_step, kFall + (static_cast<double>(bounces) - 0.5) * period);
        ASSERT_EQ(dropped.bounces.size(), bounces);
        for (std::size_t k = 0; k < bounces; ++k) {
            ASSERT_NEAR(dropped.bounces[k].apex(), kHeight, 1e-9);
            ASSERT_NEAR(dropped.bounces[k].time, kFall + static_cast<double>(k) * period,
                        1e-9 * dropped.bounces[k].time);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
