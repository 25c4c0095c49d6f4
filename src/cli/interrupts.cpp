#include "cli/interrupts.h"

#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>

#include "cli/terminal.h"
#include "ricochet/core/unfinished_file.h"

namespace ricochet::cli {
namespace {

constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
constexpr int kOpen = -1;  // no guard exists, so a signal may end the process at once

// The recorded signal, 0 while a guard exists and no signal has arrived, or kOpen. Handlers on any thread access this
// variable.
std::atomic<int> recorded_signal = kOpen;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use nothing else");

void handle(int signal) {
    int nothing = 0;
    if (recorded_signal.compare_exchange_strong(nothing, signal)) return;
    ProgressLine::erase_at_the_end();
    remove_unfinished_files();
    ::_exit(kSignalled + signal);
}

bool is_ignored(int signal) {
    struct sigaction now {};
    return ::sigaction(signal, nullptr, &now) == 0 && now.sa_handler == SIG_IGN;
}

}  // namespace

void end_at_interrupts() {
    (void)std::signal(SIGXFSZ, SIG_IGN);  // if a file reaches the size limit, write() then returns an error
    struct sigaction action {};
    action.sa_handler = handle;
    // System calls continue after a signal that was only recorded.
    action.sa_flags = SA_RESTART;
    // All handled signals are blocked during the handler, so that no second handler interrupts the removal of files.
    for (const int signal : kSignals) (void)::sigaddset(&action.sa_mask, signal);
    for (const int signal : kSignals) {
        // A shell script starts background processes with SIGINT ignored. The handler is installed anyway, because such
        // scripts use SIGINT to end their background processes.
        if (signal == SIGHUP && is_ignored(signal)) continue;
        (void)::sigaction(signal, &action, nullptr);
    }
}

InterruptGuard::InterruptGuard() { recorded_signal = 0; }

InterruptGuard::~InterruptGuard() { recorded_signal = kOpen; }

int InterruptGuard::signal() {
    const int signal = recorded_signal;
    return signal == kOpen ? 0 : signal;
}

}  // namespace ricochet::cli
