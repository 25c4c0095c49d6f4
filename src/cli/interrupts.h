// Handling of SIGINT, SIGTERM and SIGHUP: the process ends at once, or it ends after it has saved its work.
#pragma once

namespace ricochet::cli {

/// Offset of exit codes after signals: signal N gives the exit code kSignalled + N.
inline constexpr int kSignalled = 128;

/// Installs handlers that end the process at once with the exit code kSignalled + signal. The handlers first remove
/// temporary files and kill programs that write such files. If SIGHUP is ignored, as under nohup, it stays ignored.
/// Must be called once, before any thread starts.
void end_at_interrupts();

/// Protection for work that must not be lost. The first signal during the guard's lifetime is only recorded. A second
/// signal, of any kind, ends the process at once. Only one guard can exist at a time.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    /// Returns the signal that arrived during the guard's lifetime, or 0.
    [[nodiscard]] static int signal();
};

}  // namespace ricochet::cli
