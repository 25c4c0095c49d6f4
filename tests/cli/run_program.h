/// \file
/// Runs the command-line tool as a user does.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace ricochet::test {

/// What a program left behind.
struct ProgramResult {
    int exit_code = -1;  ///< -1 when it was ended by a signal
    int signal = 0;      ///< the one that ended it; 0 when none did
    std::string output;  ///< standard output
    std::string errors;  ///< standard error
};

/// How the tool is started, beside its arguments.
struct ProgramStart {
    std::vector<std::string> environment;  ///< NAME=VALUE, more than the test's own
    std::vector<std::string> prefix;       ///< a program, with arguments, that starts the tool
    std::string output;                    ///< a file for standard output instead of ProgramResult::output
    std::string errors;                    ///< the same for standard error
};

/// The tool that was built with the tests, while it runs.
class RunningProgram {
public:
    explicit RunningProgram(const std::vector<std::string>& arguments, const ProgramStart& start = {});
    /// Kills it where it was not waited for.
    ~RunningProgram();
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    void send(int signal) const;
    /// Whether it still runs.
    [[nodiscard]] bool is_running();
    /// Waits until it has taken all signals that were sent. False when it has ended.
    [[nodiscard]] bool takes_signals();
    /// Waits until it has worked for so many seconds of processor time more. False when it has ended.
    [[nodiscard]] bool works(double seconds);
    /// Waits for a file. False when the program has ended without it.
    [[nodiscard]] bool makes(const std::filesystem::path& file);
    /// To be called once.
    [[nodiscard]] ProgramResult wait();

private:
    [[nodiscard]] double processor_seconds() const;

    TemporaryFolder folder_;
    pid_t process_ = -1;
    bool has_ended_ = false;
    int status_ = 0;
};

/// Runs the tool and waits for it.
[[nodiscard]] ProgramResult run_ricochet(const std::vector<std::string>& arguments, const ProgramStart& start = {});

}  // namespace ricochet::test
