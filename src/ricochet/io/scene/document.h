/// \file
/// A scene file as a JSON document with source locations: parsing, changes by `--set`, and hashes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "ricochet/core/hash.h"
#include "ricochet/core/json_document.h"

namespace ricochet::detail {

class Diagnostics;

/// Parses a whole document. `//` and `/* */` comments are allowed. Returns nothing after reporting a syntax error, a
/// number beyond the range of doubles, or a document beyond the two limits. Reports duplicate keys and keeps the first.
[[nodiscard]] std::optional<JsonNode> parse_json(std::string_view text, Diagnostics& diagnostics);

/// Parses the value of a `--set` argument. Every node gets the given location. Returns nothing if the text is not JSON.
[[nodiscard]] std::optional<JsonNode> parse_json_value(std::string_view text, const SourceLocation& location);

/// Applies the change diagnostics.overrides()[number] to the document. Examples: `colliders[0].scale=[1, 2, 1]`,
/// `materials["old rubber"].friction=0.2`. A value that is not JSON becomes a string, so
/// `simulation.integrator=ballistic` needs no quotes. Adds missing objects and keys; a later check refuses unknown
/// keys. List items must exist. Reports changes that cannot be applied.
void apply_override(JsonNode& root, std::size_t number, Diagnostics& diagnostics);

/// Adds a value to a hash. Different values add different sequences.
void add_to_hash(StateHash& hash, const JsonNode& node);

/// Returns a hash of the scene's values. It excludes the duration, and the keys for output and pictures. It depends on
/// the order of keys in the file.
[[nodiscard]] std::uint64_t scene_fingerprint(const JsonNode& root);

}  // namespace ricochet::detail
