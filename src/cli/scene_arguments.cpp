#include "cli/scene_arguments.h"

#include <fmt/format.h>

#include <cstdio>

namespace ricochet {

void add_scene_arguments(cli::Command command, SceneArguments& arguments) {
    command.add_option("scene", arguments.file, "Scene file (docs/scene-format.md)").required();
    // One value each, so that the scene file can follow it.
    command
        .add_option("--set", arguments.overrides,
                    "Change one value, for example simulation.time_step=0.01 or colliders[0].scale=2; may be repeated")
        .type_name("PATH=VALUE")
        .one_value_each();
}

SceneDescription load_scene(const SceneArguments& arguments) {
    SceneDescription scene = read_scene(arguments.file, arguments.overrides);
    for (const std::string& warning : scene.warnings) fmt::print(stderr, "ricochet: warning: {}\n", warning);
    return scene;
}

}  // namespace ricochet
