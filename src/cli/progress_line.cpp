#include "cli/progress_line.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>

namespace ricochet::cli {

ProgressLine::ProgressLine(bool quiet)
    : enabled_(!quiet && ::isatty(STDERR_FILENO) == 1), next_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() { erase(); }

bool ProgressLine::due() {
    if (!enabled_) return false;
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return false;
    next_ = now + std::chrono::milliseconds(100);
    return true;
}

void ProgressLine::show(const std::string& text) {
    if (!enabled_) return;
    const std::lock_guard lock(mutex_);
    fmt::print(stderr, "\r{}\033[K", text);
    (void)std::fflush(stderr);
    shown_ = true;
}

void ProgressLine::erase() {
    const std::lock_guard lock(mutex_);
    if (!shown_) return;
    fmt::print(stderr, "\r\033[K");
    (void)std::fflush(stderr);
    shown_ = false;
}

std::string duration_text(double seconds) {
    if (!std::isfinite(seconds) || seconds > 1e8) return "long";
    const auto whole = static_cast<long>(std::lround(std::max(0.0, seconds)));
    if (whole < 60) return fmt::format("{} s", whole);
    if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
    return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string short_number(double value) {
    if (value >= 1e9) return fmt::format("{:.3g} G", value / 1e9);
    if (value >= 1e6) return fmt::format("{:.3g} M", value / 1e6);
    if (value >= 1e3) return fmt::format("{:.3g} k", value / 1e3);
    return fmt::format("{:.0f}", value);
}

}  // namespace ricochet::cli
