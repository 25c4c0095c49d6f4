#include "cli/run_program.h"

#include <sys/wait.h>

#include <cstdlib>

#include "support/temporary_folder.h"

namespace ricochet::test {
namespace {

// For a POSIX shell: only the quote itself is special inside single quotes.
std::string shell_quoted(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) {
        if (c == '\'') {
            quoted += "'\\''";
        } else {
            quoted += c;
        }
    }
    quoted += '\'';
    return quoted;
}

}  // namespace

ProgramResult run_ricochet(const std::vector<std::string>& arguments) {
    const TemporaryFolder folder;
    std::string command = shell_quoted(RICOCHET_PROGRAM);
    for (const std::string& argument : arguments) command.append(" ").append(shell_quoted(argument));
    command.append(" >").append(shell_quoted(folder.path("out").string()));
    command.append(" 2>").append(shell_quoted(folder.path("err").string()));
    const int status = std::system(command.c_str());  // NOLINT(cert-env33-c): the command is ours
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, folder.read("out"), folder.read("err")};
}

}  // namespace ricochet::test
