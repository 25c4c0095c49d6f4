/// \file
/// What of a scene decides how a run goes on.
#pragma once

#include <cstdint>

#include "ricochet/io/detail/json_node.h"

namespace ricochet::detail {

/// A hash of the scene's values, without places and comments, and without what only says what is written and how it is
/// looked at ("output", "camera", "title", "description"). Keys count in the order of the file.
[[nodiscard]] std::uint64_t scene_fingerprint(const JsonNode& root);

}  // namespace ricochet::detail
