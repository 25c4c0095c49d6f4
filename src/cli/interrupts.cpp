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
constexpr int kOpen = -1;  // no guard lives: there is nothing to lose

// The signal that was noted, 0 where one would be, or kOpen. Handlers read it on any thread.
std::atomic<int> noted = kOpen;
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use nothing else");

void handle(int signal) {
    int nothing = 0;
    if (noted.compare_exchange_strong(nothing, signal)) return;
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
    (void)std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow any more shows in write()
    struct sigaction action {};
    action.sa_handler = handle;
    // System calls go on after a signal that is only noted.
    action.sa_flags = SA_RESTART;
    // No second handler may begin on the thread that removes the files.
    for (const int signal : kSignals) (void)::sigaddset(&action.sa_mask, signal);
    for (const int signal : kSignals) {
        // A script that runs the tool in the background has SIGINT ignored for it, and means it to end by it all the
        // same.
        if (signal == SIGHUP && is_ignored(signal)) continue;
        (void)::sigaction(signal, &action, nullptr);
    }
}

InterruptGuard::InterruptGuard() { noted = 0; }

InterruptGuard::~InterruptGuard() { noted = kOpen; }

int InterruptGuard::signal() {
    const int signal = noted;
    return signal == kOpen ? 0 : signal;
}

}  // namespace ricochet::cli
