#include "cli/interrupt.h"

#include <csignal>

namespace ricochet::cli {
namespace {

volatile std::sig_atomic_t received = 0;

void remember(int signal) { received = signal; }

void catch_once(int signal) {
    struct sigaction action {};
    action.sa_handler = remember;
    // The default comes back with the first one, so that the second ends the process; system calls go on.
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
    (void)::sigaction(signal, &action, nullptr);
}

}  // namespace

InterruptGuard::InterruptGuard() {
    received = 0;
    catch_once(SIGINT);
    catch_once(SIGTERM);
}

InterruptGuard::~InterruptGuard() {
    (void)std::signal(SIGINT, SIG_DFL);
    (void)std::signal(SIGTERM, SIG_DFL);
}

int InterruptGuard::signal() { return received; }

}  // namespace ricochet::cli
