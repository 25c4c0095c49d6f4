// Terminal output of the tool.
#pragma once

#include <fmt/format.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "ricochet/collision/collider.h"
#include "ricochet/core/printable.h"
#include "ricochet/verify/verifier.h"

namespace ricochet::cli {

// Text on a terminal.

/// Silences this process. Only one of the processes that share a run prints. The others are silent unless they have an
/// error to report.
void be_silent(bool silent);
[[nodiscard]] bool is_silent();

/// Sets the name of this process in error messages, such as `rank 3 on node17`. The name is empty by default, for runs
/// with a single process.
void speak_as(std::string name);
[[nodiscard]] const std::string& speaker();

/// Type to which print() converts an argument before it formats it.
template <class T>
using Printed = std::conditional_t<std::is_convertible_v<const T&, std::string_view>, std::string, std::decay_t<T>>;

template <class T>
[[nodiscard]] Printed<T> printed(const T& value) {
    if constexpr (std::is_convertible_v<const T&, std::string_view>)
        return printable(value);
    else
        return value;
}

/// Prints like fmt::print(). All texts among the arguments pass through printable(), because they can come from
/// untrusted files. If writing to the file fails, the output is lost and std::ferror() reports the failure. Prints
/// nothing while be_silent()
/// is active.
template <class... Args>
void print(std::FILE* file, fmt::format_string<Printed<Args>...> format, const Args&... args) {
    if (is_silent()) return;
    (void)std::fputs(fmt::format(format, printed(args)...).c_str(), file);
}
template <class... Args>
void print(fmt::format_string<Printed<Args>...> format, const Args&... args) {
    cli::print(stdout, format, args...);
}

/// Opens closed standard streams on /dev/null. Otherwise a file could get the number of a standard stream, and messages
/// would be written into this file. Reading from and writing to these streams still fails.
void reserve_standard_streams();

// Tables on standard output.

/// Prints a header and rows with the same number of cells. The first column is left-aligned, numbers are
/// right-aligned.
void print_table(std::vector<std::vector<std::string>> table);

// A line on a terminal that is redrawn continuously. In a pipe, nothing is shown, or a line every ten seconds.

/// Condition for showing progress.
enum class Progress {
    automatic,  ///< only on a terminal
    always,     ///< also in a pipe: a line at once, then every ten seconds
    never,
};

/// Parses `auto`, `always` or `never`. Throws InputError.
[[nodiscard]] Progress parse_progress(const std::string& text);

/// Progress on stderr. Safe to use from several threads.
class ProgressLine {
public:
    /// With `quiet`, nothing is shown, even on a terminal, unless `progress` is `always`.
    explicit ProgressLine(bool quiet, Progress progress = Progress::automatic);
    /// Erases the line.
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// Returns true if it is time to redraw: at most ten times per second, or every ten seconds in a pipe.
    [[nodiscard]] bool due();
    void show(const std::string& text);
    void erase();
    /// Erases the shown line, if any. A signal handler may call this function before it ends the process.
    static void erase_at_the_end() noexcept;

private:
    bool shown_ = false;
    bool is_terminal_;
    bool enabled_;
    std::chrono::steady_clock::time_point next_;
    std::mutex mutex_;
};

/// Formats a duration: 4 s, 3 min 05 s, 2 h 10 min.
[[nodiscard]] std::string duration_text(double seconds);
/// Formats a count or rate with k, M or G: 950, 12.3 k, 4.56 M.
[[nodiscard]] std::string short_number(double value);

/// Largest number of listed violations.
inline constexpr std::size_t kMostListedViolations = 20;

/// Returns one line per violation with particle, position, time, collider and triangle, up to kMostListedViolations. A
/// last line has the number of unlisted violations. `violations` contains the first of the `count` violations.
[[nodiscard]] std::vector<std::string> violation_lines(std::span<const Violation> violations, std::uint64_t count,
                                                       const std::vector<ColliderDescription>& colliders);

}  // namespace ricochet::cli
