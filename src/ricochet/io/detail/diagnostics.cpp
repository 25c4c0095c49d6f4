#include "ricochet/io/detail/diagnostics.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <utility>

namespace ricochet::detail {
namespace {

constexpr std::size_t kMostLines = 100;

bool is_plain(std::string_view key) {
    return !key.empty() && std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
               c == '$';
    });
}

}  // namespace

std::string path_of_key(const std::string& parent, std::string_view key) {
    if (!is_plain(key)) return fmt::format("{}[\"{}\"]", parent, printable(key, 60));
    return parent.empty() ? std::string(key) : fmt::format("{}.{}", parent, key);
}

std::string path_of_item(const std::string& parent, std::size_t index) { return fmt::format("{}[{}]", parent, index); }

Diagnostics::Diagnostics(std::string file, std::vector<std::string> overrides)
    : file_(std::move(file)), overrides_(std::move(overrides)) {}

void Diagnostics::error(const Place& place, const std::string& path, std::string_view what) {
    errors_.push_back(entry(place, path, what));
}

void Diagnostics::warning(const Place& place, const std::string& path, std::string_view what) {
    warnings_.push_back(entry(place, path, what));
}

Diagnostics::Entry Diagnostics::entry(const Place& place, const std::string& path, std::string_view what) const {
    constexpr std::size_t kLongestLine = 2000;
    std::string line = file_;
    if (place.override_number >= 0) {
        line += ": --set " + overrides_[static_cast<std::size_t>(place.override_number)];
    } else if (place.line > 0) {
        line += fmt::format(":{}:{}", place.line, place.column);
    }
    if (!path.empty()) line += ": " + path;
    line += fmt::format(": {}", what);
    return {place, printable(line, kLongestLine)};
}

std::vector<std::string> Diagnostics::lines(std::vector<Entry> entries) {
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) {
        return std::tie(a.place.override_number, a.place.line, a.place.column) <
               std::tie(b.place.override_number, b.place.line, b.place.column);
    });
    std::vector<std::string> result;
    for (Entry& e : entries) {
        if (result.size() == kMostLines) {
            result.push_back(fmt::format("... and {} more of this file", entries.size() - kMostLines));
            break;
        }
        result.push_back(std::move(e.line));
    }
    return result;
}

}  // namespace ricochet::detail
