// One line on a terminal that is drawn over and over, and nothing at all in a pipe.
#pragma once

#include <chrono>
#include <mutex>
#include <string>

namespace ricochet::cli {

/// Progress on stderr. May be used from several threads.
class ProgressLine {
public:
    /// quiet: show nothing even on a terminal.
    explicit ProgressLine(bool quiet);
    /// Erases the line.
    ~ProgressLine();
    ProgressLine(const ProgressLine&) = delete;
    ProgressLine& operator=(const ProgressLine&) = delete;

    /// True when it is time to draw again (ten times a second at most).
    [[nodiscard]] bool due();
    void show(const std::string& text);
    void erase();

private:
    bool shown_ = false;
    bool enabled_;
    std::chrono::steady_clock::time_point next_;
    std::mutex mutex_;
};

/// Seconds as people say them: 4 s, 3 min 05 s, 2 h 10 min.
[[nodiscard]] std::string duration_text(double seconds);
/// A count or rate with k, M or G: 950, 12.3 k, 4.56 M.
[[nodiscard]] std::string short_number(double value);

}  // namespace ricochet::cli
