// Arguments that several commands share, and values of options that are more than one number.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "ricochet/io/scene.h"

namespace ricochet::cli {

/// The number that the text is, where it is nothing else and finite.
[[nodiscard]] std::optional<double> parse_number(const std::string& text);

/// The numbers of a comma-separated list. Throws InputError, naming the option, when one is no finite number.
[[nodiscard]] std::vector<double> parse_number_list(const std::string& option, const std::string& text);

struct PictureSize {
    int width = 0;
    int height = 0;
};
/// WIDTHxHEIGHT, each 1..16384. Throws InputError.
[[nodiscard]] PictureSize parse_picture_size(const std::string& text);

/// A number of worker threads, 1..1024; 0 (all) for an empty text. Throws InputError.
[[nodiscard]] int parse_thread_count(const std::string& text);

/// Numbers of worker threads with commas between them, 1..1024 each; {0} (all) for an empty text. Throws InputError.
[[nodiscard]] std::vector<int> parse_thread_counts(const std::string& text);

/// A part of something that may be lost, 0 <= x < 1. Throws InputError.
[[nodiscard]] double parse_tolerance(const std::string& text);

/// How often something is timed, 1..1000. Throws InputError.
[[nodiscard]] std::uint32_t parse_repeats(const std::string& text);

// The arguments of every command that takes a scene.

struct SceneArguments {
    std::string file;
    std::vector<std::string> overrides;  ///< PATH=VALUE
};

/// Adds the scene file and `--set PATH=VALUE`. The arguments must outlive the parser.
void add_scene_arguments(cli::Command command, SceneArguments& arguments);

/// Reads the scene and prints its warnings on standard error. Throws SceneError.
[[nodiscard]] SceneDescription load_scene(const SceneArguments& arguments);

}  // namespace ricochet::cli
