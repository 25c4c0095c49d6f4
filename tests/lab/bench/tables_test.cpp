#include "lab/bench/records.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace ricochet::bench {
namespace RICOCHET_FILE {

Row row_with_steps() {
    Row row;
    row.particle_steps = 1;
    return row;
}

bool has_column(const Table& table, const std::string& name) {
    return std::find(table.front().begin(), table.front().end(), name) != table.front().end();
}

TEST(BenchTables, HaveACellForEveryColumn) {
    const Row row = row_with_steps();
    LoadRow file;
    file.read_seconds = file.build_seconds = 1.0;
    const RatioChange change{"gas", "ratio_raw", 2.0, std::nullopt, false};
    for (const Table& table : {to_table(std::vector<Row>{row}), to_table(std::vector<LoadRow>{file}),
                               to_table(std::vector<RatioChange>{change})}) {
        ASSERT_EQ(table.size(), 2U);
        EXPECT_EQ(table[0].size(), table[1].size());
    }
}

TEST(BenchTables, ShowCostsAndSpeedupsOnlyIfPresent) {
    std::vector<Row> rows(2, row_with_steps());
    EXPECT_FALSE(has_column(to_table(rows), "speedup"));
    rows[1].speedup = 1.75;
    const Table table = to_table(rows);
    EXPECT_TRUE(has_column(table, "speedup"));
    EXPECT_FALSE(has_column(table, "cost/points"));
    EXPECT_EQ(table[1].back(), "-");
    EXPECT_EQ(table[2].back(), "1.75");
}

TEST(BenchTables, LabelTheLeaksOfTheNativeLoop) {
    Row row = row_with_steps();
    row.leaks = 7;
    const Table table = to_table(std::vector<Row>{row});
    EXPECT_FALSE(has_column(table, "leaks"));
    const auto column = std::find(table[0].begin(), table[0].end(), "native leaks") - table[0].begin();
    ASSERT_LT(column, std::ssize(table[0]));
    EXPECT_EQ(table[1][static_cast<std::size_t>(column)], "7");
}

TEST(BenchTables, ReportFallenRatios) {
    const Table table = to_table(std::vector<RatioChange>{{"gas", "ratio_raw", 2.0, 1.0, true}});
    EXPECT_EQ(table[1], (std::vector<std::string>{"gas", "ratio_raw", "2", "1", "-50 %", "fell"}));
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::bench
