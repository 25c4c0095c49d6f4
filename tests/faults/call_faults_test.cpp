// Tests of failing system calls: a full disk at any byte, errors of every call that output needs, and errors of
// reading.
#include <gtest/gtest.h>

#include <cerrno>
#include <cstdint>
#include <string>
#include <vector>

#include "faults/disturbed_run.h"
#include "ricochet/core/random.h"
#include "support/counts.h"

namespace ricochet {
namespace RICOCHET_FILE {

using test::call_fault;
using test::CallCounts;
using test::DisturbedRun;
using test::ProgramResult;
using test::ProgramStart;
using test::run_ricochet;

class CallFaults : public testing::Test {
protected:
    void SetUp() override {
        if (!test::can_disturb_calls()) GTEST_SKIP() << "the kernel does not let the calls of a program be disturbed";
    }
};

struct Fault {
    std::string call;
    std::vector<int> errors;
};

const std::vector<Fault>& faults() {
    static const std::vector<Fault> list{{"open", {ENOSPC, EIO, EMFILE, EINTR}},
                                         {"write", {ENOSPC, EIO, EINTR}},
                                         {"sync", {EIO, ENOSPC}},
                                         {"rename", {EIO, ENOSPC}},
                                         {"close", {EIO, ENOSPC, EINTR}}};
    return list;
}

ProgramResult run_disturbed(const std::vector<std::string>& arguments, std::vector<std::string> environment) {
    ProgramStart start;
    start.environment = std::move(environment);
    return run_ricochet(arguments, start);
}

TEST_F(CallFaults, ADiskFullAtAnyByteEndsTheRunWithOneLineAndItCanBeResumed) {
    const DisturbedRun run;
    const std::int64_t bytes = test::count_calls(run.output(), run.arguments()).at("bytes");
    ASSERT_GT(bytes, 10000);
    constexpr std::uint64_t kSeed = 3;
    RandomSequence random(kSeed, 0, 0);
    const int cases = 5 * test::case_factor(10);
    for (int k = 0; k < cases; ++k) {
        const auto room = static_cast<std::int64_t>(random.uniform() * static_cast<double>(bytes));
        SCOPED_TRACE(testing::Message() << "room for " << room << " of " << bytes << " bytes, seed " << kSeed);
        run.clear();
        const ProgramResult result = run_disturbed(run.arguments(), test::full_disk(run.output(), room));
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_NE(result.errors.find("No space left on device"), std::string::npos) << result.errors;
        run.expect_survived(result);
    }
}

// A long run covers every call. A short run covers some calls of each kind.
TEST_F(CallFaults, AnyFailingCallIsToleratedOrEndsTheRunWithOneLineAndItCanBeResumed) {
    const DisturbedRun run;
    const CallCounts counts = test::count_calls(run.output(), run.arguments());
    EXPECT_GT(counts.at("rename"), 30);
    for (const Fault& fault : faults()) {
        const std::int64_t calls = counts.at(fault.call);
        const std::int64_t stride = test::is_long_run() ? 1 : std::max<std::int64_t>(1, calls);
        for (std::size_t e = 0; e < fault.errors.size(); ++e) {
            for (auto at = 1 + static_cast<std::int64_t>(e) % stride; at <= calls; at += stride) {
                const bool goes_on = at % 2 == 0;
                SCOPED_TRACE(testing::Message() << fault.call << " number " << at << (goes_on ? " and all later" : "")
                                                << " gives errno " << fault.errors[e]);
                run.clear();
                run.expect_survived(
                    run_disturbed(run.arguments(),
                                  call_fault(run.output(), fault.call, at, std::to_string(fault.errors[e]), goes_on)));
            }
        }
    }
}

TEST_F(CallFaults, PartialWritesLoseNoBytes) {
    const DisturbedRun run;
    const ProgramResult result = run_disturbed(run.arguments(), call_fault(run.output(), "write", 1, "short", true));
    EXPECT_EQ(result.exit_code, 0) << result.errors;
    run.expect_survived(result);
}

TEST_F(CallFaults, AnErrorInClosingAnUnfinishedFileEndsTheRunAndRemovesTheFile) {
    const DisturbedRun run;
    for (const std::string name : {"particles_000020.vtp", "checkpoint.bin", "summary.json", "out.csv"}) {
        SCOPED_TRACE(name);
        run.clear();
        const ProgramResult result =
            run_disturbed(run.arguments(), call_fault(name + ".", "close", name == "out.csv" ? 2 : 1, "5"));
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_NE(result.errors.find(name + ": cannot close the file"), std::string::npos) << result.errors;
        EXPECT_FALSE(std::filesystem::exists(run.output() / name));
        run.expect_survived(result);
    }
}

TEST_F(CallFaults, UnreadableInputEndsTheRunBeforeAnyOutput) {
    const DisturbedRun run;
    const std::int64_t opens = test::count_calls(run.input(), run.arguments()).at("open");
    EXPECT_GE(opens, 2);
    for (std::int64_t at = 1; at <= opens; ++at) {
        for (const int error : {EIO, EMFILE, EACCES}) {
            SCOPED_TRACE(testing::Message() << "open number " << at << " gives errno " << error);
            run.clear();
            const ProgramResult result =
                run_disturbed(run.arguments(), call_fault(run.input(), "open", at, std::to_string(error)));
            EXPECT_EQ(result.exit_code, 2);
            test::expect_clear_end(result);
            EXPECT_FALSE(std::filesystem::exists(run.output()));
        }
    }
}

// The advice "Run it without --resume" would remove a good checkpoint.
TEST_F(CallFaults, ACheckpointThatCannotBeOpenedIsReportedAsNeitherMissingNorDamaged) {
    const DisturbedRun run;
    const ProgramResult killed =
        run_disturbed(run.arguments(), call_fault("particles_000050.vtp", "rename", 1, "kill"));
    ASSERT_EQ(killed.signal, SIGKILL);
    ASSERT_TRUE(run.has_checkpoint());
    for (const int error : {EIO, EMFILE, EACCES}) {
        const ProgramResult result = run_disturbed(
            run.arguments(true), call_fault(run.output() / "checkpoint.bin", "open", 1, std::to_string(error)));
        EXPECT_EQ(result.exit_code, 1);
        test::expect_clear_end(result);
        EXPECT_NE(result.errors.find("checkpoint.bin: cannot be read"), std::string::npos) << result.errors;
        EXPECT_EQ(result.errors.find("without --resume"), std::string::npos) << result.errors;
    }
    run.expect_resumable();
}

// A run into the folder of an earlier run removes its files first.
TEST_F(CallFaults, AnUnremovableFileOfAnEarlierRunEndsTheRun) {
    const DisturbedRun run;
    ASSERT_EQ(run_ricochet(run.arguments()).exit_code, 0);
    const std::int64_t removed = test::count_calls(run.output(), run.arguments()).at("unlink");
    ASSERT_GT(removed, 20);
    for (const std::int64_t at : {std::int64_t{1}, removed / 2}) {
        SCOPED_TRACE(at);
        const ProgramResult result =
            run_disturbed(run.arguments(), call_fault(run.output(), "unlink", at, std::to_string(EIO)));
        EXPECT_EQ(result.exit_code, 1);
        test::expect_clear_end(result);
        EXPECT_NE(result.errors.find("cannot remove"), std::string::npos) << result.errors;
        run.expect_nothing_half_written();
        EXPECT_EQ(run_ricochet(run.arguments()).exit_code, 0);
        run.expect_complete();
    }
}

TEST_F(CallFaults, UnremovableFilesDoNotAffectTheRest) {
    const DisturbedRun run;
    const std::int64_t removed = test::count_calls(run.output(), run.arguments()).at("unlink");
    EXPECT_GT(removed, 0);
    for (std::int64_t at = 1; at <= removed; ++at) {
        SCOPED_TRACE(at);
        run.clear();
        const ProgramResult result =
            run_disturbed(run.arguments(), call_fault(run.output(), "unlink", at, std::to_string(EIO)));
        EXPECT_EQ(result.exit_code, 0);
        test::expect_clear_end(result);
        run.expect_nothing_half_written();
        run.expect_resumable();
    }
}

// Another command and its output.

struct Command {
    std::string what;
    std::vector<std::string> arguments;
    std::filesystem::path file;  // path of its output
    bool is_standard_output;
};

std::vector<Command> commands(const DisturbedRun& run, const test::TemporaryFolder& folder) {
    const std::string scene = (run.input() / "scene.json").string();
    const std::string mesh = (run.input() / "roof.off").string();
    const auto file = folder.path("written/result.png");
    return {{"render",
             {"render", run.output().string(), "--output", file.string(), "--size", "32x32", "--samples", "1"},
             file,
             false},
            {"info", {"info", mesh}, file, true},
            {"info --json", {"info", "--json", mesh}, file, true},
            {"check", {"check", scene}, file, true},
            {"schema", {"schema"}, file, true}};
}

void expect_clean_failures(const Command& command, const std::filesystem::path& folder) {
    ProgramStart start;
    if (command.is_standard_output) start.output = command.file.string();
    const CallCounts counts = test::count_calls(folder, command.arguments, start);
    const std::string whole = [&] {
        std::ifstream in(command.file, std::ios::binary);
        return std::string(std::istreambuf_iterator<char>(in), {});
    }();
    EXPECT_FALSE(whole.empty());
    for (const Fault& fault : faults()) {
        for (std::int64_t at = 1; at <= counts.at(fault.call); ++at) {
            for (const int error : fault.errors) {
                SCOPED_TRACE(testing::Message()
                             << command.what << ": " << fault.call << " number " << at << " gives errno " << error);
                std::filesystem::remove(command.file);
                start.environment = call_fault(folder, fault.call, at, std::to_string(error));
                const ProgramResult result = run_ricochet(command.arguments, start);
                test::expect_clear_end(result);
                if (!command.is_standard_output) {
                    EXPECT_EQ(std::filesystem::exists(command.file), result.exit_code == 0);
                }
                EXPECT_TRUE(result.exit_code == 1 || fault.call != "write");
            }
        }
    }
    start.environment = call_fault(folder, "write", 1, "short", true);
    EXPECT_EQ(run_ricochet(command.arguments, start).exit_code, 0);
    EXPECT_EQ(std::filesystem::file_size(command.file), whole.size());
}

TEST_F(CallFaults, OtherCommandsReportFailedWritesAndLeaveNoPartOfAFile) {
    const DisturbedRun run;
    ASSERT_EQ(run_ricochet(run.arguments()).exit_code, 0);
    const test::TemporaryFolder folder;
    std::filesystem::create_directories(folder.path("written"));
    for (const Command& command : commands(run, folder)) expect_clean_failures(command, folder.path("written"));
}

TEST_F(CallFaults, AComparisonReportsFailedWritesAndLeavesNoPartOfAFile) {
    const DisturbedRun run;
    const std::vector<std::string> arguments{"compare",   (run.input() / "scene.json").string(),
                                             "--output",  run.output().string(),
                                             "--repeats", "1",
                                             "--quiet",   "--time-steps",
                                             "0.02",      "--responses",
                                             "exact",     "--set",
                                             "output={}"};
    // Runs without gnuplot, because programs started by a disturbed program die.
    const std::string no_programs = "PATH=" + run.input().string();
    const CallCounts counts = test::count_calls(run.output(), arguments, {{no_programs}, {}, {}, {}});
    const std::int64_t stride = test::is_long_run() ? 1 : 3;
    for (const Fault& fault : faults()) {
        for (std::int64_t at = 1; at <= counts.at(fault.call); at += stride) {
            SCOPED_TRACE(testing::Message() << fault.call << " number " << at);
            run.clear();
            std::vector<std::string> environment =
                call_fault(run.output(), fault.call, at, std::to_string(fault.errors.front()));
            environment.push_back(no_programs);
            const ProgramResult result = run_disturbed(arguments, environment);
            test::expect_clear_end(result);
            run.expect_nothing_unfinished();
            EXPECT_EQ(std::filesystem::exists(run.output() / "report.html"), result.exit_code == 0);
        }
    }
}

TEST_F(CallFaults, ABenchmarkThatCannotOpenItsOutputEndsBeforeItMeasures) {
    const test::TemporaryFolder folder;
    const auto file = folder.path("numbers.json");
    for (const int error : {ENOSPC, EIO, EMFILE}) {
        const ProgramResult result = run_disturbed({"bench", "--repeats", "1000", "--json", file.string()},
                                                   call_fault(file, "open", 1, std::to_string(error)));
        EXPECT_EQ(result.exit_code, 1);
        test::expect_clear_end(result);
        EXPECT_FALSE(std::filesystem::exists(file));
    }
}

using CallFaultsLong = CallFaults;

TEST_F(CallFaultsLong, ABenchmarkThatCannotWriteItsNumbersLeavesNoPartOfThem) {
    const test::TemporaryFolder folder;
    const auto file = folder.path("numbers.json");
    for (const std::string call : {"write", "rename", "close"}) {
        SCOPED_TRACE(call);
        ProgramStart start;
        start.environment = call_fault(file, call, 1, std::to_string(ENOSPC));
        const ProgramResult result = run_ricochet({"bench", "--repeats", "1", "--json", file.string()}, start);
        EXPECT_EQ(result.exit_code, 1);
        EXPECT_NE(result.errors.find("numbers.json: cannot"), std::string::npos) << result.errors;
        EXPECT_TRUE(std::filesystem::is_empty(file.parent_path()));
    }
}

}  // namespace RICOCHET_FILE
}  // namespace ricochet
