#include "ricochet/io/scene/diagnostics.h"
#include "ricochet/core/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

namespace ricochet::detail {

namespace {

constexpr std::size_t kMostErrors = 10;
constexpr std::size_t kMostLines = 100;  // limit for warnings, and for notes

bool is_plain(std::string_view key) {
    return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
               c == '$';
    });
}

constexpr std::size_t kLongestWord = 100;

// Returns the number of tolerated edits: one for words of up to four letters, and one more for every four further
// letters.
std::size_t tolerated_edits(std::size_t length) { return length == 0 ? 0 : 1 + (length - 1) / 4; }

std::string without_style(std::string_view word) {
    std::string plain;
    for (const char c : word) {
        if (c == '_' || c == '-' || c == ' ') continue;
        plain += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return plain;
}

}  // namespace

std::string path_of_key(const std::string& parent, std::string_view key) {
    if (!is_plain(key)) return fmt::format("{}[\"{}\"]", parent, printable(key, 60));
    return parent.empty() ? std::string(key) : fmt::format("{}.{}", parent, key);
}

std::string path_of_item(const std::string& parent, std::size_t index) { return fmt::format("{}[{}]", parent, index); }

Diagnostics::Diagnostics(std::string file, std::vector<std::string> overrides)
    : file_(std::move(file)), overrides_(std::move(overrides)) {}

void Diagnostics::error(const SourceLocation& location, const std::string& path, std::string_view what) {
    errors_.push_back(entry(location, path, what));
}

void Diagnostics::warning(const SourceLocation& location, const std::string& path, std::string_view what) {
    warnings_.push_back(entry(location, path, what));
}

void Diagnostics::note(const SourceLocation& location, const std::string& path, std::string_view what) {
    notes_.push_back(entry(location, path, what));
}

Diagnostics::Entry Diagnostics::entry(const SourceLocation& location, const std::string& path,
                                      std::string_view what) const {
    constexpr std::size_t kLongestLine = 2000;
    std::string line = file_;
    if (location.override_index >= 0) {
        line += ": --set " + overrides_[static_cast<std::size_t>(location.override_index)];
    } else if (location.line > 0) {
        line += fmt::format(":{}:{}", location.line, location.column);
    }
    if (!path.empty()) line += ": " + path;
    line += fmt::format(": {}", what);
    return {location, printable(line, kLongestLine)};
}

std::vector<std::string> Diagnostics::errors() const { return lines(errors_, kMostErrors); }
std::vector<std::string> Diagnostics::warnings() const { return lines(warnings_, kMostLines); }
std::vector<std::string> Diagnostics::notes() const { return lines(notes_, kMostLines); }

std::vector<std::string> Diagnostics::lines(std::vector<Entry> entries, std::size_t most) {
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.location.override_index, a.location.line, a.location.column) <
               std::tie(b.location.override_index, b.location.line, b.location.column);
    });
    std::vector<std::string> result;
    for (Entry& e : entries) {
        if (result.size() == most) {
            result.push_back(fmt::format("... and {} more of this file", entries.size() - most));
            break;
        }
        result.push_back(std::move(e.line));
    }
    return result;
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
    // The vectors are rows i - 2, i - 1 and i of the table of distances between prefixes.
    std::vector<std::size_t> before(b.size() + 1);
    std::vector<std::size_t> above(b.size() + 1);
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) above[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({above[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
                row[j] = std::min(row[j], before[j - 2] + 1);
        }
        std::swap(before, above);
        std::swap(above, row);
    }
    return above[b.size()];
}

std::vector<std::string_view> nearest_names(std::string_view word, const std::vector<std::string_view>& candidates) {
    std::vector<std::string_view> nearest;
    if (word.size() > kLongestWord) return nearest;
    const std::string plain = without_style(word);
    std::size_t best = std::numeric_limits<std::size_t>::max();
    for (const std::string_view candidate : candidates) {
        const std::string plain_candidate = without_style(candidate);
        // The edit distance is at least the difference of the lengths.
        const auto [shorter, longer] = std::minmax({plain.size(), plain_candidate.size()});
        if (longer - shorter > tolerated_edits(plain_candidate.size())) continue;
        const std::size_t distance = edit_distance(plain, plain_candidate);
        if (distance > tolerated_edits(plain_candidate.size()) || distance > best) continue;
        if (distance < best) nearest.clear();
        best = distance;
        nearest.push_back(candidate);
    }
    return nearest;
}

std::string did_you_mean(const std::vector<std::string_view>& names) {
    if (names.empty()) return "";
    std::string text = "did you mean ";
    for (std::size_t i = 0; i < names.size(); ++i) text += fmt::format("{}\"{}\"", i == 0 ? "" : " or ", names[i]);
    return text + "?";
}

std::string quoted_list(const std::vector<std::string_view>& names) {
    std::string text;
    for (const std::string_view name : names) text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", name);
    return text;
}

}  // namespace ricochet::detail
