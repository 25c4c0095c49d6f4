/// \file
/// What the tables of scene keys say (fields.h makes them), the check of a document against them, and a checked object.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <typeinfo>
#include <vector>

#include "ricochet/core/tolerances.h"
#include "ricochet/io/scene/document.h"

namespace ricochet::detail {

/// Kinds of values.
enum class ValueType {
    number,          ///< any finite number
    integer,         ///< whole number >= 0
    boolean,         ///< true or false
    text,            ///< a text that is not empty
    file,            ///< a path, relative to the scene file
    choice,          ///< one of KeySpec::choices
    integers,        ///< a list of whole numbers >= 0
    vector,          ///< [x, y, z]
    scale,           ///< a number or [x, y, z], no component zero
    pair,            ///< a number, or [mean, spread] for uniform in mean - spread to mean + spread
    object,          ///< an object of KeySpec::content
    named_object,    ///< the same, or the name of one in the table KeySpec::table
    list,            ///< a list of objects of KeySpec::content
    list_or_file,    ///< the same, or {"file": ...}
    table,           ///< an object whose keys are names and whose values are objects of KeySpec::content
    quantity,        ///< a number or [x, y, z]
    vector_pair,     ///< [x, y, z], or [[x, y, z], [spread, spread, spread]]
    quantity_table,  ///< an object whose keys are names and whose values are numbers, vectors, or pairs of these
    text_table,      ///< an object whose keys are names in a file, of any characters, and whose values are texts that
                     ///< are not empty
};

/// Allowed numbers (or vector components).
struct Range {
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
    bool lower_open = false;  ///< lower itself is not allowed

    [[nodiscard]] bool contains(double x) const { return (lower_open ? x > lower : x >= lower) && x <= upper; }
};
[[nodiscard]] constexpr Range between(double lower, double upper) { return {.lower = lower, .upper = upper}; }
[[nodiscard]] constexpr Range positive_up_to(double upper) {
    return {.lower = 0.0, .upper = upper, .lower_open = true};
}
inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{.lower = 0.0, .lower_open = true};
inline constexpr Range kMass{.lower = kSmallestMass};
inline constexpr Range kNotNegative{.lower = 0.0};
inline constexpr Range kFraction = between(0.0, 1.0);
inline constexpr Range kCoordinate = between(-kLargestCoordinate, kLargestCoordinate);
inline constexpr Range kLength = positive_up_to(kLargestCoordinate);
inline constexpr Range kLengthOrZero = between(0.0, kLargestCoordinate);
inline constexpr Range kCount = between(0.0, 4294967295.0);
inline constexpr Range kSeed = between(0.0, 18446744073709551615.0);

/// A value of ValueType::choice.
struct Choice {
    std::string_view name;
    std::string_view description;
    long value = 0;  ///< of the enumeration; without meaning for members that are texts
};
template <class Enum>
[[nodiscard]] Choice choice(Enum value, std::string_view name, std::string_view description) {
    return {name, description, static_cast<long>(value)};
}
/// The same by the enumeration's own name_of().
template <class Enum>
[[nodiscard]] Choice choice(Enum value, std::string_view description) {
    return choice(value, name_of(value), description);
}

struct ObjectSpec;

/// One key.
struct KeySpec {
    std::string_view name;
    ValueType type = ValueType::number;
    std::string_view description;
    std::string_view unit = {};
    Range range = {};                ///< of numbers, vector components and a pair's mean
    Range low_end = {};              ///< of a pair's mean - spread
    std::string default_value = {};  ///< as JSON; empty when there is none
    std::string_view without = {};   ///< what its absence means, where no JSON value says it
    bool required = false;
    bool not_zero = false;           ///< vectors: not all components zero
    std::size_t least = 0;           ///< lists: objects
    std::string_view needs = {};     ///< key that must stand beside it
    std::string_view expected = {};  ///< texts: what is expected, in words of its own
    std::vector<Choice> choices = {};
    const ObjectSpec* content = nullptr;
    std::string_view table = {};  ///< of ValueType::named_object: the scene's key with the named objects
    /// Sets the member of an object to a checked value; empty for keys whose value the builder reads itself.
    std::function<void(void* object, const JsonNode& value)> read = {};
};

/// One value of "type", with the keys that go with it.
struct Variant {
    std::string_view name;
    std::string_view description;
    std::vector<KeySpec> keys;
    std::vector<std::string_view> exactly_one_of = {};  ///< of these keys exactly one must be there
    const std::type_info* target = &typeid(void);       ///< the struct whose members the keys set
};

/// One kind of object. With variants, its "type" key says which; `keys` are common to all of them.
struct ObjectSpec {
    std::string_view title;  ///< singular, for messages and headings: "collider"
    std::string_view description;
    std::vector<KeySpec> keys;
    std::vector<Variant> variants = {};
    const std::type_info* target = &typeid(void);  ///< the struct whose members the keys set
};

/// The object's keys with those of the variant (null pointer: without), in the order of the table.
[[nodiscard]] std::vector<const KeySpec*> keys_of(const ObjectSpec& object, const Variant* variant);
[[nodiscard]] const Variant* find_variant(const ObjectSpec& object, std::string_view name);
/// The variant that a checked object's "type" names; null pointer when there is none.
[[nodiscard]] const Variant* variant_of(const JsonNode& node, const ObjectSpec& spec);
[[nodiscard]] const KeySpec* find_key(const ObjectSpec& object, const Variant* variant, std::string_view name);

/// `a number > 0 (s)`: what a key expects, for messages and the reference.
[[nodiscard]] std::string expectation(const KeySpec& key);
/// `>= 0 and <= 180`; empty when every finite number is allowed.
[[nodiscard]] std::string range_words(const Range& range);
/// The sentence for what the format has and this version has not.
[[nodiscard]] std::string not_built(const std::string& what);

/// Reports everything in the document that the table does not allow: unknown keys (with the nearest known ones), wrong
/// types, values out of range, missing keys, and what is not built yet. Afterwards every refused value is null, and a
/// key that can only be a misspelling of one known key has that key's name, so that what is left can be read on and
/// checked further without a second error for the same mistake.
void check_scene(JsonNode& root, Diagnostics& diagnostics);

/// The members of `object`, a struct whose members these keys set, from a checked object.
void read_members(const JsonNode& node, const std::vector<KeySpec>& keys, void* object);

struct NamedObject;

/// Values that were refused count as absent; what then stands instead (the struct's default) is seen by no one, because
/// the scene is refused as a whole.
class ObjectView {
public:
    /// node: an object, or null (then everything is absent). path: for messages.
    ObjectView(const JsonNode& node, const ObjectSpec& spec, std::string path);

    /// The struct that the object's own keys set, or those of its variant; the other members keep their defaults.
    template <class Struct>
    [[nodiscard]] Struct read() const {
        Struct result = Struct();
        read_members(*node_, keys_for(typeid(Struct)), &result);
        return result;
    }

    /// True for an object that is not there, or was refused.
    [[nodiscard]] bool is_absent() const { return node_->object() == nullptr; }
    [[nodiscard]] bool has(std::string_view key) const { return value(key) != nullptr; }
    /// The value itself; null where it is absent.
    [[nodiscard]] const JsonNode& node(std::string_view key) const;
    /// A name or a path; empty where it is absent.
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] ObjectView object(std::string_view key) const;
    /// The objects of a list.
    [[nodiscard]] std::vector<ObjectView> objects(std::string_view key) const;
    /// The objects of a table.
    [[nodiscard]] std::vector<NamedObject> named_objects(std::string_view key) const;

    /// Name of the variant; empty where it was refused.
    [[nodiscard]] std::string_view type() const { return variant_ == nullptr ? "" : variant_->name; }
    [[nodiscard]] const SourceLocation& location() const { return node_->location; }
    [[nodiscard]] const SourceLocation& location_of(std::string_view key) const;
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] std::string path_of(std::string_view key) const;

private:
    [[nodiscard]] const JsonNode* value(std::string_view key) const;
    [[nodiscard]] const KeySpec& container(std::string_view key) const;
    [[nodiscard]] const std::vector<KeySpec>& keys_for(const std::type_info& target) const;

    const JsonNode* node_;
    const ObjectSpec* spec_;
    const Variant* variant_;
    std::string path_;
};

/// One object of a table.
struct NamedObject {
    std::string name;
    SourceLocation name_location;
    ObjectView view;
};

/// The scene format's version: the value of the key "ricochet".
inline constexpr unsigned kSceneVersion = 1;

}  // namespace ricochet::detail
