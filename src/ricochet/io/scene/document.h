/// \file
/// A scene file as a JSON document with source locations: parsing, changes by `--set`, and hashes.
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

/// Location of a key or a value: in the file, or in one of the command line's `--set` arguments.
struct SourceLocation {
    std::uint32_t line = 0;            ///< from 1; 0 for the whole file
    std::uint32_t column = 0;          ///< from 1, in characters
    std::int32_t override_index = -1;  ///< index of the `--set` argument; -1 for the file
};

struct JsonMember;

/// One JSON value. The checker replaces refused values by null.
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
    /// Returns any number as a double (rounded if it has more than 53 bits).
    [[nodiscard]] std::optional<double> number() const;
    /// Returns a whole number >= 0, also if it is written as 2.0 or 1e6.
    [[nodiscard]] std::optional<std::uint64_t> whole_number() const;
    /// Returns the value of a key, or a null pointer if this is no object or has no such key.
    [[nodiscard]] const JsonNode* find(std::string_view key) const;
    [[nodiscard]] JsonNode* find(std::string_view key);
};

/// One key with its value. Members keep the order of the document.
struct JsonMember {
    std::string key;
    SourceLocation key_location;
    JsonNode value;
};

/// Returns a short description of a value for messages: a number, a short text in quotes, "a list of 3", "an object".
[[nodiscard]] std::string described(const JsonNode& node);

/// Longest message of a parser, in bytes.
inline constexpr std::size_t kLongestMessage = 200;

inline constexpr std::size_t kDeepestNesting = 64;
inline constexpr std::size_t kMostValues = 4000000;

/// Parses a whole document. `//` and `/* */` comments are allowed. Duplicate keys, trailing commas and numbers beyond
/// the range of doubles are errors. So are nesting deeper than kDeepestNesting and more than kMostValues values.
/// Reports a syntax error and returns nothing. Reports duplicate keys and keeps the first one.
[[nodiscard]] std::optional<JsonNode> parse_json(std::string_view text, Diagnostics& diagnostics);

/// Parses a single value of a `--set` argument. Every node gets the location. Returns nothing if the text is not JSON.
[[nodiscard]] std::optional<JsonNode> parse_json_value(std::string_view text, const SourceLocation& location);

/// Applies diagnostics.overrides()[number] to the document, for example `simulation.time_step=0.01`,
/// `colliders[0].scale=[1, 2, 1]` or `materials["old rubber"].friction=0.2`. VALUE is JSON. Any other value is a text,
/// so that `simulation.integrator=ballistic` needs no quotes. Adds missing objects and keys; the later check refuses
/// unknown ones. List items must exist. Reports changes that it cannot apply.
void apply_override(JsonNode& root, std::size_t number, Diagnostics& diagnostics);

/// Returns a hash of the scene's values, without source locations and comments. It leaves out the duration, and the
/// keys for output and pictures ("output", "camera", "picture", "title", "description"). The order of keys in the file
/// counts.
[[nodiscard]] std::uint64_t scene_fingerprint(const JsonNode& root);

}  // namespace ricochet::detail
