/// \file
/// Runs the command-line tool as a user does.
#pragma once

#include <string>
#include <vector>

namespace ricochet::test {

/// What a program left behind.
struct ProgramResult {
    int exit_code = -1;  ///< -1 when it was ended by a signal
    std::string output;  ///< standard output
    std::string errors;  ///< standard error
};

/// Runs the tool that was built with the tests and waits for it.
[[nodiscard]] ProgramResult run_ricochet(const std::vector<std::string>& arguments);

}  // namespace ricochet::test
