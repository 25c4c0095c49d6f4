#include "cli/run_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <string_view>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves the declaration to the program

namespace ricochet::test {
namespace {

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

// The test's own environment with the settings in place of those of the same name.
std::vector<std::string> environment_with(const std::vector<std::string>& settings) {
    const auto name = [](std::string_view setting) { return setting.substr(0, setting.find('=') + 1); };
    std::vector<std::string> all = settings;
    for (char** entry = environ; *entry != nullptr; ++entry) {
        const bool is_replaced = std::any_of(settings.begin(), settings.end(),
                                             [&](const std::string& setting) { return name(setting) == name(*entry); });
        if (!is_replaced) all.emplace_back(*entry);
    }
    return all;
}

}  // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& arguments, const ProgramStart& start) {
    std::vector<std::string> command = start.prefix;
    command.emplace_back(RICOCHET_PROGRAM);
    command.insert(command.end(), arguments.begin(), arguments.end());
    std::vector<std::string> environment = environment_with(start.environment);
    const std::string output = start.output.empty() ? folder_.path("out").string() : start.output;
    const std::string errors = start.errors.empty() ? folder_.path("err").string() : start.errors;
    constexpr int kFlags = O_WRONLY | O_CREAT | O_TRUNC;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, output.c_str(), kFlags, 0644);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, errors.c_str(), kFlags, 0644);
    const int error = ::posix_spawnp(&process_, command.front().c_str(), &actions, nullptr, pointers_to(command).data(),
                                     pointers_to(environment).data());
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("cannot start " + command.front());
}

RunningProgram::~RunningProgram() {
    if (has_ended_) return;
    send(SIGKILL);
    (void)wait();
}

void RunningProgram::send(int signal) const {
    if (!has_ended_) (void)::kill(process_, signal);
}

bool RunningProgram::is_running() {
    if (!has_ended_) has_ended_ = ::waitpid(process_, &status_, WNOHANG) == process_;
    return !has_ended_;
}

ProgramResult RunningProgram::wait() {
    while (!has_ended_) {
        has_ended_ = ::waitpid(process_, &status_, 0) == process_;
        if (!has_ended_ && errno != EINTR) throw std::runtime_error("cannot wait for the program");
    }
    return {WIFEXITED(status_) ? WEXITSTATUS(status_) : -1, WIFSIGNALED(status_) ? WTERMSIG(status_) : 0,
            folder_.read("out"), folder_.read("err")};
}

ProgramResult run_ricochet(const std::vector<std::string>& arguments, const ProgramStart& start) {
    return RunningProgram(arguments, start).wait();
}

}  // namespace ricochet::test
