/// \file
/// Scenes that `ricochet new` writes: fitted to a mesh, with comments.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "ricochet/core/box3.h"

namespace ricochet::cli {

/// What happens in the scene.
enum class SceneTemplate { rain, debris, sparks, gas, fountain };

/// The template of this name; nothing where there is none.
[[nodiscard]] std::optional<SceneTemplate> template_named(std::string_view name);

/// What a scene is fitted to.
struct FittedMesh {
    std::string file;       ///< as the scene names it
    Box3 bounds;            ///< m, as the mesh stands in the scene; not empty
    std::string up;         ///< axis of the file that points up, "y" or "z"; empty: as its format says
    std::string format_up;  ///< and what that says
    double scale = 0.0;     ///< m a unit of the file; 0 where it is not stated: metres
    bool closed = false;    ///< its edges say that a gas can be inside
};

/// The text of a scene file: the mesh on a ground (a gas has none), emitter, camera; sizes and times from the bounds.
[[nodiscard]] std::string scene_text(SceneTemplate kind, const FittedMesh& mesh);

}  // namespace ricochet::cli
