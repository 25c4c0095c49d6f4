#include "lab/bench/records.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <vector>

namespace ricochet::bench {
namespace RICOCHET_FILE {

// Contract with readers of the numbers: keys may be added but never changed.
const std::vector<std::string> kContract = {"suite",
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
                                            "bytes_per_triangle"};

nlohmann::ordered_json json_of(const Record& record) {
    return nlohmann::ordered_json::parse(to_json(std::vector<Record>{record})).at(0);
}

std::vector<std::string> keys_of(const nlohmann::ordered_json& json) {
    std::vector<std::string> keys;
    for (const auto& entry : json.items()) keys.push_back(entry.key());
    return keys;
}

std::vector<std::string> with(std::vector<std::string> keys, const std::vector<std::string>& more) {
    keys.insert(keys.end(), more.begin(), more.end());
    return keys;
}

const std::vector<std::string> kRowKeys =
    with(kContract, {"contacts_per_particle_step", "ratio_points", "ratio_exact", "ratio_rest", "ratio_apart",
                     "seconds_a_simulated_second", "seconds_an_impact", "largest_overlap", "ratio_naive", "naive_leaks",
                     "speedup", "speedup_raw"});

TEST(BenchRecords, HaveTheContractedKeysForARow) {
    Row row;
    row.suite = "gas";
    row.state_hash = 0xAB;
    row.speedup = 1.5;
    row.particle_steps = 8;
    row.contacts = 2;
    const auto json = json_of(record_of(row));
    EXPECT_EQ(keys_of(json), kRowKeys);
    EXPECT_EQ(json["suite"], "gas");
    EXPECT_EQ(json["state_hash"], "00000000000000ab");
    EXPECT_EQ(json["speedup"], 1.5);
    EXPECT_EQ(json["contacts_per_particle_step"], 0.25);
    for (const char* key : {"leaks", "ratio_native_bounces", "ratio_points", "ratio_exact", "ratio_rest", "ratio_apart",
                            "seconds_an_impact", "ratio_naive", "naive_leaks", "speedup_raw"}) {
        EXPECT_TRUE(json[key].is_null()) << key;
    }
}

TEST(BenchRecords, HaveTheSameKeysAndTheirOwnForAFile) {
    LoadRow row;
    row.name = "ply";
    row.format = "PLY, binary";
    row.triangles = 3000;
    row.threads = 2;
    row.file_bytes = 100'000;
    row.read_seconds = 0.5;
    row.build_seconds = 0.25;
    const auto json = json_of(record_of(row));
    EXPECT_EQ(keys_of(json),
              with(kRowKeys, {"format", "file_bytes", "read_seconds", "build_seconds", "read_bytes_per_second",
                              "read_triangles_per_second", "build_triangles_per_second"}));
    for (const std::string& key : kRowKeys) {
        const bool applies = key == "suite" || key == "case" || key == "triangles" || key == "threads";
        EXPECT_NE(json[key].is_null(), applies) << key;
    }
    EXPECT_EQ(json["suite"], "load");
    EXPECT_EQ(json["case"], "ply");
    EXPECT_EQ(json["format"], "PLY, binary");
    EXPECT_EQ(json["read_bytes_per_second"], 200'000.0);
    EXPECT_EQ(json["read_triangles_per_second"], 6000.0);
    EXPECT_EQ(json["build_triangles_per_second"], 12'000.0);
}

TEST(BenchRecords, AreAnArrayEvenIfEmpty) {
    EXPECT_EQ(to_json(std::span<const Record>{}), "[]\n");
    EXPECT_EQ(to_csv({}), "");
}

TEST(BenchRecords, AreLinesOfCsvWithQuotesIfNeeded) {
    const Record first{{"name", std::string("a, \"b\"")}, {"count", std::uint64_t{7}}, {"number", 0.1}, {"none", {}}};
    const Record second{
        {"name", std::string("plain")}, {"count", std::uint64_t{8}}, {"number", 1.0 / 3.0}, {"none", 2.0}};
    EXPECT_EQ(to_csv(std::vector<Record>{first, second}),
              "name,count,number,none\r\n\"a, \"\"b\"\"\",7,0.1,\r\nplain,8,0.3333333333333333,2\r\n");
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
