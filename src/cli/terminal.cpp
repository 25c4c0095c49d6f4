#include "cli/terminal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "ricochet/core/error.h"

namespace ricochet::cli {
namespace {

bool silent = false;
std::string speaker_name;

}  // namespace

void be_silent(bool is_to_be) { silent = is_to_be; }
bool is_silent() { return silent; }

void speak_as(std::string name) { speaker_name = std::move(name); }
const std::string& speaker() { return speaker_name; }

void reserve_standard_streams() {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
        if (::fcntl(stream, F_GETFD) >= 0) continue;
        (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);  // open() takes the lowest free
                                                                                  // number, which is `stream`
    }
}

void print_table(std::vector<std::vector<std::string>> table) {
    if (is_silent()) return;
    for (auto& row : table) {
        for (std::string& cell : row) cell = printable(cell);
    }
    std::vector<std::size_t> widths(table.front().size(), 0);
    for (const auto& row : table) {
        for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], row[k].size());
    }
    for (const auto& row : table) {
        std::string line = fmt::format("  {:<{}}", row.front(), widths.front());
        for (std::size_t k = 1; k < row.size(); ++k) line += fmt::format("  {:>{}}", row[k], widths[k]);
        fmt::print("{}\n", line);
    }
}

namespace {

constexpr std::string_view kErase = "\r\033[K";
constexpr std::chrono::seconds kPipeInterval{10};

std::atomic<bool> is_line_shown = false;  // true while any ProgressLine shows text on the terminal

}  // namespace

Progress parse_progress(const std::string& text) {
    if (text == "auto") return Progress::automatic;
    if (text == "always") return Progress::always;
    if (text == "never") return Progress::never;
    throw InputError(fmt::format("--progress: found \"{}\", expected auto, always or never", text));
}

ProgressLine::ProgressLine(bool quiet, Progress progress)
    : is_terminal_(::isatty(STDERR_FILENO) == 1),
      enabled_(progress == Progress::always || (progress == Progress::automatic && !quiet && is_terminal_)),
      next_(std::chrono::steady_clock::now()) {}

ProgressLine::~ProgressLine() { erase(); }

bool ProgressLine::due() {
    if (!enabled_) return false;
    const std::lock_guard lock(mutex_);
    const auto now = std::chrono::steady_clock::now();
    if (now < next_) return false;
    next_ = now + (is_terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(kPipeInterval));
    return true;
}

void ProgressLine::show(const std::string& text) {
    if (!enabled_) return;
    const std::lock_guard lock(mutex_);
    if (!is_terminal_) {
        (void)std::fputs(fmt::format("{}\n", printable(text)).c_str(), stderr);
        (void)std::fflush(stderr);
        return;
    }
    (void)std::fputs(fmt::format("\r{}\033[K", printable(text)).c_str(), stderr);
    (void)std::fflush(stderr);
    shown_ = true;
    is_line_shown = true;
}

void ProgressLine::erase() {
    const std::lock_guard lock(mutex_);
    if (!shown_) return;
    (void)std::fputs(kErase.data(), stderr);
    (void)std::fflush(stderr);
    shown_ = false;
    is_line_shown = false;
}

void ProgressLine::erase_at_the_end() noexcept {
    if (is_line_shown) (void)!::write(STDERR_FILENO, kErase.data(), kErase.size());
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

namespace {

const char* text_of(ViolationKind kind) {
    switch (kind) {
        case ViolationKind::crossing:
            return "a segment crosses";
        case ViolationKind::gap:
            return "its segments do not join";
        case ViolationKind::wrong_side:
            return "is on a different side than at birth of";
        case ViolationKind::overlap:
            return "overlaps";
        case ViolationKind::energy:
            return "has gained energy from surfaces";
        case ViolationKind::pair_overlap:
            return "overlaps another sphere";
        case ViolationKind::pair_impact:
            return "its impact on another sphere is inconsistent";
        case ViolationKind::rebound:
            return "an impact has another rebound than the surfaces that it has hit";
    }
    return "";
}

const char* head_of(ViolationKind kind) {
    if (kind == ViolationKind::pair_overlap || kind == ViolationKind::pair_impact) return "spheres";
    return kind == ViolationKind::energy || kind == ViolationKind::rebound ? "energy" : "leak";
}

std::string line_of(const Violation& violation, const std::vector<ColliderDescription>& colliders) {
    std::string line = fmt::format("{}: particle {} at ({:.17g}, {:.17g}, {:.17g}) m, time {:.17g} s: {}",
                                   head_of(violation.kind), violation.particle, violation.position.x,
                                   violation.position.y, violation.position.z, violation.time, text_of(violation.kind));
    if (violation.collider) line += fmt::format(" collider \"{}\"", colliders[*violation.collider].name);
    if (violation.triangle) line += fmt::format(", triangle {}", *violation.triangle);
    return line;
}

}  // namespace

std::vector<std::string> violation_lines(std::span<const Violation> violations, std::uint64_t count,
                                         const std::vector<ColliderDescription>& colliders) {
    std::vector<std::string> lines;
    for (const Violation& violation : violations.first(std::min(violations.size(), kMostListedViolations))) {
        lines.push_back(line_of(violation, colliders));
    }
    if (count > lines.size()) lines.push_back(fmt::format("violations: and {} more", count - lines.size()));
    return lines;
}

}  // namespace ricochet::cli
