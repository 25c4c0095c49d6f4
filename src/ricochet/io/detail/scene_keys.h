/// \file
/// The one table of everything that a scene file can say. The reader, the JSON Schema and the reference in docs/ are
/// all made from it.
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "ricochet/io/detail/json_node.h"

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
    text_table,      ///< an object whose keys are names and whose values are texts that are not empty
};

/// Allowed numbers (or vector components).
struct Range {
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
    bool lower_open = false;  ///< lower itself is not allowed

    [[nodiscard]] bool contains(double x) const { return (lower_open ? x > lower : x >= lower) && x <= upper; }
};

/// What of the scene format this version can do.
enum class Built {
    yes,
    only_zero,  ///< the key is known, but only the value 0
    no,         ///< part of the format; refused by name
};

/// A value of ValueType::choice.
struct Choice {
    std::string_view name;
    std::string_view description;
    Built built = Built::yes;
};

struct ObjectSpec;

/// One key.
struct KeySpec {
    std::string_view name;
    ValueType type = ValueType::number;
    std::string_view description;
    std::string_view unit = {};
    Range range = {};                ///< of numbers, vector components and a pair's mean
    Range low_end = {};              ///< of a pair's mean - spread
    std::string_view fallback = {};  ///< the default as JSON; empty when there is none
    std::string_view without = {};   ///< what its absence means, where no JSON value says it
    bool required = false;
    bool not_zero = false;   ///< vectors: not all components zero
    bool not_empty = false;  ///< lists: at least one object
    Built built = Built::yes;
    std::string_view needs = {};  ///< key that must stand beside it
    std::vector<Choice> choices = {};
    const ObjectSpec* content = nullptr;
    std::string_view table = {};  ///< of ValueType::named_object: the scene's key with the named objects
};

/// One value of "type", with the keys that go with it.
struct Variant {
    std::string_view name;
    std::string_view description;
    std::vector<KeySpec> keys;
    std::vector<std::string_view> exactly_one_of = {};  ///< of these keys exactly one must be there
};

/// One kind of object. With variants, its "type" key says which; `keys` are common to all of them.
struct ObjectSpec {
    std::string_view title;  ///< singular, for messages and headings: "collider"
    std::string_view description;
    std::vector<KeySpec> keys;
    std::vector<Variant> variants = {};
};

/// The whole scene.
[[nodiscard]] const ObjectSpec& scene_spec();
/// {"file": ...} in the place of a particle list.
[[nodiscard]] const ObjectSpec& particle_file_spec();

/// Where a shape stands: position, rotation and scale. needs: the key that must stand beside them, or none.
[[nodiscard]] std::vector<KeySpec> placement_keys(std::string_view needs);

/// The object's keys with those of the variant (null pointer: without), in the order of the table.
[[nodiscard]] std::vector<const KeySpec*> keys_of(const ObjectSpec& object, const Variant* variant);
[[nodiscard]] const Variant* find_variant(const ObjectSpec& object, std::string_view name);
[[nodiscard]] const KeySpec* find_key(const ObjectSpec& object, const Variant* variant, std::string_view name);

/// `a number > 0 (s)`: what a key expects, for messages and the reference.
[[nodiscard]] std::string expectation(const KeySpec& key);
/// `>= 0 and <= 180`; empty when every finite number is allowed.
[[nodiscard]] std::string range_words(const Range& range);

/// The scene format's version: the value of the key "ricochet".
inline constexpr unsigned kSceneVersion = 1;

}  // namespace ricochet::detail
