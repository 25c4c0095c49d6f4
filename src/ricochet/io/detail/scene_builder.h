/// \file
/// From a checked document to a scene.
#pragma once

#include <filesystem>

#include "ricochet/io/detail/diagnostics.h"
#include "ricochet/io/detail/json_node.h"
#include "ricochet/io/scene.h"

namespace ricochet::detail {

/// Builds the scene from a document that check_scene() has seen, and reports what only shows here: names that refer to
/// nothing, files, values that contradict each other. folder: where relative paths begin.
[[nodiscard]] SceneDescription build_scene(const JsonNode& root, const std::filesystem::path& folder,
                                           Diagnostics& diagnostics);

}  // namespace ricochet::detail
