// What the tool says to a terminal.
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

/// Of the processes that share a run one talks: the others are silent until they have an error to tell.
void be_silent(bool silent);
[[nodiscard]] bool is_silent();

/// Who an error is of, where not everybody has it: `rank 3 on node17`; empty, as at first, for one process alone.
void speak_as(std::string name);
[[nodiscard]] const std::string& speaker();

/// What print() shows of an argument.
template <class T>
using Printed = std::conditional_t<std::is_convertible_v<const T&, std::string_view>, std::string, std::decay_t<T>>;

template <class T>
[[nodiscard]] Printed<T> printed(const T& value) {
    if constexpr (std::is_convertible_v<const T&, std::string_view>)
        return printable(value);
    else
        return value;
}

/// Prints as fmt::print() does, with all texts among the arguments as printable() makes them: they may be a stranger's.
/// What the file does not take is lost; std::ferror() tells. Nothing while be_silent() holds.
template <class... Args>
void print(std::FILE* file, fmt::format_string<Printed<Args>...> format, const Args&... args) {
    if (is_silent()) return;
    (void)std::fputs(fmt::format(format, printed(args)...).c_str(), file);
}
template <class... Args>
void print(fmt::format_string<Printed<Args>...> format, const Args&... args) {
    cli::print(stdout, format, args...);
}

/// Opens what the caller has closed of standard input, output and error, so that no file of ours takes their numbers:
/// a message would be written into it. Reading and writing them fails as before.
void reserve_standard_streams();

// Tables on standard output.

/// A header and rows of as many cells each: the first column to the left, numbers to the right.
void print_table(std::vector<std::vector<std::string>> table);

// One line on a terminal that is drawn over and over; in a pipe nothing, or a line every ten seconds.

/// When progress is shown.
enum class Progress {
    automatic,  ///< on a terminal
    always,     ///< in a pipe too: a line at once, then one every ten seconds
    never,
};

/// `auto`, `always` or `never`. Throws InputError.
[[nodiscard]] Progress parse_progress(const std::string& text);

/// Progress on stderr. May be used from several threads.
class ProgressLine {
public:
    /// quiet: show nothing even on a terminal, unless it is to be shown always.
    explicit ProgressLine(bool quiet, Progress progress = Progress::automatic);
    /// Erases the line.
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// True when it is time to draw again: ten times a second at most, every ten seconds in a pipe.
    [[nodiscard]] bool due();
    void show(const std::string& text);
    void erase();
    /// Erases the line that is shown, if any. Safe in a signal handler, before the process ends.
    static void erase_at_the_end() noexcept;

private:
    bool shown_ = false;
    bool is_terminal_;
    bool enabled_;
    std::chrono::steady_clock::time_point next_;
    std::mutex mutex_;
};

/// Seconds as people say them: 4 s, 3 min 05 s, 2 h 10 min.
[[nodiscard]] std::string duration_text(double seconds);
/// A count or rate with k, M or G: 950, 12.3 k, 4.56 M.
[[nodiscard]] std::string short_number(double value);

/// Most violations that are listed.
inline constexpr std::size_t kMostListedViolations = 20;

/// One line for every violation, up to kMostListedViolations, with particle, position, time, collider and triangle; and
/// one with the number of those that are not listed. violations: the first of the `count` that there are.
[[nodiscard]] std::vector<std::string> violation_lines(std::span<const Violation> violations, std::uint64_t count,
                                                       const std::vector<ColliderDescription>& colliders);

}  // namespace ricochet::cli
