/// \file
/// Checks a document against the table of keys.
#pragma once

#include "ricochet/io/detail/diagnostics.h"
#include "ricochet/io/detail/json_node.h"
#include "ricochet/io/detail/scene_keys.h"

namespace ricochet::detail {

/// Reports everything in the document that the table does not allow: unknown keys (with the nearest known ones), wrong
/// types, values out of range, missing keys, and what is not built yet. Afterwards every refused value is null, and a
/// key that can only be a misspelling of one known key bears that key's name, so that what is left can be read on and
/// checked further without a second error for the same mistake.
void check_scene(JsonNode& root, Diagnostics& diagnostics);

/// The variant that a checked object's "type" names; null pointer when there is none.
[[nodiscard]] const Variant* variant_of(const JsonNode& node, const ObjectSpec& spec);

/// The sentence for what the format has and this version has not.
[[nodiscard]] std::string not_built(const std::string& what);

}  // namespace ricochet::detail
