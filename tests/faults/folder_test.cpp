// Tests of shared, removed and forbidden folders, and of closed or full standard streams.
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

#include "faults/disturbed_run.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::DisturbedRun;
using test::ProgramResult;
using test::ProgramStart;
using test::run_ricochet;
using test::RunningProgram;

bool begins(const std::string& text, const std::string& start) { return text.rfind(start, 0) == 0; }

// Returns arguments for a run that takes hours.
std::vector<std::string> endless(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--set", "simulation.duration=1e5"});
    return arguments;
}

void wait_for_frames(RunningProgram& program, const std::filesystem::path& folder) {
    while (program.is_running() && !std::filesystem::exists(folder / "particles_000010.vtp")) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ASSERT_TRUE(program.is_running());
}

TEST(SharedFolder, BelongsToTheFirstOfTwoRunsAndTheSecondChangesNothing) {
    const DisturbedRun run;
    RunningProgram first(endless(run.arguments()));
    wait_for_frames(first, run.output());
    const std::string scene = (run.input() / "scene.json").string();
    const std::vector<std::vector<std::string>> others{
        run.arguments(), run.arguments(true), {"compare", scene, "--output", run.output().string()}};
    for (const std::vector<std::string>& other : others) {
        const ProgramResult result = run_ricochet(other);
        EXPECT_EQ(result.exit_code, 1);
        test::expect_clear_end(result);
        EXPECT_NE(result.errors.find("another run is writing into this folder"), std::string::npos) << result.errors;
        EXPECT_TRUE(std::filesystem::exists(run.output() / "particles_000010.vtp"));
    }
    EXPECT_TRUE(first.is_running());
    first.send(SIGTERM);
    EXPECT_EQ(first.wait().exit_code, 128 + SIGTERM);
    EXPECT_EQ(run_ricochet(run.arguments()).exit_code, 0);
    run.expect_complete();
}

TEST(SharedFolder, IsCompleteAfterTwoRunsStartTogether) {
    const DisturbedRun run;
    for (int k = 0; k < 5 * test::case_factor(20); ++k) {
        SCOPED_TRACE(k);
        run.clear();
        RunningProgram a(run.arguments());
        RunningProgram b(run.arguments());
        const ProgramResult results[] = {a.wait(), b.wait()};
        EXPECT_TRUE(results[0].exit_code == 0 || results[1].exit_code == 0);
        for (const ProgramResult& result : results) {
            test::expect_clear_end(result);
            if (result.exit_code == 0) continue;
            EXPECT_EQ(result.exit_code, 1);
            EXPECT_NE(result.errors.find("another run is writing"), std::string::npos) << result.errors;
        }
        run.expect_complete();
    }
}

TEST(VanishedFolder, EndsTheRunWithOneLineAndIsNotRecreated) {
    const DisturbedRun run;
    RunningProgram program(endless(run.arguments()));
    wait_for_frames(program, run.output());
    std::error_code error;
    do {  // the run may add files meanwhile
        std::filesystem::remove_all(run.output(), error);
    } while (std::filesystem::exists(run.output()));
    const ProgramResult result = program.wait();
    EXPECT_EQ(result.exit_code, 1);
    test::expect_clear_end(result);
    EXPECT_NE(result.errors.find("No such file or directory"), std::string::npos) << result.errors;
    EXPECT_FALSE(std::filesystem::exists(run.output()));
    EXPECT_EQ(run_ricochet(run.arguments()).exit_code, 0);
    run.expect_complete();
}

// The program runs as a user without rights, because the tests may run as root, for whom nothing is forbidden.
class ForbiddenFolder : public testing::Test {
protected:
    void SetUp() override {
        if (::geteuid() == 0) start_.prefix = {"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups"};
        bool works = false;
        try {
            works = run_ricochet({"--version"}, start_).exit_code == 0;
        } catch (const std::exception&) {  // setpriv is missing
        }
        if (!works) GTEST_SKIP() << "the tool cannot be run as a user without rights";
    }

    static void allow(const std::filesystem::path& path, bool writing) {
        using std::filesystem::perms;
        constexpr perms kReading = perms::owner_read | perms::group_read | perms::others_read | perms::owner_exec |
                                   perms::group_exec | perms::others_exec;
        constexpr perms kWriting = perms::owner_write | perms::group_write | perms::others_write;
        std::filesystem::permissions(path, writing ? kReading | kWriting : kReading);
    }

    ProgramStart start_;
};

TEST_F(ForbiddenFolder, ReadOnlyInputIsEnough) {
    const DisturbedRun run;
    for (const auto& entry : std::filesystem::directory_iterator(run.input())) allow(entry.path(), false);
    allow(run.input(), false);
    allow(run.output().parent_path(), true);
    const ProgramResult result = run_ricochet(run.arguments(), start_);
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    run.expect_complete();
    allow(run.input(), true);
}

TEST_F(ForbiddenFolder, ForbiddenOutputEndsTheRunWithOneLine) {
    const DisturbedRun run;
    allow(run.output().parent_path(), false);  // the folder cannot be created
    const ProgramResult made = run_ricochet(run.arguments(), start_);
    EXPECT_EQ(made.exit_code, 1);
    test::expect_clear_end(made);
    EXPECT_NE(made.errors.find("cannot create the output folder (Permission denied)"), std::string::npos)
        << made.errors;
    allow(run.output().parent_path(), true);
    std::filesystem::create_directory(run.output());
    allow(run.output(), false);  // the folder exists but cannot be written to
    const ProgramResult used = run_ricochet(run.arguments(), start_);
    EXPECT_EQ(used.exit_code, 1);
    test::expect_clear_end(used);
    EXPECT_NE(used.errors.find("Permission denied"), std::string::npos) << used.errors;
    EXPECT_TRUE(std::filesystem::is_empty(run.output()));
    allow(run.output(), true);
}

TEST_F(ForbiddenFolder, UnreadableInputIsRefusedInOneLine) {
    const DisturbedRun run;
    allow(run.output().parent_path(), true);
    std::filesystem::permissions(run.input() / "roof.off", std::filesystem::perms::none);
    const ProgramResult result = run_ricochet(run.arguments(), start_);
    EXPECT_EQ(result.exit_code, 2);
    test::expect_clear_end(result);
    EXPECT_NE(result.errors.find("roof.off"), std::string::npos) << result.errors;
    EXPECT_NE(result.errors.find("Permission denied"), std::string::npos) << result.errors;
}

// Starts the tool through a shell that redirects standard streams.

ProgramStart through_shell(const std::string& redirections) {
    ProgramStart start;
    start.prefix = {"/bin/sh", "-c", "exec \"$0\" \"$@\" " + redirections};
    return start;
}

TEST(StandardError, DoesNotChangeTheExitCodeWhenFull) {
    for (const std::string redirection : {"2>/dev/full", "2>&-"}) {
        SCOPED_TRACE(redirection);
        const ProgramResult refused = run_ricochet({"check", "no such scene"}, through_shell(redirection));
        EXPECT_EQ(refused.signal, 0);
        EXPECT_EQ(refused.exit_code, 2);
    }
}

TEST(StandardError, DoesNotAffectTheFilesOfARunWhenClosed) {
    const DisturbedRun run;
    EXPECT_EQ(run_ricochet(run.arguments(), through_shell("<&- >&- 2>&-")).exit_code, 0);
    run.expect_complete();
}

// The first file to be opened would get the descriptor of standard error, and messages would be written into it.
TEST(StandardError, DoesNotBecomeAFileOfTheRunWhenClosed) {
    const DisturbedRun run;
    RunningProgram program(endless(run.arguments()), through_shell("2>&-"));
    wait_for_frames(program, run.output());
    const std::filesystem::path elsewhere = run.output().parent_path() / "elsewhere";
    std::filesystem::rename(run.output(), elsewhere);
    EXPECT_EQ(program.wait().exit_code, 1);
    std::filesystem::rename(elsewhere, run.output());
    run.expect_nothing_half_written();
    EXPECT_EQ(run_ricochet(run.arguments()).exit_code, 0);
    run.expect_complete();
}

TEST(StandardOutput, IsAnErrorWhenFull) {
    const DisturbedRun run;
    const std::string mesh = (run.input() / "roof.off").string();
    for (const std::string redirection : {">/dev/full", ">&-"}) {
        SCOPED_TRACE(redirection);
        const ProgramResult result = run_ricochet({"info", mesh}, through_shell(redirection));
        EXPECT_EQ(result.exit_code, 1);
        test::expect_clear_end(result);
        EXPECT_TRUE(begins(result.errors, "ricochet: standard output cannot be written")) << result.errors;
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
