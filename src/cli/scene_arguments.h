/// \file
/// The arguments of every command that takes a scene.
#pragma once

#include <string>
#include <vector>

#include "cli/command_line.h"
#include "ricochet/io/scene.h"

namespace ricochet {

struct SceneArguments {
    std::string file;
    std::vector<std::string> overrides;  ///< PATH=VALUE
};

/// Adds the scene file and `--set PATH=VALUE`. The arguments must outlive the parser.
void add_scene_arguments(cli::Command command, SceneArguments& arguments);

/// Reads the scene and prints its warnings on standard error. Throws SceneError.
[[nodiscard]] SceneDescription load_scene(const SceneArguments& arguments);

}  // namespace ricochet
