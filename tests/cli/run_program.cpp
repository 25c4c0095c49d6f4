#include "cli/run_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves the declaration to the program

namespace ricochet::test {
namespace {

void pause_a_little() { (void)::usleep(2000); }

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> pointers;
    for (std::string& text : texts) pointers.push_back(text.data());
    pointers.push_back(nullptr);
    return pointers;
}

// Returns the test's own environment, with the given settings replacing settings of the same name.
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

bool RunningProgram::takes_signals() {
    while (is_running()) {
        std::ifstream status("/proc/" + std::to_string(process_) + "/status");
        std::string pending;
        for (std::string line; std::getline(status, line);) {
            if (line.starts_with("ShdPnd:")) pending = line;
        }
        if (!pending.empty() && pending.find_first_not_of("ShdPn: \t0") == std::string::npos) return true;
        pause_a_little();
    }
    return false;
}

double RunningProgram::processor_seconds() const {
    std::ifstream file("/proc/" + std::to_string(process_) + "/stat");
    std::string stat;
    std::getline(file, stat);
    const std::size_t name_end = stat.rfind(')');
    if (name_end == std::string::npos) return 0.0;
    std::istringstream fields(stat.substr(name_end + 1));
    std::string field;
    for (int k = 3; k <= 13; ++k) fields >> field;
    double ticks = 0.0;  // field 14, user time
    fields >> ticks;
    return ticks / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

bool RunningProgram::works(double seconds) {
    const double begin = processor_seconds();
    while (is_running()) {
        if (processor_seconds() >= begin + seconds) return true;
        pause_a_little();
    }
    return false;
}

bool RunningProgram::makes(const std::filesystem::path& file) {
    while (!std::filesystem::exists(file)) {
        if (!is_running()) return std::filesystem::exists(file);
        pause_a_little();
    }
    return true;
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
