// Tests of memory that runs out at any allocation of the program. The program ends with one line and an exit code, and
// no file is half-written under a final name. The run can be resumed to the same bits.
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "faults/disturbed_run.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::DisturbedRun;
using test::ProgramResult;
using test::ProgramStart;

/// Returns the distance between tested allocations. A long run tests about a thousand of them, a short run about
/// fifteen.
std::int64_t stride(std::int64_t allocations) { return allocations / (test::is_long_run() ? 1000 : 15) + 1; }

ProgramResult run_without_memory(const std::vector<std::string>& arguments, std::int64_t at, bool goes_on) {
    ProgramStart start;
    start.environment = test::no_memory(at, goes_on);
    return test::run_ricochet(arguments, start);
}

/// Returns true if the run was about to write run.json or summary.json. The JSON library (3.11) dereferences a null
/// pointer when it discards a document for which memory ran out. Ricochet cannot prevent that.
bool was_making_json(const DisturbedRun& run) {
    const auto has = [&](const char* name) { return std::filesystem::exists(run.output() / name); };
    return !has("run.json") || (has("particles_000100.vtp") && !has("summary.json"));
}

void expect_told(const ProgramResult& result) {
    test::expect_clear_end(result);
    if (result.exit_code == 0) return;
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("memory"), std::string::npos) << result.errors;
}

TEST(MemoryFaults, AtAnyAllocationOfARunAreReportedAndItCanBeResumed) {
    const DisturbedRun run;
    const std::int64_t allocations = test::count_allocations(run.arguments());
    ASSERT_GT(allocations, 1000);
    int told = 0;
    for (std::int64_t at = 1; at <= allocations; at += stride(allocations)) {
        const bool goes_on = at % 2 == 0;
        SCOPED_TRACE(testing::Message() << "allocation " << at << (goes_on ? " and all later" : "") << " of "
                                        << allocations);
        run.clear();
        const ProgramResult result = run_without_memory(run.arguments(), at, goes_on);
        if (result.signal == 0 || !was_making_json(run)) expect_told(result);
        if (result.exit_code != 0) ++told;
        run.expect_nothing_half_written();
        run.expect_resumable();
    }
    EXPECT_GT(told, 0);
}

TEST(MemoryFaults, AtAnyAllocationOfAPictureAreReportedAndLeaveAWholePictureOrNone) {
    const DisturbedRun run;
    ASSERT_EQ(test::run_ricochet(run.arguments()).exit_code, 0);
    const test::TemporaryFolder folder;
    const auto picture = folder.path("picture.png");
    const std::vector<std::string> arguments{"render", run.output().string(), "--output", picture.string(), "--size",
                                             "32x32",  "--samples",           "1",        "--quiet"};
    const std::int64_t allocations = test::count_allocations(arguments);
    const std::string whole = folder.read("picture.png");
    for (std::int64_t at = 1; at <= allocations; at += stride(allocations)) {
        const bool goes_on = at % 2 == 0;
        SCOPED_TRACE(testing::Message() << "allocation " << at << (goes_on ? " and all later" : "") << " of "
                                        << allocations);
        std::filesystem::remove(picture);
        const ProgramResult result = run_without_memory(arguments, at, goes_on);
        expect_told(result);
        EXPECT_EQ(std::filesystem::exists(picture), result.exit_code == 0);
        EXPECT_TRUE(folder.read("picture.png") == (result.exit_code == 0 ? whole : ""));
    }
}

TEST(MemoryFaults, AtAnyAllocationOfOtherCommandsAreReported) {
    const DisturbedRun run;
    const std::vector<std::vector<std::string>> commands{
        {"info", (run.input() / "roof.off").string()}, {"check", (run.input() / "scene.json").string()}, {"--version"}};
    for (const std::vector<std::string>& arguments : commands) {
        const std::string whole = test::run_ricochet(arguments).output;
        const std::int64_t allocations = test::count_allocations(arguments);
        for (std::int64_t at = 1; at <= allocations; at += stride(allocations)) {
            const bool goes_on = at % 2 == 0;
            SCOPED_TRACE(testing::Message() << arguments.front() << ", allocation " << at
                                            << (goes_on ? " and all later" : "") << " of " << allocations);
            const ProgramResult result = run_without_memory(arguments, at, goes_on);
            expect_told(result);
            EXPECT_TRUE(result.exit_code != 0 || result.output == whole);
        }
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
