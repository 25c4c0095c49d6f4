#include "bench/measurement.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "bench/measurement_report.h"
#include "bench/small_cases.h"

namespace ricochet::bench {
namespace {

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

TEST(Measurement, CountsWhatTheStepsDo) {
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

TEST(Measurement, KnowsNoLeaksWhereTheMeshIsOpen) {
    const auto rows = measure_case(small_case("hail", 200, 2000), {{1}, 1});
    ASSERT_TRUE(rows.has_value());
    EXPECT_FALSE(rows->front().leaks.has_value());
}

TEST(Measurement, EndsWhenTheHookSaysSo) {
    int calls = 0;
    const auto rows = measure_case(small_case("gas", 100, 500), {{1}, 1}, [&](const Progress&) { return ++calls < 4; });
    EXPECT_FALSE(rows.has_value());
    EXPECT_EQ(calls, 4);
}

TEST(MeasurementReport, HasTheKeysThatItPromises) {
    Row row;
    row.suite = "gas";
    row.state_hash = 0xAB;
    const auto json = nlohmann::json::parse(to_json(std::vector<Row>{row, row}));
    ASSERT_EQ(json.size(), 2U);
    std::set<std::string> keys;
    for (const auto& entry : json[0].items()) keys.insert(entry.key());
    EXPECT_EQ(keys, (std::set<std::string>{"suite",
                                           "case",
                                           "response",
                                           "particles",
                                           "triangles",
                                           "threads",
                                           "steps",
                                           "seconds",
                                           "particle_steps_per_second",
                                           "contacts_per_second",
                                           "raw_rays_per_second",
                                           "ratio_raw",
                                           "raw_sorted_rays_per_second",
                                           "ratio_raw_sorted",
                                           "native_bounces_per_second",
                                           "ratio_native_bounces",
                                           "leaks",
                                           "state_hash",
                                           "bytes_per_particle",
                                           "bytes_per_triangle"}));
    EXPECT_EQ(json[0]["suite"], "gas");
    EXPECT_EQ(json[0]["state_hash"], "00000000000000ab");
    EXPECT_TRUE(json[0]["leaks"].is_null());
    EXPECT_TRUE(json[0]["ratio_native_bounces"].is_null());
}

TEST(MeasurementReport, HasACellForEveryColumn) {
    Row row;
    row.particle_steps = 1;
    const auto table = to_table(std::vector<Row>{row});
    ASSERT_EQ(table.size(), 2U);
    EXPECT_EQ(table[0].size(), table[1].size());
}

}  // namespace
}  // namespace ricochet::bench
