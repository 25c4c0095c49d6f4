#include "cli/running_program.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

extern char** environ;  // NOLINT(readability-redundant-declaration): POSIX leaves the declaration to the program

namespace ricochet::test {
namespace {

void pause_a_little() { (void)::usleep(2000); }

sigset_t lease_signal() {
    sigset_t signals;
    (void)::sigemptyset(&signals);
    (void)::sigaddset(&signals, SIGIO);
    return signals;
}

}  // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& arguments) {
    std::vector<std::string> words = {RICOCHET_PROGRAM};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const int error = ::posix_spawn(&process_, RICOCHET_PROGRAM, &actions, nullptr, pointers.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw std::runtime_error("the program cannot be started");
}

RunningProgram::~RunningProgram() {
    if (process_ < 0) return;
    send(SIGKILL);
    (void)exit_code();
}

void RunningProgram::send(int signal) const { (void)::kill(process_, signal); }

bool RunningProgram::has_ended() const {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 || info.si_pid != 0;
}

bool RunningProgram::takes_signals() const {
    while (!has_ended()) {
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

bool RunningProgram::works(double seconds) const {
    const double begin = processor_seconds();
    while (!has_ended()) {
        if (processor_seconds() >= begin + seconds) return true;
        pause_a_little();
    }
    return false;
}

bool RunningProgram::makes(const std::filesystem::path& file) const {
    while (!std::filesystem::exists(file)) {
        if (has_ended()) return std::filesystem::exists(file);
        pause_a_little();
    }
    return true;
}

int RunningProgram::exit_code() {
    int status = 0;
    if (::waitpid(process_, &status, 0) != process_) return -1;
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

HeldFile::HeldFile(const std::filesystem::path& file) : descriptor_(::open(file.c_str(), O_RDWR | O_CLOEXEC)) {
    // The signal that somebody waits is waited for.
    const sigset_t signals = lease_signal();
    (void)::pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    is_held_ = ::fcntl(descriptor_, F_SETLEASE, F_WRLCK) == 0;
}

HeldFile::~HeldFile() {
    (void)::fcntl(descriptor_, F_SETLEASE, F_UNLCK);
    (void)::close(descriptor_);
}

void HeldFile::wait_for_reader() const {
    const sigset_t signals = lease_signal();
    int signal = 0;
    (void)::sigwait(&signals, &signal);
}

}  // namespace ricochet::test
