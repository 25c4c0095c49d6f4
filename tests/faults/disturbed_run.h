/// \file
/// A run of the tool that something is done to, and what must hold of it afterwards: a clear end, nothing half-written
/// under a final name, and the bits of the undisturbed run once it has been resumed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet::test {

/// The environment in which system calls go wrong; see preload/call_faults.cpp. path: part of the paths of the files
/// whose calls count. call: open, write, sync, rename, close, unlink, any. action: an errno, "short" or "kill".
[[nodiscard]] std::vector<std::string> call_fault(const std::filesystem::path& path, const std::string& call,
                                                  std::int64_t at, const std::string& action, bool goes_on = false);

/// The environment in which the disk has room for so many bytes.
[[nodiscard]] std::vector<std::string> full_disk(const std::filesystem::path& path, std::int64_t bytes);

/// The environment in which the program's allocation of this number, from 1, fails; see preload/memory_faults.cpp.
[[nodiscard]] std::vector<std::string> no_memory(std::int64_t at, bool goes_on = false);

/// Allocations of the tool with these arguments.
[[nodiscard]] std::int64_t count_allocations(const std::vector<std::string>& arguments);

/// The environment in which clocks jump; see preload/clock_faults.cpp.
[[nodiscard]] std::vector<std::string> jumping_clocks(std::uint64_t seed);

/// Whether the kernel lets the calls of a program go wrong. Tests that need it are skipped where not.
[[nodiscard]] bool can_disturb_calls();

/// Numbers of calls, by their names in call_fault(); and "bytes", which the writes of them write.
using CallCounts = std::map<std::string, std::int64_t>;

/// The calls that the tool makes with these arguments and files.
[[nodiscard]] CallCounts count_calls(const std::filesystem::path& path, const std::vector<std::string>& arguments,
                                     const ProgramStart& start = {});

/// Exit code 0 and nothing on standard error, or another one and one line.
void expect_clear_end(const ProgramResult& result);

/// A scene whose run writes every kind of file in a tenth of a second, and its undisturbed run.
class DisturbedRun {
public:
    DisturbedRun();

    /// Takes away what an earlier disturbed run has left.
    void clear() const;
    /// Of the tool, for the run that is to be disturbed.
    [[nodiscard]] std::vector<std::string> arguments(bool resumed = false) const;
    /// The output folder, and the common beginning of the paths of all output.
    [[nodiscard]] std::filesystem::path output() const { return folder_.path("out"); }
    /// Of scene and mesh.
    [[nodiscard]] std::filesystem::path input() const { return folder_.path("in"); }
    [[nodiscard]] bool has_checkpoint() const;
    /// What is there under a final name is what the undisturbed run wrote, or a whole file of a run in progress.
    void expect_nothing_half_written() const;
    /// No temporary file is left.
    void expect_nothing_unfinished() const;
    /// Everything is there, with the bits of the undisturbed run.
    void expect_complete() const;
    /// Resumes the run from its checkpoint, which must be there once it has been written, or runs it again;
    /// expect_complete().
    void expect_resumable() const;
    /// What must hold after a run that something went wrong in: all of the above.
    void expect_survived(const ProgramResult& result) const;

private:
    [[nodiscard]] std::string state_hash() const;

    TemporaryFolder folder_;
    std::map<std::string, std::string> files_;  // of the undisturbed run, without those that tell times
    std::string state_hash_;
};

}  // namespace ricochet::test
