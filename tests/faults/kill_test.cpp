// Tests of runs killed at any moment. No file is half-written under a final name, and the resumed run has the same
// bits.
#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdint>
#include <string>
#include <thread>

#include "faults/disturbed_run.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::DisturbedRun;
using test::ProgramResult;
using test::ProgramStart;

// RICOCHET_FAULT_SEED selects other moments.
std::uint64_t seed() {
    const char* text = std::getenv("RICOCHET_FAULT_SEED");  // NOLINT(concurrency-mt-unsafe): no code sets it
    return text == nullptr ? 1 : std::strtoull(text, nullptr, 10);
}

// Kills the run at random calls, again after each resume, until it completes.
TEST(Kill, ARunKilledBeforeAnyWritingCallResumesToTheSameBits) {
    if (!test::can_disturb_calls()) GTEST_SKIP() << "the kernel does not let the calls of a program be disturbed";
    const DisturbedRun run;
    std::int64_t calls = 0;
    for (const auto& [name, count] : test::count_calls(run.output(), run.arguments())) {
        if (name != "bytes") calls += count;
    }
    RandomSequence random(seed(), 0, 0);
    const int cases = 5 * test::case_factor(10);
    for (int k = 0; k < cases; ++k) {
        run.clear();
        for (int kills = 0; kills < 3; ++kills) {
            const auto at = 1 + static_cast<std::int64_t>(random.uniform() * static_cast<double>(calls));
            SCOPED_TRACE(testing::Message() << "seed " << seed() << ", case " << k << ": killed before call " << at);
            ProgramStart start;
            start.environment = test::call_fault(run.output(), "any", at, "kill");
            const ProgramResult result = test::run_ricochet(run.arguments(run.has_checkpoint()), start);
            EXPECT_TRUE(result.signal == SIGKILL || result.exit_code == 0) << result.errors;
            run.expect_nothing_half_written();
            if (result.exit_code == 0) break;
        }
        SCOPED_TRACE(testing::Message() << "seed " << seed() << ", case " << k);
        run.expect_resumable();
    }
}

// Kills the run at random times, which need not fall into a call. The checks do not depend on the exact moment.
TEST(Kill, ARunKilledAtAnyMomentResumesToTheSameBits) {
    const DisturbedRun run;
    const auto start = std::chrono::steady_clock::now();
    ASSERT_EQ(test::run_ricochet(run.arguments()).exit_code, 0);
    const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - start;
    RandomSequence random(seed(), 1, 0);
    const int cases = 5 * test::case_factor(10);
    for (int k = 0; k < cases; ++k) {
        SCOPED_TRACE(testing::Message() << "seed " << seed() << ", case " << k);
        run.clear();
        test::RunningProgram program(run.arguments());
        std::this_thread::sleep_for(random.uniform() * whole);
        program.send(SIGKILL);
        const ProgramResult result = program.wait();
        EXPECT_TRUE(result.signal == SIGKILL || result.exit_code == 0) << result.errors;
        run.expect_nothing_half_written();
        run.expect_resumable();
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
