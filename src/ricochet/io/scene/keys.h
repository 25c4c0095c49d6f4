/// \file
/// Descriptions of scene keys (made in fields.h), the check of a document against them, and access to checked objects.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <typeinfo>
#include <vector>

#include "ricochet/core/setting.h"
#include "ricochet/io/scene/document.h"

namespace ricochet::detail {

/// Kinds of values in a scene.
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
    named_object,    ///< an object of KeySpec::content, or the name of one in the table KeySpec::table
    list,            ///< a list of objects of KeySpec::content
    list_or_file,    ///< a list of objects of KeySpec::content, or {"file": ...}
    table,           ///< an object whose keys are names and whose values are objects of KeySpec::content
    quantity,        ///< a number or [x, y, z]
    vector_pair,     ///< [x, y, z], or [[x, y, z], [spread, spread, spread]]
    quantity_table,  ///< an object whose keys are names and whose values are numbers, vectors, or pairs of these
    text_table,      ///< an object whose keys are names in a file (any characters) and whose values are non-empty texts
};

/// A value of ValueType::choice.
struct Choice {
    std::string_view name;
    std::string_view description;
    long value = 0;  ///< number of the enumerator; unused for members that are texts
};
template <class Enum>
[[nodiscard]] Choice choice(Enum value, std::string_view name, std::string_view description) {
    return {name, description, static_cast<long>(value)};
}
/// Returns the choice for an enumerator, with the name that name_of() gives it.
template <class Enum>
[[nodiscard]] Choice choice(Enum value, std::string_view description) {
    return choice(value, name_of(value), description);
}

struct ObjectSpec;

/// One key of an object.
struct KeySpec {
    std::string_view name;
    ValueType type = ValueType::number;
    std::string_view description;
    std::string_view unit = {};
    Range range = {};                ///< allowed numbers, vector components and means of pairs
    Range low_end = {};              ///< allowed values of mean - spread of a pair
    std::string default_value = {};  ///< as JSON; empty if there is none
    std::string_view without = {};   ///< meaning of an absent key, if no JSON value expresses it
    bool required = false;
    bool not_zero = false;           ///< for vectors: not all components are zero
    std::size_t least = 0;           ///< for lists: smallest number of objects
    std::string_view needs = {};     ///< key that must be present together with this one
    std::string_view expected = {};  ///< for texts: expectation in words, for messages
    std::vector<Choice> choices = {};
    const ObjectSpec* content = nullptr;
    std::string_view table = {};  ///< for ValueType::named_object: key of the scene with the named objects
    /// Sets the member of an object to a checked value. Empty for keys that the builder reads itself.
    std::function<void(void* object, const JsonNode& value)> read = {};
};

/// One value of "type", with the keys of objects of this type.
struct Variant {
    std::string_view name;
    std::string_view description;
    std::vector<KeySpec> keys;
    std::vector<std::string_view> exactly_one_of = {};  ///< exactly one of these keys must be present
    const std::type_info* target = &typeid(void);       ///< struct whose members the keys set
};

/// One kind of object. If it has variants, its "type" key selects one; `keys` are common to all variants.
struct ObjectSpec {
    std::string_view title;  ///< singular, for messages and headings: "collider"
    std::string_view description;
    std::vector<KeySpec> keys;
    std::vector<Variant> variants = {};
    const std::type_info* target = &typeid(void);  ///< struct whose members the keys set
};

/// Returns the object's keys, then the variant's keys, in the order of the table. variant: null pointer for none.
[[nodiscard]] std::vector<const KeySpec*> keys_of(const ObjectSpec& object, const Variant* variant);
[[nodiscard]] const Variant* find_variant(const ObjectSpec& object, std::string_view name);
/// Returns the variant that the "type" of a checked object names, or a null pointer if there is none.
[[nodiscard]] const Variant* variant_of(const JsonNode& node, const ObjectSpec& spec);
[[nodiscard]] const KeySpec* find_key(const ObjectSpec& object, const Variant* variant, std::string_view name);

/// Returns the expected value of a key for messages and the reference, for example `a number > 0 (s)`.
[[nodiscard]] std::string expectation(const KeySpec& key);
/// Returns a range in words, for example `>= 0 and <= 180`. Empty if every finite number is allowed.
[[nodiscard]] std::string range_words(const Range& range);
/// Returns the message for a key that the format reserves and this version refuses.
[[nodiscard]] std::string not_built(const std::string& what);

/// Reports everything in the document that the tables do not allow: unknown keys (with the nearest known names), wrong
/// types, values out of range, missing keys and features that are not built yet. Afterwards every refused value is
/// null. A key that can only be a misspelling of one known key gets the name of that key. So later checks can read the
/// rest of the document and report no mistake twice.
void check_scene(JsonNode& root, Diagnostics& diagnostics);

/// Sets the members of `object` from a checked JSON object. `object` is a struct whose members these keys set.
void read_members(const JsonNode& node, const std::vector<KeySpec>& keys, void* object);

struct NamedObject;

/// Read access to a checked object. Refused values count as absent, so the struct keeps its defaults. Nobody sees these
/// defaults, because the scene is refused as a whole.
class ObjectView {
public:
    /// node: an object, or null (then every key is absent). path: for messages.
    ObjectView(const JsonNode& node, const ObjectSpec& spec, std::string path);

    /// Returns the struct that the keys of the object or of its variant set. All other members keep their defaults.
    template <class Struct>
    [[nodiscard]] Struct read() const {
        Struct result = Struct();
        read_into(result);
        return result;
    }
    /// Sets the members whose keys are present.
    template <class Struct>
    void read_into(Struct& object) const {
        read_members(*node_, keys_for(typeid(Struct)), &object);
    }

    /// Returns true if the object is absent or was refused.
    [[nodiscard]] bool is_absent() const { return node_->object() == nullptr; }
    [[nodiscard]] bool has(std::string_view key) const { return value(key) != nullptr; }
    /// Returns the value of a key, or a null node if it is absent.
    [[nodiscard]] const JsonNode& node(std::string_view key) const;
    /// Returns a name or a path. Empty if the key is absent.
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] ObjectView object(std::string_view key) const;
    /// Returns the objects of a list.
    [[nodiscard]] std::vector<ObjectView> objects(std::string_view key) const;
    /// Returns the objects of a table with their names.
    [[nodiscard]] std::vector<NamedObject> named_objects(std::string_view key) const;

    /// Returns the name of the variant. Empty if it was refused.
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

/// One object of a table, with its name.
struct NamedObject {
    std::string name;
    SourceLocation name_location;
    ObjectView view;
};

/// Version of the scene format: the value of the key "ricochet".
inline constexpr unsigned kSceneVersion = 1;

}  // namespace ricochet::detail
