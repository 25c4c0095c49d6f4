/// \file
/// The command-line tool while it runs, to be sent signals.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace ricochet::test {

/// The tool, started with its output thrown away. Killed when it goes and has not ended.
class RunningProgram {
public:
    explicit RunningProgram(const std::vector<std::string>& arguments);
    ~RunningProgram();
    RunningProgram(const RunningProgram&) = delete;
    RunningProgram& operator=(const RunningProgram&) = delete;

    void send(int signal) const;
    /// Waits until it has taken all signals that were sent. False when it has ended.
    [[nodiscard]] bool takes_signals() const;
    /// Waits until it has worked for so many seconds of processor time more. False when it has ended.
    [[nodiscard]] bool works(double seconds) const;
    /// Waits for a file. False when the program has ended without it.
    [[nodiscard]] bool makes(const std::filesystem::path& file) const;
    /// Waits for its end. Its exit code; -1 when a signal has killed it.
    [[nodiscard]] int exit_code();

private:
    [[nodiscard]] bool has_ended() const;
    [[nodiscard]] double processor_seconds() const;

    pid_t process_ = -1;
};

/// A file that nobody else can open while it lives: who tries waits (a lease, fcntl(2), which the kernel takes away
/// after 45 seconds).
class HeldFile {
public:
    explicit HeldFile(const std::filesystem::path& file);
    ~HeldFile();
    HeldFile(const HeldFile&) = delete;
    HeldFile& operator=(const HeldFile&) = delete;

    /// False where the file system has no leases.
    [[nodiscard]] bool is_held() const { return is_held_; }
    /// Waits until somebody waits for the file.
    void wait_for_reader() const;

private:
    int descriptor_ = -1;
    bool is_held_ = false;
};

}  // namespace ricochet::test
