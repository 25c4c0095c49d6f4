/// \file
/// Text to tree: strict JSON with comments, bounded in depth and size.
#pragma once

#include <optional>
#include <string_view>

#include "ricochet/io/detail/diagnostics.h"
#include "ricochet/io/detail/json_node.h"

namespace ricochet::detail {

inline constexpr std::size_t kDeepestNesting = 64;
inline constexpr std::size_t kMostValues = 4000000;

/// Parses a whole document. `//` and `/* */` comments are allowed; duplicate keys, trailing commas, numbers beyond the
/// range of doubles, nesting deeper than kDeepestNesting and more than kMostValues values are errors. Syntax errors
/// are reported and leave nothing; duplicate keys are reported and the first one is kept.
[[nodiscard]] std::optional<JsonNode> parse_json(std::string_view text, Diagnostics& diagnostics);

/// A single value of a `--set` argument: every node gets the place. Nothing when the text is not JSON.
[[nodiscard]] std::optional<JsonNode> parse_json_value(std::string_view text, const Place& place);

}  // namespace ricochet::detail
