#include "cli/bench_files.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "lab/bench/cases.h"
#include "lab/compare/gnuplot.h"
#include "support/temporary_folder.h"

namespace ricochet::cli {
namespace RICOCHET_FILE {

// Returns rows of two cases with one and with two threads. The second case lacks most ratios.
std::vector<bench::Row> rows() {
    std::vector<bench::Row> rows(4);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        bench::Row& row = rows[i];
        row.name = i < 2 ? "first_case" : "second";
        row.threads = static_cast<int>(1 + i % 2);
        row.particles = row.triangles = i < 2 ? 100 : 1000;
        row.particle_steps_per_second = 1e6;
        row.raw_rays_per_second = 2e6;
        row.ratio_raw = 0.5;
        row.ratio_raw_sorted = 0.25;
    }
    for (std::size_t i = 0; i < 2; ++i) {
        rows[i].ratio_native_bounces = 0.75;
        rows[i].ratio_points = rows[i].ratio_exact = 1.5;
        rows[i].speedup = rows[i].speedup_raw = static_cast<double>(1 + i);
    }
    return rows;
}

std::vector<bench::LoadRow> load_rows() {
    std::vector<bench::LoadRow> rows(2);
    rows[0] = {"ply", "PLY, binary", 1000, 1, 5000, 0.5, 0.5};
    rows[1] = {"ply", "PLY, binary", 1000, 2, 5000, 0.5, 0.25};
    return rows;
}

std::string script_of(const std::string& suite) {
    return suite == bench::kLoadSuite ? plot_script(load_rows()) : plot_script(suite, rows());
}

TEST(BenchPlots, AreDrawnForEverySuiteWithoutOutputFromGnuplot) {
    for (const std::string& suite : bench::suite_names()) {
        const test::TemporaryFolder folder;
        (void)folder.write("plot.gp", script_of(suite));
        const std::string failure =
            draw_with_gnuplot(folder.path(""), "plot.gp", {suite + ".png"}, [] { return false; });
        if (failure.find("cannot be started") != std::string::npos) GTEST_SKIP() << failure;
        EXPECT_EQ(failure, "") << suite;
        EXPECT_TRUE(std::filesystem::exists(folder.path(suite + ".png"))) << suite;
    }
}

// The imitated gnuplot writes an incomplete picture and returns success.
TEST(BenchPlots, GetNoFinalNameIfIncomplete) {
    const test::TemporaryFolder folder;
    (void)folder.write("gnuplot", "#!/bin/sh\nending=${2#*\\'}\nprintf PNG > \"plot.png${ending%\\'}\"\n");
    std::filesystem::permissions(folder.path("gnuplot"), std::filesystem::perms::owner_all);
    const std::string path = std::getenv("PATH");
    ASSERT_EQ(::setenv("PATH", (folder.path("").string() + ":" + path).c_str(), 1), 0);
    const std::string failure = draw_with_gnuplot(folder.path(""), "plot.gp", {"plot.png"}, [] { return false; });
    ASSERT_EQ(::setenv("PATH", path.c_str(), 1), 0);
    EXPECT_EQ(failure, "gnuplot has not written all pictures");
    EXPECT_FALSE(std::filesystem::exists(folder.path("plot.png")));
}

TEST(BenchPlots, TakeTheRowsWithTheMostThreads) {
    const std::string text = plot_script(load_rows());
    EXPECT_NE(text.find("\"ply\" 0.002 0.004\n"), std::string::npos) << text;
    EXPECT_EQ(text.find("\"ply\" 0.002 0.002\n"), std::string::npos) << text;
}

TEST(BenchPlots, OmitMissingValues) {
    const std::string text = plot_script("radius", rows());
    EXPECT_NE(text.find("\"first_case\" 1.5\n"), std::string::npos) << text;
    EXPECT_NE(text.find("\"second\" nan\n"), std::string::npos) << text;
}

TEST(BenchPlots, HaveACurveForEveryThreadCaseAndItsBareRays) {
    const std::string text = plot_script("threads", rows());
    for (const char* part :
         {"1 1 1\n2 2 2\n", "title 'first_case'", "title 'first_case, bare rays'", "title 'second'"}) {
        EXPECT_NE(text.find(part), std::string::npos) << part << " in\n" << text;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet::cli
