#include "run/run_report.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/core/error.h"
#include "run/example_frames.h"
#include "support/temporary_folder.h"

namespace ricochet {

namespace RICOCHET_FILE {

nlohmann::json parsed(const RunSummary& summary) { return nlohmann::json::parse(summary_text(summary)); }

TEST(Summary, EveryKeyOfTheContractIsPresent) {
    const nlohmann::json json = parsed(RunSummary{});
    for (const char* key :
         {"version", "scene", "threads", "steps", "simulated_time", "wall_seconds", "output_seconds", "particles_alive",
          "kinetic_energy", "potential_energy", "state_hash", "state_hash_algorithm", "peak_memory_bytes", "seed",
          "time_step", "interrupted", "diverged", "colliders"}) {
        EXPECT_TRUE(json.contains(key)) << key;
    }
    EXPECT_TRUE(json["leaks"].is_null());
    EXPECT_TRUE(json["energy_violations"].is_null());
    EXPECT_TRUE(json["potential_energy"].is_null());
}

TEST(Summary, LeaksAreANumberOnceTheRunHasBeenVerified) {
    RunSummary summary;
    summary.verified = true;
    summary.statistics.energy_violations = 3;
    EXPECT_EQ(parsed(summary)["leaks"], 0);
    EXPECT_EQ(parsed(summary)["energy_violations"], 3);
    SimulationSetup setup;
    EXPECT_FALSE(summarize(Simulation(std::move(setup))).verified);
    SimulationSetup verified;
    verified.options.verify = true;
    EXPECT_TRUE(summarize(Simulation(std::move(verified))).verified);
}

TEST(Summary, SphereContactsAppearOnlyIfTheyAreEnabled) {
    RunSummary summary;
    EXPECT_FALSE(parsed(summary).contains("pair_impacts"));
    EXPECT_FALSE(parsed(summary).contains("pair_violations"));
    summary.spheres_meet = true;
    summary.statistics.pair_violations = 2;
    summary.statistics.overlap_verified = 0.25;
    summary.statistics.born_in_overlap = 4;
    EXPECT_TRUE(parsed(summary)["pair_violations"].is_null());
    EXPECT_TRUE(parsed(summary)["overlap_verified"].is_null());
    EXPECT_EQ(parsed(summary)["born_in_overlap"], 4);
    summary.verified = true;
    EXPECT_EQ(parsed(summary)["pair_violations"], 2);
    EXPECT_EQ(parsed(summary)["overlap_verified"], 0.25);
}

TEST(Summary, StatisticsKeepTheirOrder) {
    RunSummary summary;
    summary.spheres_meet = true;
    summary.statistics.squeezed = 1;
    summary.statistics.body_parts = 1;
    const auto json = nlohmann::ordered_json::parse(summary_text(summary));
    std::string keys;
    bool is_statistic = false;
    for (const auto& [key, value] : json.items()) {
        is_statistic = key != "kinetic_energy" && (is_statistic || key == "particles_emitted");
        if (is_statistic) keys += key + " ";
    }
    EXPECT_EQ(
        keys,
        "particles_emitted expired absorbed out_of_bounds shattered children births_refused_by_depth "
        "births_refused_by_population births_refused_by_overlap frozen particle_steps contacts "
        "bounces_per_step_max resting asleep unsimulated_time budget_exhausted coarse_steps started_inside "
        "started_in_overlap stayed squeezed body_parts lost_impulses springs_broken springs_lost "
        "unsolved_steps trials penetrations penetration_mean penetration_deepest pair_impacts joined_impact_energy "
        "joined_impact_loss overlap_largest born_in_overlap overlap_verified pair_violations leaks energy_violations ");
}

TEST(Summary, NumbersReadBackToTheSameBits) {
    RunSummary summary;
    summary.kinetic_energy = 1.0 / 3.0;
    summary.potential_energy = -1e-300;
    summary.statistics.particle_steps = (std::uint64_t{1} << 63) + 1;
    summary.state_hash = 0x0123456789abcdef;
    const nlohmann::json json = parsed(summary);
    EXPECT_EQ(json["kinetic_energy"].get<double>(), 1.0 / 3.0);
    EXPECT_EQ(json["potential_energy"].get<double>(), -1e-300);
    EXPECT_EQ(json["particle_steps"].get<std::uint64_t>(), (std::uint64_t{1} << 63) + 1);
    EXPECT_EQ(json["state_hash"], "0123456789abcdef");
}

TEST(Summary, NumbersThatAreNotFiniteBecomeNull) {
    RunSummary summary;
    summary.kinetic_energy = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(parsed(summary)["kinetic_energy"].is_null());
}

TEST(Summary, NamesThatAreNotUtf8DoNotLoseTheRun) {
    RunSummary summary;
    summary.scene = "caf\xe9.json";
    summary.colliders = {{"floor", "plane", "collider_00_floor.vtp", 2, 7, {0, 0, -1.5}}};
    const nlohmann::json json = parsed(summary);
    EXPECT_EQ(json["colliders"][0]["hits"], 7);
    EXPECT_EQ(json["colliders"][0]["impulse"][2], -1.5);
}

}  // namespace RICOCHET_FILE

namespace RICOCHET_FILE {

std::vector<std::vector<std::string>> rows_of(const std::string& text) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        rows.emplace_back();
        std::istringstream cells(line);
        for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
    }
    return rows;
}

TEST(StateCsv, ReadsBackToTheSameBitsInTheOrderOfTheIds) {
    const test::TemporaryFolder folder;
    const Particles particles = test::example_particles(2000);
    write_state_csv(folder.path("state.csv"), particles, 1.25);
    const auto rows = rows_of(folder.read("state.csv"));
    ASSERT_EQ(rows.size(), 2001U);
    EXPECT_EQ(rows[0][1], "x");
    for (std::size_t row = 1; row < rows.size(); ++row) {
        const std::size_t i = particles.size() - row;  // ids are in reverse order of the entries
        ASSERT_EQ(rows[row].size(), rows[0].size());
        EXPECT_EQ(std::stoull(rows[row][0]), particles.id[i]);
        EXPECT_EQ(std::strtod(rows[row][1].c_str(), nullptr), particles.position[i].x);
        EXPECT_EQ(std::strtod(rows[row][6].c_str(), nullptr), particles.velocity[i].z);
        EXPECT_EQ(std::strtod(rows[row][9].c_str(), nullptr), 1.25 - particles.birth_time[i]);
    }
}

TEST(StateCsv, MissingFolderFailsWithoutLeavingFiles) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(write_state_csv(folder.path("none") / "state.csv", Particles{}, 0.0), RunError);
}

}  // namespace RICOCHET_FILE

}  // namespace ricochet
