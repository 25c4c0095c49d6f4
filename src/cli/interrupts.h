// Ctrl-C, kill and a terminal that goes away (SIGINT, SIGTERM, SIGHUP): when they end the process at once, and when
// they ask the work to end properly.
#pragma once

namespace ricochet::cli {

/// Exit code of what a signal has ended, less the signal's number.
inline constexpr int kSignalled = 128;

/// From now on these signals end the process at once with the exit code kSignalled + signal, whatever it is busy with;
/// temporary files are removed and programs that write such are killed. SIGHUP stays ignored where it is, as under
/// nohup. To be called once, before there are threads.
void end_at_interrupts();

/// For work that has something to lose: the first of these signals, which comes in while it lives, is only noted; the
/// second one, of whatever kind, ends the process at once. One at a time.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    /// The signal that came in while the guard lived; 0 when none did.
    [[nodiscard]] static int signal();
};

}  // namespace ricochet::cli
