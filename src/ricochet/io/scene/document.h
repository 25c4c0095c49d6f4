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

/// Location of a key or a value in the file, or in a `--set` argument of the command line.
struct SourceLocation {
    std::uint32_t line = 0;            ///< line number, from 1; 0 for the whole file
    std::uint32_t column = 0;          ///< column number in characters, from 1
    std::int32_t override_index = -1;  ///< index of the `--set` argument; -1 for the file
};

struct JsonMember;

/// One JSON value. The checker replaces refused values by null.
struct JsonNode {
    using Array = std::vector<JsonNode>;
    using Object = std::vector<JsonMember>;
    /// Value. Whole numbers >= 0 are std::uint64_t, negative whole numbers std::int64_t, and all other numbers double.
    std::variant<std::monostate, bool, std::uint64_t, std::int64_t, double, std::string, Array, Object> value;
    SourceLocation location;

    [[nodiscard]] bool is_null() const { return std::holds_alternative<std::monostate>(value); }
    [[nodiscard]] const Array* array() const { return std::get_if<Array>(&value); }
    [[nodiscard]] Array* array() { return std::get_if<Array>(&value); }
    [[nodiscard]] const Object* object() const { return std::get_if<Object>(&value); }
    [[nodiscard]] Object* object() { return std::get_if<Object>(&value); }
    [[nodiscard]] const std::string* text() const { return std::get_if<std::string>(&value); }
    /// Returns a number of any type as a double, rounded if it has more than 53 bits. Returns nothing for other values.
    [[nodiscard]] std::optional<double> number() const;
    /// Returns a whole number >= 0, even if it is written as 2.0 or 1e6. Returns nothing for other values.
    [[nodiscard]] std::optional<std::uint64_t> whole_number() const;
    /// Returns the value of a key. Returns a null pointer if this node is not an object or does not have the key.
    [[nodiscard]] const JsonNode* find(std::string_view key) const;
    [[nodiscard]] JsonNode* find(std::string_view key);
};

/// One key with its value. The members of an object are in the order of the document.
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

/// Returns a hash of the scene's values. It excludes the duration, and the keys for output and pictures. It depends on
/// the order of keys in the file.
[[nodiscard]] std::uint64_t scene_fingerprint(const JsonNode& root);

}  // namespace ricochet::detail
