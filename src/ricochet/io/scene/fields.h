/// \file
/// Scene keys bound to the members that they set. The checker, the reader, the JSON Schema and the reference in docs/
/// are all derived from these tables. Type and default follow from the member:
///
///     {"density", &BodyKeys::density, kPositive, "kg/m^3", "Mass per volume."}
///
/// fields_of() makes the keys of a struct whose settings have their own table (core/setting.h).
#pragma once

#include <array>
#include <concepts>
#include <functional>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/emitter.h"
#include "ricochet/io/scene/keys.h"

namespace ricochet::detail {

template <class Member>
concept Enumeration = std::is_enum_v<Member>;

/// Format of members of one type in a scene. read() converts a checked value. text() returns the JSON text of a
/// default; empty if a scene cannot express it. This general template is for structs with the keys KeySpec::content.
template <class Member>
struct Format {
    static constexpr ValueType kType = ValueType::object;
    static void read(const JsonNode& node, const KeySpec& key, Member& value) {
        read_members(node, key.content->keys, &value);
    }
    static std::string text(const KeySpec& /*key*/, const Member& /*value*/) { return ""; }
};

template <>
struct Format<double> {
    static constexpr ValueType kType = ValueType::number;
    static void read(const JsonNode& node, const KeySpec& key, double& value);
    static std::string text(const KeySpec& key, double value);
};
template <>
struct Format<bool> {
    static constexpr ValueType kType = ValueType::boolean;
    static void read(const JsonNode& node, const KeySpec& key, bool& value);
    static std::string text(const KeySpec& key, bool value);
};
template <>
struct Format<std::string> {
    static constexpr ValueType kType = ValueType::text;
    static void read(const JsonNode& node, const KeySpec& key, std::string& value);
    static std::string text(const KeySpec& key, const std::string& value);
};
/// Format of vectors: [x, y, z]. With ValueType::scale, a single number sets all three components.
template <>
struct Format<Vec3> {
    static constexpr ValueType kType = ValueType::vector;
    static void read(const JsonNode& node, const KeySpec& key, Vec3& value);
    static std::string text(const KeySpec& key, const Vec3& value);
};
template <>
struct Format<std::array<double, 2>> {
    static constexpr ValueType kType = ValueType::two_numbers;
    static void read(const JsonNode& node, const KeySpec& key, std::array<double, 2>& value);
    static std::string text(const KeySpec& key, const std::array<double, 2>& value);
};
template <>
struct Format<MeanSpread> {
    static constexpr ValueType kType = ValueType::pair;
    static void read(const JsonNode& node, const KeySpec& key, MeanSpread& value);
    static std::string text(const KeySpec& key, const MeanSpread& value);
};
/// Format of drawn values: as a pair, or an object with the keys of KeySpec::content, the distribution.
template <>
struct Format<DrawnValue> {
    static constexpr ValueType kType = ValueType::drawn;
    static void read(const JsonNode& node, const KeySpec& key, DrawnValue& value);
    static std::string text(const KeySpec& key, const DrawnValue& value);
};
template <std::integral Member>
struct Format<Member> {
    static constexpr ValueType kType = ValueType::integer;
    static void read(const JsonNode& node, const KeySpec& /*key*/, Member& value) {
        value = static_cast<Member>(node.whole_number().value_or(0));
    }
    static std::string text(const KeySpec& /*key*/, Member value) { return std::to_string(value); }
};
template <Enumeration Member>
struct Format<Member> {
    static constexpr ValueType kType = ValueType::choice;
    static void read(const JsonNode& node, const KeySpec& key, Member& value) {
        for (const Choice& one : key.choices) {
            if (one.name == *node.text()) value = static_cast<Member>(one.value);
        }
    }
    static std::string text(const KeySpec& key, Member value) {
        for (const Choice& one : key.choices) {
            if (one.value == static_cast<long>(value)) return "\"" + std::string(one.name) + "\"";
        }
        return "";
    }
};
template <class Member>
struct Format<std::optional<Member>> {
    static constexpr ValueType kType = Format<Member>::kType;
    static void read(const JsonNode& node, const KeySpec& key, std::optional<Member>& value) {
        Format<Member>::read(node, key, value.emplace());
    }
    static std::string text(const KeySpec& /*key*/, const std::optional<Member>& /*value*/) { return ""; }
};
template <class Member>
struct Format<std::vector<Member>> {
    static constexpr ValueType kType = std::integral<Member> ? ValueType::integers : ValueType::list;
    static void read(const JsonNode& node, const KeySpec& key, std::vector<Member>& value) {
        for (const JsonNode& item : *node.array()) Format<Member>::read(item, key, value.emplace_back());
    }
    static std::string text(const KeySpec& /*key*/, const std::vector<Member>& /*value*/) { return "[]"; }
};

// Options of a table line, in addition to name, member, range, unit and meaning.

enum class Rule { none, required, not_zero, not_empty, two_or_more };
inline constexpr Rule kRequired = Rule::required;
inline constexpr Rule kNotZero = Rule::not_zero;
inline constexpr Rule kNotEmpty = Rule::not_empty;
inline constexpr Rule kTwoOrMore = Rule::two_or_more;
/// Meaning of an absent key, for keys without a default.
struct Without {
    std::string_view words;
};
struct Unit {
    std::string_view name;
};
/// Description of the expected text, for messages and the reference.
struct Expected {
    std::string_view words;
};
/// Key that must also be present.
struct Needs {
    std::string_view key;
};
/// Allowed values of mean - spread of a pair.
struct LowEnd {
    Range range;
};
/// Key of the scene that contains the objects whose names can be used as values.
struct NamedIn {
    std::string_view table;
};
using Choices = std::vector<Choice>;

void set_option(KeySpec& key, Rule rule);
inline void set_option(KeySpec& key, Without without) { key.without = without.words; }
inline void set_option(KeySpec& key, Unit unit) { key.unit = unit.name; }
inline void set_option(KeySpec& key, Expected expected) { key.expected = expected.words; }
inline void set_option(KeySpec& key, Needs needs) { key.needs = needs.key; }
inline void set_option(KeySpec& key, LowEnd low_end) { key.low_end = low_end.range; }
inline void set_option(KeySpec& key, NamedIn named_in) { key.table = named_in.table; }
inline void set_option(KeySpec& key, ValueType type) { key.type = type; }
inline void set_option(KeySpec& key, const ObjectSpec* content) { key.content = content; }
inline void set_option(KeySpec& key, Choices choices) {
    key.choices = std::move(choices);
    key.type = ValueType::choice;
}

template <class Member, class Struct>
concept MemberOf = std::invocable<Member, Struct&>;

/// One line of the table of a struct. `member` is a pointer to the member or a function that returns it. A line can
/// also describe a key without a member, which the builder of the object reads.
template <class Struct>
struct Field : KeySpec {
    template <MemberOf<Struct> Member, class... Options>
    Field(std::string_view key, Member member, Range allowed, std::string_view si_unit, std::string_view meaning,
          Options... options) {
        using Value = std::remove_cvref_t<std::invoke_result_t<Member, Struct&>>;
        type = Format<Value>::kType;
        describe(key, allowed, si_unit, meaning, options...);
        if constexpr (std::default_initializable<Struct>) {
            // The object is static, because for a local struct, GCC warns that the members may be uninitialized.
            static Struct defaults = Struct();
            if (without.empty() && !required) default_value = Format<Value>::text(*this, std::invoke(member, defaults));
        }
        read = [member, spec = reading_spec()](void* object, const JsonNode& value) {
            auto&& target = std::invoke(member, *static_cast<Struct*>(object));
            Format<Value>::read(value, spec, target);
        };
    }
    template <MemberOf<Struct> Member, class... Options>
    Field(std::string_view key, Member member, std::string_view meaning, Options... options)
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
    // Returns the members of the key that read functions need.
    [[nodiscard]] KeySpec reading_spec() const {
        return {.name = name, .type = type, .description = description, .choices = choices, .content = content};
    }
};

template <class Struct>
using Fields = std::vector<Field<Struct>>;

/// Returns the keys of a table of settings for the part of a struct that part_of() returns. options: apply to all keys.
template <class Struct>
[[nodiscard]] Fields<Struct> fields_of_part(auto part_of, const auto& table, auto... options) {
    Fields<Struct> fields;
    for (const auto& line : table) {
        const auto add = [&](auto member) {
            const auto value_of = [=](Struct & object) -> auto& { return std::invoke(part_of, object).*member; };
            fields.push_back({line.name, value_of, line.range, line.unit, line.meaning, Without{line.without},
                              line.is_required ? kRequired : Rule::none, Needs{line.needs}, options...});
        };
        std::visit(add, line.member);
    }
    return fields;
}

/// Returns the keys of a table of settings. options: apply to all keys.
template <class Struct>
[[nodiscard]] Fields<Struct> fields_of(const auto& table, auto... options) {
    return fields_of_part<Struct>(std::identity{}, table, options...);
}

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
                                std::vector<Variant> variants = {}, std::string_view default_type = {}) {
    return {title, description, {fields.begin(), fields.end()}, std::move(variants), &typeid(Struct), default_type};
}

/// Empty struct for tables whose keys set no members.
struct Unbound {};

}  // namespace ricochet::detail
