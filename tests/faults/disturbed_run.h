/// \file Disturbed runs of the tool and their checks. A run must end with a clear message and leave no half-written
/// file under a final name. After it has been resumed, it must have the bits of the undisturbed run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "support/temporary_folder.h"

namespace ricochet::test {

/// Returns the environment that makes system calls fail; see preload/call_faults.cpp.
///
/// - path: part of the paths of the affected files
/// - call: open, write, sync, rename, close, unlink, any
/// - action: an errno, "short" or "kill"
[[nodiscard]] std::vector<std::string> call_fault(const std::filesystem::path& path, const std::string& call,
                                                  std::int64_t at, const std::string& action, bool goes_on = false);

/// Returns the environment that limits the disk space to the given number of bytes.
[[nodiscard]] std::vector<std::string> full_disk(const std::filesystem::path& path, std::int64_t bytes);

/// Returns the environment that makes the given allocation of the program, counted from 1, fail; see
/// preload/memory_faults.cpp.
[[nodiscard]] std::vector<std::string> no_memory(std::int64_t at, bool goes_on = false);

/// Returns the number of allocations of the tool with these arguments.
[[nodiscard]] std::int64_t count_allocations(const std::vector<std::string>& arguments);

/// Returns the environment that makes clocks jump; see preload/clock_faults.cpp.
[[nodiscard]] std::vector<std::string> jumping_clocks(std::uint64_t seed);

/// Returns true if the kernel allows to disturb the calls of a program. Tests that need it are skipped otherwise.
[[nodiscard]] bool can_disturb_calls();

/// Numbers of calls by their names in call_fault(). The entry "bytes" is the number of bytes that the calls write.
using CallCounts = std::map<std::string, std::int64_t>;

/// Returns the calls that the tool makes with these arguments and files.
[[nodiscard]] CallCounts count_calls(const std::filesystem::path& path, const std::vector<std::string>& arguments,
                                     const ProgramStart& start = {});

/// Expects exit code 0 and nothing on standard error, or another exit code and one line.
void expect_clear_end(const ProgramResult& result);

/// Scene whose run writes every kind of file in a tenth of a second, with the results of its undisturbed run.
class DisturbedRun {
public:
    DisturbedRun();

    /// Removes the files of an earlier disturbed run.
    void clear() const;
    /// Returns the arguments of the tool for the run to disturb.
    [[nodiscard]] std::vector<std::string> arguments(bool resumed = false) const;
    /// Returns the output folder, which is also the common prefix of the paths of all output.
    [[nodiscard]] std::filesystem::path output() const { return folder_.path("out"); }
    /// Returns the folder of scene and mesh.
    [[nodiscard]] std::filesystem::path input() const { return folder_.path("in"); }
    [[nodiscard]] bool has_checkpoint() const;
    /// Expects that each file with a final name equals the file of the undisturbed run, or is a complete file of a run
    /// in progress.
    void expect_nothing_half_written() const;
    /// Expects that no temporary file is left.
    void expect_nothing_unfinished() const;
    /// Expects that all files exist with the bits of the undisturbed run.
    void expect_complete() const;
    /// Resumes the run from its checkpoint, or runs it again if none was written yet. The checkpoint must exist once it
    /// has been written. Then calls expect_complete().
    void expect_resumable() const;
    /// Makes all of the above checks after a disturbed run.
    void expect_survived(const ProgramResult& result) const;

private:
    [[nodiscard]] std::string state_hash() const;

    TemporaryFolder folder_;
    std::map<std::string, std::string> files_;  // files of the undisturbed run, except files that contain times
    std::string state_hash_;
};

}  // namespace ricochet::test
