// Handling of SIGINT, SIGTERM and SIGHUP: immediate end of the process, or orderly end of the work.
#pragma once

namespace ricochet::cli {

/// Exit code of a process ended by a signal, minus the signal's number.
inline constexpr int kSignalled = 128;

/// Installs handlers that end the process at once with the exit code kSignalled + signal. They remove temporary files
/// and kill programs that write such files. An ignored SIGHUP stays ignored, as under nohup. Must be called once,
/// before any thread starts.
void end_at_interrupts();

/// Protection for work that must not be lost. The first signal during its lifetime is only recorded. The second one,
/// of any kind, ends the process at once. Only one guard can exist at a time.
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
