#include "ricochet/io/run_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace ricochet {
namespace {

constexpr std::string_view kFramePrefix = "particles_";
constexpr std::string_view kContactPrefix = "contacts_";
constexpr std::string_view kColliderPrefix = "collider_";
constexpr std::string_view kExtension = ".vtp";

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }
bool is_plain(char c) { return is_letter(c) || is_digit(c) || c == '-' || c == '_'; }

// The part of the name between prefix and extension; nothing when they do not match.
std::optional<std::string_view> stem_after(std::string_view name, std::string_view prefix) {
    if (!name.starts_with(prefix) || !name.ends_with(kExtension)) return std::nullopt;
    if (name.size() < prefix.size() + kExtension.size()) return std::nullopt;
    return name.substr(prefix.size(), name.size() - prefix.size() - kExtension.size());
}

std::optional<std::uint64_t> number(std::string_view text) {
    std::uint64_t value = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
    return value;
}

// The name without the ending ".PID-N.partial" of a file that was never finished.
std::string_view without_partial_ending(std::string_view name) {
    constexpr std::string_view kPartial = ".partial";
    if (!name.ends_with(kPartial)) return name;
    const std::string_view rest = name.substr(0, name.size() - kPartial.size());
    const std::size_t dot = rest.rfind('.');
    if (dot == std::string_view::npos) return name;
    const std::string_view digits = rest.substr(dot + 1);
    const std::size_t dash = digits.find('-');
    if (dash == std::string_view::npos) return name;
    return number(digits.substr(0, dash)) && number(digits.substr(dash + 1)) ? rest.substr(0, dot) : name;
}

bool is_comparison_file(std::string_view name) {
    constexpr std::array kFiles{kComparisonJsonFile,   kComparisonTableFile,  kComparisonScriptFile,
                                kComparisonPointsFile, kComparisonEnergyFile, kComparisonMarkdownFile,
                                kComparisonHtmlFile};
    return std::find(kFiles.begin(), kFiles.end(), name) != kFiles.end() ||
           std::find(kComparisonPictures.begin(), kComparisonPictures.end(), name) != kComparisonPictures.end();
}

std::string file_of_step(std::string_view prefix, std::uint64_t step) {
    return fmt::format("{}{:06}{}", prefix, step, kExtension);
}

std::optional<std::uint64_t> step_of_file(std::string_view prefix, std::string_view name) {
    const auto stem = stem_after(name, prefix);
    if (!stem) return std::nullopt;
    const auto step = number(*stem);
    return step && file_of_step(prefix, *step) == name ? step : std::nullopt;
}

}  // namespace

std::string frame_file_name(std::uint64_t step) { return file_of_step(kFramePrefix, step); }
std::optional<std::uint64_t> step_of_frame_file(std::string_view name) { return step_of_file(kFramePrefix, name); }
std::string contact_file_name(std::uint64_t step) { return file_of_step(kContactPrefix, step); }
std::optional<std::uint64_t> step_of_contact_file(std::string_view name) { return step_of_file(kContactPrefix, name); }

std::string collider_file_name(std::size_t index, std::string_view name) {
    std::string plain(name.substr(0, 80));
    std::replace_if(
        plain.begin(), plain.end(), [](char c) { return !is_plain(c); }, '_');
    return fmt::format("{}{:02}{}{}{}", kColliderPrefix, index, plain.empty() ? "" : "_", plain, kExtension);
}

std::optional<std::size_t> index_of_collider_file(std::string_view name) {
    const auto stem = stem_after(name, kColliderPrefix);
    if (!stem || !std::all_of(stem->begin(), stem->end(), is_plain)) return std::nullopt;
    const std::size_t end = stem->find_first_of("_");
    const auto index = number(stem->substr(0, end));
    const std::string_view rest = end == std::string_view::npos ? "" : stem->substr(end + 1);
    return index && collider_file_name(*index, rest) == name ? index : std::nullopt;
}

bool is_run_file(std::string_view name) {
    const std::string_view finished = without_partial_ending(name);
    if (is_comparison_file(finished)) return true;
    return finished == kRunInfoFile || finished == kSummaryFile || finished == kCheckpointFile ||
           finished == kParticleSeriesFile || finished == kColliderSeriesFile || finished == kContactSeriesFile ||
           step_of_frame_file(finished) || step_of_contact_file(finished) || index_of_collider_file(finished);
}

}  // namespace ricochet
