/// \file Runs the command-line tool like a user.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace ricochet::test {

/// Results of a program.
struct ProgramResult {
    int exit_code = -1;  ///< -1 if a signal ended it
    int signal = 0;      ///< signal that ended it, or 0
    std::string output;  ///< standard output
    std::string errors;  ///< standard error
};

/// Environment and redirections of the tool, in addition to its arguments.
struct ProgramStart {
    std::vector<std::string> environment;  ///< NAME=VALUE, in addition to the test's own
    std::vector<std::string> prefix;       ///< program with arguments that starts the tool
    std::string output;                    ///< file for standard output instead of ProgramResult::output
    std::string errors;                    ///< file for standard error instead of ProgramResult::errors
};

/// Running process of the tool that was built with the tests.
class RunningProgram {
public:
    explicit RunningProgram(const std::vector<std::string>& arguments, const ProgramStart& start = {});
    /// Kills the process if wait() was not called.
    ~RunningProgram();
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    void send(int signal) const;
    /// Returns true if the process still runs.
    [[nodiscard]] bool is_running();
    /// Waits until the process has received all sent signals. Returns false if it has ended.
    [[nodiscard]] bool takes_signals();
    /// Waits until the process has used the given further processor time, in s. Returns false if it has ended.
    [[nodiscard]] bool works(double seconds);
    /// Waits until a file exists. Returns false if the program has ended without it.
    [[nodiscard]] bool makes(const std::filesystem::path& file);
    /// Waits for the end of the process. Must be called once.
    [[nodiscard]] ProgramResult wait();

private:
    [[nodiscard]] double processor_seconds() const;

    TemporaryFolder folder_;
    pid_t process_ = -1;
    bool has_ended_ = false;
    int status_ = 0;
};

/// Runs the tool and waits for its end.
[[nodiscard]] ProgramResult run_ricochet(const std::vector<std::string>& arguments, const ProgramStart& start = {});

}  // namespace ricochet::test
