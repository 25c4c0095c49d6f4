#include "lab/bench/measurement.h"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <vector>

#include "lab/bench/small_cases.h"

namespace ricochet::bench {
namespace RICOCHET_FILE {

TEST(Measurement, EndsInTheSameStateForAnyNumberOfThreads) {
    for (const char* suite : {"gas", "settle", "pinball"}) {
        const auto rows = measure_case(small_case(suite, 600, 2000), {{1, 2}, 1});
        ASSERT_TRUE(rows.has_value());
        ASSERT_EQ(rows->size(), 2U) << suite;
        EXPECT_EQ((*rows)[0].threads, 1);
        EXPECT_EQ((*rows)[1].threads, 2);
        EXPECT_EQ((*rows)[0].state_hash, (*rows)[1].state_hash);
        EXPECT_EQ((*rows)[0].contacts, (*rows)[1].contacts);
        EXPECT_NE((*rows)[0].state_hash, 0U);
    }
}

TEST(Measurement, CountsStepsAndContacts) {
    const Case c = small_case("pinball", 300, 2000);
    const auto rows = measure_case(c, {{1}, 2});
    ASSERT_TRUE(rows.has_value());
    const Row& row = rows->front();
    EXPECT_EQ(row.particles, 300U);
    EXPECT_EQ(row.steps, c.steps);
    EXPECT_EQ(row.particle_steps, 300U * c.steps);
    EXPECT_GE(row.contacts, row.particle_steps);
    EXPECT_EQ(row.response, "exact");
    EXPECT_GT(row.seconds, 0.0);
    EXPECT_GT(row.ratio_raw, 0.0);
    EXPECT_GT(row.ratio_native_bounces.value_or(0.0), 0.0);
    ASSERT_TRUE(row.leaks.has_value());
    EXPECT_LE(*row.leaks, row.particle_steps);
}

TEST(Measurement, ReportsNoLeaksOfAnOpenMesh) {
    const auto rows = measure_case(small_case("hail", 200, 2000), {{1}, 1});
    ASSERT_TRUE(rows.has_value());
    EXPECT_FALSE(rows->front().leaks.has_value());
}

TEST(Measurement, EndsIfTheHookRequestsIt) {
    int calls = 0;
    const auto rows = measure_case(small_case("gas", 100, 500), {{1}, 1}, [&](const Progress&) { return ++calls < 4; });
    EXPECT_FALSE(rows.has_value());
    EXPECT_EQ(calls, 4);
}

TEST(Measurement, ReportsItsProgress) {
    std::set<std::string> works;
    std::uint64_t last_step = 0;
    const Case c = small_case("gas", 100, 500);
    const auto rows = measure_case(c, {{1}, 2}, [&](const Progress& progress) {
        works.insert(std::string(progress.doing));
        EXPECT_EQ(progress.name, progress.doing == "mesh" ? "" : c.name);
        EXPECT_EQ(progress.threads, progress.repeat == 0 ? 0 : 1);
        EXPECT_LE(progress.repeat, 2U);
        if (progress.doing == "simulation") last_step = progress.step;
        return true;
    });
    ASSERT_TRUE(rows.has_value());
    EXPECT_EQ(works, (std::set<std::string>{"mesh", "particles", "memory", "warm-up", "first run", "references",
                                            "collision structures", "simulation", "raw rays",
                                            "raw rays in spatial order", "native bounces"}));
    EXPECT_EQ(last_step, c.steps);
}

std::vector<Case> small_group(std::string_view suite) {
    std::vector<Case> group = groups_of(suite).front();
    for (Case& c : group) c = small_copy(c, 300, 1000);
    return group;
}

TEST(Measurement, ReportsCostsRelativeToTheFirstCaseOfAGroup) {
    for (const char* suite : {"radius", "response"}) {
        SCOPED_TRACE(suite);
        const std::vector<Case> group = small_group(suite);
        const auto rows = measure_group(group, {{1, 2}, 1});
        ASSERT_TRUE(rows.has_value());
        ASSERT_EQ(rows->size(), 2 * group.size());
        for (std::size_t i = 0; i < rows->size(); ++i) {
            const Row& row = (*rows)[i];
            EXPECT_EQ(row.name, group[i / 2].name);
            EXPECT_EQ(row.response, name_of(group[i / 2].response));
            EXPECT_EQ(row.threads, static_cast<int>(1 + i % 2));
            const bool is_of_radii = group.front().against == Against::points;
            EXPECT_EQ(row.ratio_points.has_value(), is_of_radii);
            EXPECT_EQ(row.ratio_exact.has_value(), !is_of_radii);
            EXPECT_EQ(row.leaks.has_value(), row.response == "exact");
            const double cost = is_of_radii ? row.ratio_points.value_or(0.0) : row.ratio_exact.value_or(0.0);
            EXPECT_TRUE(i >= 2 || cost == 1.0) << cost;
            const Row& base = (*rows)[i % 2];  // with one repeat, the cost is the quotient of the rates
            EXPECT_NEAR(cost * row.particle_steps_per_second / base.particle_steps_per_second, 1.0, 1e-9);
        }
    }
}

TEST(Measurement, ReportsNoRelativeCostOfASingleCase) {
    const auto rows = measure_case(small_case("gas", 100, 500), {{2}, 1});
    ASSERT_TRUE(rows.has_value());
    EXPECT_FALSE(rows->front().ratio_points.has_value());
    EXPECT_FALSE(rows->front().ratio_exact.has_value());
}

TEST(Measurement, ReportsSpeedupsOnlyBesideARunOnOneThread) {
    const Case c = small_case("gas", 300, 500);
    const auto both = measure_case(c, {{2, 1}, 1});
    ASSERT_TRUE(both.has_value());
    const Row& two = both->front();
    const Row& one = both->back();
    EXPECT_EQ(one.speedup, 1.0);
    EXPECT_EQ(one.speedup_raw, 1.0);
    EXPECT_NEAR(two.speedup.value_or(0.0), one.seconds / two.seconds, 1e-9);
    EXPECT_NEAR(two.speedup_raw.value_or(0.0), two.raw_rays_per_second / one.raw_rays_per_second, 1e-9);
    const auto alone = measure_case(c, {{2}, 1});
    ASSERT_TRUE(alone.has_value());
    EXPECT_FALSE(alone->front().speedup.has_value());
    EXPECT_FALSE(alone->front().speedup_raw.has_value());
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
