/// \file
/// A JSON document as a tree of values, and its reader. Only the source file of this header uses a JSON library.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace ricochet {

/// Location of a key or a value in a file, or in a `--set` argument of the command line.
struct SourceLocation {
    std::uint32_t line = 0;            ///< line number, from 1; 0 for the whole file
    std::uint32_t column = 0;          ///< column number in characters, from 1
    std::int32_t override_index = -1;  ///< index of the `--set` argument; -1 for the file
};

struct JsonMember;

/// One JSON value. The checker of scenes replaces refused values by null.
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

/// Most values that are stored from one document.
inline constexpr std::size_t kMostJsonValues = 4'000'000;

/// The part of a member of an object that is stored. Values that are not stored must still be valid JSON.
enum class JsonPart : std::uint8_t { all, key, none };

/// Syntax and limits of one kind of document.
struct JsonLimits {
    std::size_t deepest_nesting;
    std::string too_deep;       ///< error for a list or object at a deeper level
    std::string too_many;       ///< error for more values than kMostJsonValues
    bool has_comments = false;  ///< true if `//` and `/* */` comments are allowed
};

/// Follows the reading of a document, and receives the errors. All functions may throw.
class JsonListener {
public:
    virtual ~JsonListener() = default;
    /// Returns the location of the next token. Called in order for every key, value, and end of a list or object.
    virtual SourceLocation next_location() { return {}; }
    /// Returns the part to store of a member. depth: number of open lists and objects, including that of the member.
    virtual JsonPart part_of(std::string_view /*key*/, std::size_t /*depth*/) { return JsonPart::all; }
    virtual void refuse(const SourceLocation& location, const std::string& error) = 0;
    /// Reports a syntax error or a number beyond the range of doubles. position: number of bytes that have been read.
    virtual void refuse_syntax(std::size_t position, const std::string& error) = 0;
    /// Reports a member whose key repeats an earlier one. Reading continues with the earlier member. open: open lists
    /// and objects, from the root to that of the member.
    virtual void refuse_repetition(const JsonMember& member, std::span<JsonNode* const> open) = 0;
};

/// Parses a whole document. Returns nothing after another error than a repeated key has been reported.
[[nodiscard]] std::optional<JsonNode> read_json(std::string_view text, const JsonLimits& limits,
                                                JsonListener& listener);

}  // namespace ricochet
