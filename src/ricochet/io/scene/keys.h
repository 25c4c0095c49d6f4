/// \file
/// Descriptions of scene keys, the check of a document against them, and access to checked objects.
#pragma once

#include <cstddef>
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
    two_numbers,     ///< [a, b]
    scale,           ///< a number or [x, y, z]; no component is zero
    pair,            ///< a number, or [mean, spread] for a uniform distribution from mean - spread to mean + spread
    drawn,           ///< a pair, or an object of KeySpec::content: a distribution
    object,          ///< an object of KeySpec::content
    named_object,    ///< an object of KeySpec::content, or the name of an object in the table KeySpec::table
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
    long value = 0;  ///< value of the enumerator; unused if the member is a text
};
template <class Enum>
[[nodiscard]] Choice choice(Enum value, std::string_view name, std::string_view description) {
    return {name, description, static_cast<long>(value)};
}
/// Returns the choice for an enumerator. Its name is that of name_of().
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
    Range range = {};                ///< allowed values of numbers, vector components and means of pairs
    Range low_end = {};              ///< allowed values of mean - spread of a pair
    std::string default_value = {};  ///< default as JSON text; empty if there is no default
    std::string_view without = {};   ///< meaning of an absent key, if no JSON value expresses it
    bool required = false;
    bool not_zero = false;           ///< for vectors: at least one component must not be zero
    std::size_t least = 0;           ///< for lists: smallest number of objects
    std::string_view needs = {};     ///< key that must also be present
    std::string_view expected = {};  ///< for texts: description of the expected text, for messages
    std::vector<Choice> choices = {};
    const ObjectSpec* content = nullptr;
    std::string_view table = {};  ///< for ValueType::named_object: key of the scene with the named objects
    /// Sets the member of an object to a checked value. Empty for keys that the builder of the object reads.
    std::function<void(void* object, const JsonNode& value)> read = {};
};

/// One value of "type", with the keys of objects of this type.
struct Variant {
    std::string_view name;
    std::string_view description;
    std::vector<KeySpec> keys;
    std::vector<std::string_view> exactly_one_of = {};  ///< exactly one of these keys must be present
    const std::type_info* target = &typeid(void);       ///< type of the struct whose members the keys set
};

/// One kind of object. If there are variants, the key "type" selects one of them. `keys` are common to all variants.
/// `default_type` is the type of objects without this key. It is empty if the key is required.
struct ObjectSpec {
    std::string_view title;  ///< singular noun for messages and headings, for example "collider"
    std::string_view description;
    std::vector<KeySpec> keys;
    std::vector<Variant> variants = {};
    const std::type_info* target = &typeid(void);  ///< type of the struct whose members the keys set
    std::string_view default_type = {};
};

/// Returns the keys of the object and of the variant, in the order of the tables. variant: may be null.
[[nodiscard]] std::vector<const KeySpec*> keys_of(const ObjectSpec& object, const Variant* variant);
/// Returns the variant for the "type" of a checked object, or a null pointer if there is no such variant.
[[nodiscard]] const Variant* variant_of(const JsonNode& node, const ObjectSpec& spec);
[[nodiscard]] const KeySpec* find_key(const ObjectSpec& object, const Variant* variant, std::string_view name);

/// Returns a description of a key's expected value for messages and the reference, for example `a number > 0 (s)`.
[[nodiscard]] std::string expectation(const KeySpec& key);
/// Returns a range in words, for example `>= 0 and <= 180`. Empty if every finite number is allowed.
[[nodiscard]] std::string range_words(const Range& range);

/// Reports everything in the document that the tables do not allow, and replaces every refused value by null. If an
/// unknown key can be a misspelling of only one known key, it gets the name of this key. Later checks can therefore
/// read the rest of the document, and no mistake is reported twice.
void check_scene(JsonNode& root, Diagnostics& diagnostics);

/// Sets the members of a struct from a checked JSON object. object: the struct that `keys` belong to.
void read_members(const JsonNode& node, const std::vector<KeySpec>& keys, void* object);

struct NamedObject;

/// Read access to a checked object. Refused values are treated as absent.
class ObjectView {
public:
    /// node: an object, or null if all keys are absent. path: path of the object for messages.
    ObjectView(const JsonNode& node, const ObjectSpec& spec, std::string path);

    /// Returns a struct whose members are set by the keys of the object or of its variant.
    template <class Struct>
    [[nodiscard]] Struct read() const {
        Struct result = Struct();
        read_into(result);
        return result;
    }
    /// Sets the members of a struct for which keys are present.
    template <class Struct>
    void read_into(Struct& object) const {
        read_members(*node_, keys_for(typeid(Struct)), &object);
    }

    /// Returns true if the object is absent or was refused.
    [[nodiscard]] bool is_absent() const { return node_->object() == nullptr; }
    [[nodiscard]] bool has(std::string_view key) const { return value(key) != nullptr; }
    /// Returns true if all required keys are present, and exactly one of alternative keys. Other cases have already
    /// been reported.
    [[nodiscard]] bool is_complete() const;
    /// Returns the value of a key, or a null node if the key is absent.
    [[nodiscard]] const JsonNode& node(std::string_view key) const;
    /// Returns the text of a key. Empty if the key is absent.
    [[nodiscard]] std::string text(std::string_view key) const;
    [[nodiscard]] ObjectView object(std::string_view key) const;
    /// Return the objects of a list or of a table.
    [[nodiscard]] std::vector<ObjectView> objects(std::string_view key) const;
    [[nodiscard]] std::vector<NamedObject> named_objects(std::string_view key) const;

    /// Returns the name of the variant. Empty if the key "type" was refused.
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
