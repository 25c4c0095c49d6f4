// Ctrl-C and kill: the first one asks the work to end properly, the second one ends the process at once.
#pragma once

namespace ricochet::cli {

/// Catches the first SIGINT or SIGTERM while it lives. One at a time.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    /// The signal that came in; 0 when none did.
    [[nodiscard]] static int signal();
};

}  // namespace ricochet::cli
