/// \file
/// A JSON document as a tree that remembers where every value stands.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ricochet::detail {

/// Where a key or a value stands: in the file, or in one of the command line's `--set` arguments.
struct Place {
    std::uint32_t line = 0;             ///< from 1; 0 where the whole file is meant
    std::uint32_t column = 0;           ///< from 1, in characters
    std::int32_t override_number = -1;  ///< which `--set` argument; -1 for the file
};

struct JsonMember;

/// One value. null is also what the checker leaves in the place of a value that it has refused.
struct JsonNode {
    using Array = std::vector<JsonNode>;
    using Object = std::vector<JsonMember>;
    /// Whole numbers >= 0 are std::uint64_t, negative ones std::int64_t, all others double.
    std::variant<std::monostate, bool, std::uint64_t, std::int64_t, double, std::string, Array, Object> value;
    Place place;

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
    Place key_place;
    JsonNode value;
};

/// The value in a few words for messages: numbers as they are, short texts in quotes, "a list of 3", "an object".
[[nodiscard]] std::string described(const JsonNode& node);

/// Text with everything but printable characters replaced, and cut to a length, for one-line messages.
[[nodiscard]] std::string printable(std::string_view text, std::size_t longest = 200);

}  // namespace ricochet::detail
