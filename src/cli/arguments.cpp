#include "cli/arguments.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include "cli/terminal.h"
#include "ricochet/core/error.h"

namespace ricochet::cli {

namespace {

template <typename Number>
std::optional<Number> parse_all(std::string_view text) {
    Number value{};
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || stop != text.data() + text.size()) return std::nullopt;
    return value;
}

}  // namespace

std::optional<double> parse_number(const std::string& text) {
    const auto value = parse_all<double>(text);
    return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<double> parse_number_list(const std::string& option, const std::string& text) {
    std::vector<double> numbers;
    std::string_view rest = text;
    while (true) {
        const std::size_t comma = rest.find(',');
        const auto value = parse_all<double>(rest.substr(0, comma));
        if (!value || !std::isfinite(*value)) {
            throw InputError(fmt::format("{} {}: expected numbers with commas between them", option, text));
        }
        numbers.push_back(*value);
        if (comma == std::string_view::npos) return numbers;
        rest.remove_prefix(comma + 1);
    }
}

PictureSize parse_picture_size(const std::string& text) {
    constexpr int kLargest = 16384;
    const std::size_t cross = text.find('x');
    if (cross != std::string::npos) {
        const auto width = parse_all<int>(std::string_view(text).substr(0, cross));
        const auto height = parse_all<int>(std::string_view(text).substr(cross + 1));
        if (width && height && *width >= 1 && *height >= 1 && *width <= kLargest && *height <= kLargest) {
            return {*width, *height};
        }
    }
    throw InputError(fmt::format("--size {}: expected WIDTHxHEIGHT, each from 1 to {}", text, kLargest));
}

int parse_thread_count(const std::string& text) {
    constexpr int kMost = 1024;
    if (text.empty()) return 0;
    const auto threads = parse_all<int>(text);
    if (threads && *threads >= 1 && *threads <= kMost) return *threads;
    throw InputError(fmt::format("--threads {}: expected a whole number from 1 to {}; leave it out for all processors",
                                 text, kMost));
}

std::vector<int> parse_thread_counts(const std::string& text) {
    constexpr int kMost = 1024;
    if (text.empty()) return {0};
    std::vector<int> counts;
    std::string_view rest = text;
    while (true) {
        const std::size_t comma = rest.find(',');
        const auto threads = parse_all<int>(rest.substr(0, comma));
        if (!threads || *threads < 1 || *threads > kMost) {
            throw InputError(
                fmt::format("--threads {}: expected whole numbers from 1 to {} with commas between them; "
                            "leave it out for all processors",
                            text, kMost));
        }
        counts.push_back(*threads);
        if (comma == std::string_view::npos) return counts;
        rest.remove_prefix(comma + 1);
    }
}

double parse_tolerance(const std::string& text) {
    const auto tolerance = parse_all<double>(text);
    if (tolerance && *tolerance >= 0.0 && *tolerance < 1.0) return *tolerance;
    throw InputError(fmt::format("--tolerance {}: expected a number from 0 to below 1, a part of the ratio", text));
}

std::uint32_t parse_repeats(const std::string& text) {
    constexpr std::uint32_t kMost = 1000;
    const auto repeats = parse_all<std::uint32_t>(text);
    if (repeats && *repeats >= 1 && *repeats <= kMost) return *repeats;
    throw InputError(fmt::format("--repeats {}: expected a whole number from 1 to {}", text, kMost));
}

void add_scene_arguments(cli::Command command, SceneArguments& arguments) {
    command.add_option("scene", arguments.file, "Scene file (docs/scene-format.md)").required();
    // Each occurrence takes one value, so that the scene file can follow it.
    command
        .add_option("--set", arguments.overrides,
                    "Change one value, for example simulation.time_step=0.01 or colliders[0].scale=2; may be repeated")
        .type_name("PATH=VALUE")
        .one_value_each();
}

SceneDescription load_scene(const SceneArguments& arguments) {
    SceneDescription scene = read_scene(arguments.file, arguments.overrides);
    for (const std::string& warning : scene.warnings) cli::print(stderr, "ricochet: warning: {}\n", warning);
    return scene;
}

}  // namespace ricochet::cli
