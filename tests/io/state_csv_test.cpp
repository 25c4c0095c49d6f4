#include "ricochet/io/run_report.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "geometry/temporary_folder.h"
#include "io/example_frames.h"
#include "ricochet/core/error.h"

namespace ricochet {
namespace {

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
        const std::size_t i = particles.size() - row;  // ids run against the order of the entries
        ASSERT_EQ(rows[row].size(), rows[0].size());
        EXPECT_EQ(std::stoull(rows[row][0]), particles.id[i]);
        EXPECT_EQ(std::strtod(rows[row][1].c_str(), nullptr), particles.position[i].x);
        EXPECT_EQ(std::strtod(rows[row][6].c_str(), nullptr), particles.velocity[i].z);
        EXPECT_EQ(std::strtod(rows[row][9].c_str(), nullptr), 1.25 - particles.birth_time[i]);
    }
}

TEST(StateCsv, FailsWithoutLeavingAnythingWhenTheFolderIsMissing) {
    const test::TemporaryFolder folder;
    EXPECT_THROW(write_state_csv(folder.path("none") / "state.csv", Particles{}, 0.0), RunError);
}

}  // namespace
}  // namespace ricochet
