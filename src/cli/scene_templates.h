/// \file
/// Texts of the scenes that `ricochet new` writes. The scenes are fitted to a mesh and have comments.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ricochet/core/box3.h"

namespace ricochet::cli {

/// Kind of scene.
enum class SceneTemplate { rain, debris, sparks, gas, fountain };

/// Returns the template with this name, or nothing.
[[nodiscard]] std::optional<SceneTemplate> template_named(std::string_view name);

/// The mesh that a scene is fitted to.
struct FittedMesh {
    std::string file;       ///< path as written in the scene
    Box3 bounds;            ///< bounding box in the scene, in m; not empty
    std::string up;         ///< axis of the file that points up, "y" or "z"; empty: same as format_up
    std::string format_up;  ///< axis that points up by default in the file's format
    double scale = 0.0;     ///< length of the file's unit, in m; 0: not stated, metres assumed
    bool closed = false;    ///< true if the mesh encloses a volume that a gas can fill
};

/// Returns the text of a scene file with the mesh, a ground (except for a gas), emitter and camera. Sizes and times
/// come from the bounds.
[[nodiscard]] std::string scene_text(SceneTemplate kind, const FittedMesh& mesh);

}  // namespace ricochet::cli
