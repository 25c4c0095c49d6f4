/// \file
/// A scene file as a JSON document whose values know their source locations: read, changed by `--set`, hashed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ricochet::detail {

class Diagnostics;

/// Where a key or a value stands: in the file, or in one of the command line's `--set` arguments.
struct SourceLocation {
    std::uint32_t line = 0;            ///< from 1; 0 where the whole file is meant
    std::uint32_t column = 0;          ///< from 1, in characters
    std::int32_t override_index = -1;  ///< which `--set` argument; -1 for the file
};

struct JsonMember;

/// One value. null is also what the checker leaves instead of a value that it has refused.
struct JsonNode {
    using Array = std::vector<JsonNode>;
    using Object = std::vector<JsonMember>;
    /// Whole numbers >= 0 are std::uint64_t, negative ones std::int64_t, all others double.
    std::variant<std::monostate, bool, std::uint64_t, std::int64_t, double, std::string, Array, Object> value;
    SourceLocation location;

    [[nodiscard]] bool is_null() const { return std::holds_alternative<std::monostate>(value); }
    [[nodiscard]] const Array* array() const { return std::get_if<Array>(&value); }
    [[nodiscard]] Array* array() { return std::get_if<Array>(&value); }
    [[nodiscard]] const Object* object() const { return std::get_if<Object>(&value); }
    [[nodiscard]] Object* object() { return std::get_if<Object>(&value); }
    [[nodiscard]] const std::string* text() const { return std::get_if<std::string>(&value); }
    /// Any number as a double (rounded where it has more than 53 bits).
    [[nodiscard]] std::optional<double> number() const;
    /// A whole number >= 0, also when written as 2.0 or 1e6.
    [[nodiscard]] std::optional<std::uint64_t> whole_number() const;
    /// The value of a key; null pointer when this is no object or has no such key.
    [[nodiscard]] const JsonNode* find(std::string_view key) const;
    [[nodiscard]] JsonNode* find(std::string_view key);
};

/// One key with its value, in the order of the document.
struct JsonMember {
    std::string key;
    SourceLocation key_location;
    JsonNode value;
};

/// The value in a few words for messages: numbers as they are, short texts in quotes, "a list of 3", "an object".
[[nodiscard]] std::string described(const JsonNode& node);

/// Longest message of a parser, bytes.
inline constexpr std::size_t kLongestMessage = 200;

inline constexpr std::size_t kDeepestNesting = 64;
inline constexpr std::size_t kMostValues = 4000000;

/// Parses a whole document. `//` and `/* */` comments are allowed; duplicate keys, trailing commas, numbers beyond the
/// range of doubles, nesting deeper than kDeepestNesting and more than kMostValues values are errors. Syntax errors
/// are reported and leave nothing; duplicate keys are reported and the first one is kept.
[[nodiscard]] std::optional<JsonNode> parse_json(std::string_view text, Diagnostics& diagnostics);

/// A single value of a `--set` argument: every node gets the location. Nothing when the text is not JSON.
[[nodiscard]] std::optional<JsonNode> parse_json_value(std::string_view text, const SourceLocation& location);

/// Applies diagnostics.overrides()[number] to the document, for example `simulation.time_step=0.01`,
/// `colliders[0].scale=[1, 2, 1]` or `materials["old rubber"].friction=0.2`. VALUE is JSON; what is not JSON is taken
/// as a text, so that `simulation.integrator=ballistic` needs no quotes. Objects and keys that are not there are made
/// (the check that follows refuses those it does not know); list items must be there. Reports what it cannot do.
void apply_override(JsonNode& root, std::size_t number, Diagnostics& diagnostics);

/// A hash of the scene's values, without source locations and comments, and without what only says what is written and
/// how it is shown ("output", "camera", "picture", "title", "description"). Keys count in the order of the file.
[[nodiscard]] std::uint64_t scene_fingerprint(const JsonNode& root);

}  // namespace ricochet::detail
