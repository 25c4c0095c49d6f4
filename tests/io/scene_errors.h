/// \file
/// Errors of a scene's text.
#pragma once

#include <string>
#include <vector>

#include "ricochet/io/scene.h"

namespace ricochet::test {

using Lines = std::vector<std::string>;

/// Returns the errors of a scene, as path and sentence; empty for a valid one.
[[nodiscard]] inline Lines errors_of(const std::string& scene) {
    try {
        (void)parse_scene(scene, "s.json");
    } catch (const SceneError& error) {
        Lines lines = error.messages();
        for (std::string& line : lines) line.erase(0, line.find(' ') + 1);
        return lines;
    }
    return {};
}

}  // namespace ricochet::test
