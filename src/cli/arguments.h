// Arguments that several commands share, and parsers for option values.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "ricochet/io/scene.h"

namespace ricochet::cli {

/// Converts the whole text to a number. Returns nothing if the text is not one finite number.
[[nodiscard]] std::optional<double> parse_number(const std::string& text);

/// Returns the numbers of a comma-separated list. Throws InputError with the option's name if an element of the list is
/// not a finite number.
[[nodiscard]] std::vector<double> parse_number_list(const std::string& option, const std::string& text);

struct PictureSize {
    int width = 0;
    int height = 0;
};
/// Parses WIDTHxHEIGHT, each 1..16384. Throws InputError.
[[nodiscard]] PictureSize parse_picture_size(const std::string& text);

/// Parses a number of worker threads, 1..1024. Returns 0, which means all processors, for an empty text. Throws
/// InputError.
[[nodiscard]] int parse_thread_count(const std::string& text);

/// Parses comma-separated numbers of worker threads, 1..1024 each. Returns {0}, which means all processors, for an
/// empty text. Throws InputError.
[[nodiscard]] std::vector<int> parse_thread_counts(const std::string& text);

/// Parses the allowed relative decrease of a ratio, 0 <= x < 1. Throws InputError.
[[nodiscard]] double parse_tolerance(const std::string& text);

/// Parses the number of timed repetitions, 1..1000. Throws InputError.
[[nodiscard]] std::uint32_t parse_repeats(const std::string& text);

// Arguments of every command that takes a scene.

struct SceneArguments {
    std::string file;
    std::vector<std::string> overrides;  ///< PATH=VALUE
};

/// Adds the scene file and `--set PATH=VALUE`. The arguments must outlive the parser.
void add_scene_arguments(cli::Command command, SceneArguments& arguments);

/// Reads the scene and prints its warnings on standard error. Throws SceneError.
[[nodiscard]] SceneDescription load_scene(const SceneArguments& arguments);

}  // namespace ricochet::cli
