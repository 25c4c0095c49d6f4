/// \file
/// Scene keys bound to the members that they set. One line of a table says a key's name, member, range, unit and
/// meaning; the checker, the reader, the JSON Schema and the reference in docs/ all follow from it. Types and defaults
/// are those of the member.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "ricochet/core/tolerances.h"
#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/emitter.h"
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
    text_table,      ///< an object whose keys are names and whose values are texts that are not empty
};

/// Allowed numbers (or vector components).
struct Range {
    double lower = -std::numeric_limits<double>::infinity();
    double upper = std::numeric_limits<double>::infinity();
    bool lower_open = false;  ///< lower itself is not allowed

    [[nodiscard]] bool contains(double x) const { return (lower_open ? x > lower : x >= lower) && x <= upper; }
};
[[nodiscard]] constexpr Range between(double lower, double upper) { return {.lower = lower, .upper = upper}; }
inline constexpr Range kAnyNumber{};
inline constexpr Range kPositive{.lower = 0.0, .lower_open = true};
inline constexpr Range kNotNegative{.lower = 0.0};
inline constexpr Range kFraction = between(0.0, 1.0);
inline constexpr Range kCoordinate = between(-kLargestCoordinate, kLargestCoordinate);
inline constexpr Range kLength{.lower = 0.0, .upper = kLargestCoordinate, .lower_open = true};
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
    bool not_zero = false;        ///< vectors: not all components zero
    bool not_empty = false;       ///< lists: at least one object
    bool built = true;            ///< false: part of the format, refused by name
    std::string_view needs = {};  ///< key that must stand beside it
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

// How the type of a member says what JSON value sets it, and how its default is written. Values are checked before.

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};
template <class T>
struct IsVector : std::false_type {};
template <class T>
struct IsVector<std::vector<T>> : std::true_type {};

void read_value(const JsonNode& node, const KeySpec& key, double& value);
void read_value(const JsonNode& node, const KeySpec& key, bool& value);
void read_value(const JsonNode& node, const KeySpec& key, std::string& value);
/// [x, y, z], or one number for all three.
void read_value(const JsonNode& node, const KeySpec& key, Vec3& value);
void read_value(const JsonNode& node, const KeySpec& key, MeanSpread& value);
/// The members of `object`, a struct whose members the content's keys set.
void read_members(const JsonNode& node, const std::vector<KeySpec>& keys, void* object);

template <class Member>
void read_value(const JsonNode& node, const KeySpec& key, Member& value) {
    if constexpr (IsOptional<Member>::value) {
        read_value(node, key, value.emplace());
    } else if constexpr (IsVector<Member>::value) {
        for (const JsonNode& item : *node.array()) read_value(item, key, value.emplace_back());
    } else if constexpr (std::is_integral_v<Member>) {
        value = static_cast<Member>(node.whole_number().value_or(0));
    } else if constexpr (std::is_enum_v<Member>) {
        for (const Choice& choice : key.choices) {
            if (choice.name == *node.text()) value = static_cast<Member>(choice.value);
        }
    } else {
        read_members(node, key.content->keys, &value);
    }
}

template <class Member>
constexpr ValueType type_of() {
    if constexpr (IsOptional<Member>::value) {
        return type_of<typename Member::value_type>();
    } else if constexpr (IsVector<Member>::value) {
        return std::is_integral_v<typename Member::value_type> ? ValueType::integers : ValueType::list;
    } else if constexpr (std::is_same_v<Member, bool>) {
        return ValueType::boolean;
    } else if constexpr (std::is_integral_v<Member>) {
        return ValueType::integer;
    } else if constexpr (std::is_floating_point_v<Member>) {
        return ValueType::number;
    } else if constexpr (std::is_enum_v<Member>) {
        return ValueType::choice;
    } else if constexpr (std::is_same_v<Member, std::string>) {
        return ValueType::text;
    } else if constexpr (std::is_same_v<Member, Vec3>) {
        return ValueType::vector;
    } else {
        return std::is_same_v<Member, MeanSpread> ? ValueType::pair : ValueType::object;
    }
}

/// The JSON text of a default; empty where it is no value that a scene can hold (infinite, nothing, an empty text).
[[nodiscard]] std::string default_text(const KeySpec& key, double value);
[[nodiscard]] std::string default_text(const KeySpec& key, std::uint64_t value);
[[nodiscard]] std::string default_text(const KeySpec& key, bool value);
[[nodiscard]] std::string default_text(const KeySpec& key, const std::string& value);
[[nodiscard]] std::string default_text(const KeySpec& key, const Vec3& value);

template <class Member>
[[nodiscard]] std::string default_text_of(const KeySpec& key, const Member& value) {
    if constexpr (std::is_enum_v<Member>) {
        for (const Choice& choice : key.choices) {
            if (choice.value == static_cast<long>(value)) return default_text(key, std::string(choice.name));
        }
        return "";
    } else if constexpr (std::is_same_v<Member, MeanSpread>) {
        return default_text(key, value.mean);
    } else if constexpr (std::is_integral_v<Member> && !std::is_same_v<Member, bool>) {
        return default_text(key, static_cast<std::uint64_t>(value));
    } else if constexpr (requires { default_text(key, value); }) {
        return default_text(key, value);
    } else {
        return key.type == ValueType::list ? "[]" : "";
    }
}

// What a line of the table can say besides name, member, range, unit and meaning.

enum class Rule { required, not_zero, not_empty, not_built };
inline constexpr Rule kRequired = Rule::required;
inline constexpr Rule kNotZero = Rule::not_zero;
inline constexpr Rule kNotEmpty = Rule::not_empty;
inline constexpr Rule kNotBuilt = Rule::not_built;
/// What the key's absence means, in place of a default.
struct Without {
    std::string_view words;
};
struct Unit {
    std::string_view name;
};
/// Key that must stand beside it.
struct Needs {
    std::string_view key;
};
/// Allowed values of a pair's mean - spread.
struct LowEnd {
    Range range;
};
/// The scene's key with the objects that can be named instead.
struct NamedIn {
    std::string_view table;
};
using Choices = std::vector<Choice>;

void set_option(KeySpec& key, Rule rule);
inline void set_option(KeySpec& key, Without without) { key.without = without.words; }
inline void set_option(KeySpec& key, Unit unit) { key.unit = unit.name; }
inline void set_option(KeySpec& key, Needs needs) { key.needs = needs.key; }
inline void set_option(KeySpec& key, LowEnd low_end) { key.low_end = low_end.range; }
inline void set_option(KeySpec& key, NamedIn named_in) { key.table = named_in.table; }
inline void set_option(KeySpec& key, ValueType type) { key.type = type; }
inline void set_option(KeySpec& key, const ObjectSpec* content) { key.content = content; }
inline void set_option(KeySpec& key, Choices choices) {
    key.choices = std::move(choices);
    key.type = ValueType::choice;
}

/// One line of the table of a struct: a key, bound to the member that `member` (a pointer to it, or a function) gives,
/// or of a type without a member, for what the builder reads itself.
template <class Struct>
struct Field : KeySpec {
    template <class Member, class... Options>
    requires std::invocable<Member, Struct&> Field(std::string_view key, Member member, Range allowed,
                                                   std::string_view si_unit, std::string_view meaning,
                                                   Options... options) {
        using Value = std::remove_cvref_t<std::invoke_result_t<Member, Struct&>>;
        type = type_of<Value>();
        describe(key, allowed, si_unit, meaning, options...);
        if constexpr (std::default_initializable<Struct>) {
            Struct defaults = Struct();
            if (without.empty() && !required)
                default_value = default_text_of<Value>(*this, std::invoke(member, defaults));
        }
        read = [member, spec = reading_spec()](void* object, const JsonNode& value) {
            auto&& target = std::invoke(member, *static_cast<Struct*>(object));
            read_value(value, spec, target);
        };
    }
    template <class Member, class... Options>
    requires std::invocable<Member, Struct&> Field(std::string_view key, Member member, std::string_view meaning,
                                                   Options... options)
        : Field(key, member, kAnyNumber, "", meaning, options...) {}

    template <class... Options>
    Field(std::string_view key, ValueType value_type, Range allowed, std::string_view si_unit, std::string_view meaning,
          Options... options) {
        type = value_type;
        describe(key, allowed, si_unit, meaning, options...);
        if (!without.empty() || required) return;
        const bool is_list = type == ValueType::list || type == ValueType::list_or_file;
        default_value = is_list ? "[]" : type == ValueType::table ? "{}" : "";
    }
    template <class... Options>
    Field(std::string_view key, ValueType value_type, std::string_view meaning, Options... options)
        : Field(key, value_type, kAnyNumber, "", meaning, options...) {}

private:
    template <class... Options>
    void describe(std::string_view key, Range allowed, std::string_view si_unit, std::string_view meaning,
                  Options... options) {
        name = key;
        range = allowed;
        unit = si_unit;
        description = meaning;
        (set_option(*this, options), ...);
    }
    // What reading needs of the key.
    [[nodiscard]] KeySpec reading_spec() const {
        return {.name = name, .type = type, .description = description, .choices = choices, .content = content};
    }
};

template <class Struct>
using Fields = std::vector<Field<Struct>>;

template <class Struct>
[[nodiscard]] Fields<Struct> joined(std::initializer_list<Fields<Struct>> parts) {
    Fields<Struct> fields;
    for (const Fields<Struct>& part : parts) fields.insert(fields.end(), part.begin(), part.end());
    return fields;
}

template <class Struct>
[[nodiscard]] Variant variant(std::string_view name, std::string_view description, const Fields<Struct>& fields,
                              std::vector<std::string_view> exactly_one_of = {}) {
    return {name, description, {fields.begin(), fields.end()}, std::move(exactly_one_of), &typeid(Struct)};
}

template <class Struct>
[[nodiscard]] ObjectSpec object(std::string_view title, std::string_view description, const Fields<Struct>& fields,
                                std::vector<Variant> variants = {}) {
    return {title, description, {fields.begin(), fields.end()}, std::move(variants), &typeid(Struct)};
}

/// For tables of keys that set no members.
struct Unbound {};

/// The scene format's version: the value of the key "ricochet".
inline constexpr unsigned kSceneVersion = 1;

}  // namespace ricochet::detail
