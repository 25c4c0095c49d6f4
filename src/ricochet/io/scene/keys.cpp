#include "ricochet/io/scene/keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "ricochet/io/scene/diagnostics.h"
#include "ricochet/io/scene/fields.h"

namespace ricochet::detail {
namespace {

const JsonNode kAbsent{};

// Returns the entry with a name, or a null pointer.
template <class Entry>
const Entry* find_named(const std::vector<Entry>& entries, std::string_view name) {
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const Entry& e) { return e.name == name; });
    return found == entries.end() ? nullptr : &*found;
}

std::string number_words(const KeySpec& key, std::string_view noun) {
    std::string words(noun);
    if (key.range.lower == key.range.upper) return fmt::format("{}", key.range.lower);
    if (const std::string range = range_words(key.range); !range.empty()) words += " " + range;
    if (!key.unit.empty()) words += fmt::format(" ({})", key.unit);
    return words;
}

std::string vector_words(const KeySpec& key) {
    std::string words = "[x, y, z]";
    if (key.not_zero) words += ", not all zero";
    if (const std::string range = range_words(key.range); !range.empty()) words += ", each " + range;
    if (!key.unit.empty()) words += fmt::format(" ({})", key.unit);
    return words;
}

std::string two_words(const KeySpec& key) {
    std::string words = "[a, b]";
    if (const std::string range = range_words(key.range); !range.empty()) words += ", each " + range;
    if (!key.unit.empty()) words += fmt::format(" ({})", key.unit);
    return words;
}

std::string pair_words(const KeySpec& key) {
    std::string words = number_words(key, "a number") + " or [mean, spread] with spread >= 0";
    if (const std::string low = range_words(key.low_end); !low.empty()) words += " and mean - spread " + low;
    return words;
}

std::string choice_words(const KeySpec& key) {
    std::vector<std::string_view> names;
    for (const Choice& choice : key.choices) names.push_back(choice.name);
    return names.size() == 1 ? quoted_list(names) : "one of " + quoted_list(names);
}

}  // namespace

std::vector<const KeySpec*> keys_of(const ObjectSpec& object, const Variant* variant) {
    std::vector<const KeySpec*> keys;
    for (const KeySpec& key : object.keys) keys.push_back(&key);
    if (variant != nullptr) {
        for (const KeySpec& key : variant->keys) keys.push_back(&key);
    }
    return keys;
}

const Variant* variant_of(const JsonNode& node, const ObjectSpec& spec) {
    const JsonNode* type = node.find("type");
    if (type == nullptr && node.object() != nullptr) return find_named(spec.variants, spec.default_type);
    if (type == nullptr || type->text() == nullptr) return nullptr;
    return find_named(spec.variants, *type->text());
}

const KeySpec* find_key(const ObjectSpec& object, const Variant* variant, std::string_view name) {
    const KeySpec* common = find_named(object.keys, name);
    return common != nullptr || variant == nullptr ? common : find_named(variant->keys, name);
}

std::string range_words(const Range& range) {
    // A bound of 1e75 is not helpful to readers, so it is omitted. The checker reports values beyond this bound.
    const bool below = range.lower > -kLargestCoordinate;
    const bool above = range.upper < kLargestCoordinate;
    std::string lower = fmt::format("{} {}", range.lower_open ? ">" : ">=", range.lower);
    // The bound 2^64 stands for 2^64 - 1. This largest 64-bit integer has no exact double.
    const std::string upper = range.upper == 0x1p64 ? "18446744073709551615" : fmt::format("{}", range.upper);
    if (below && above) return range.lower == range.upper ? upper : fmt::format("{} and <= {}", lower, upper);
    if (below) return lower;
    return above ? "<= " + upper : "";
}

std::string expectation(const KeySpec& key) {
    switch (key.type) {
        case ValueType::number:
            return number_words(key, "a number");
        case ValueType::integer:
            return number_words(key, "a whole number");
        case ValueType::boolean:
            return "true or false";
        case ValueType::text:
            return key.expected.empty() ? "a text that is not empty" : std::string(key.expected);
        case ValueType::file:
            return "the path of a file";
        case ValueType::choice:
            return choice_words(key);
        case ValueType::integers:
            return "a list of whole numbers, at least one";
        case ValueType::vector:
            return vector_words(key);
        case ValueType::two_numbers:
            return two_words(key);
        case ValueType::scale:
            return fmt::format("a number {} 0, or three in [x, y, z]", key.range.lower_open ? "above" : "other than");
        case ValueType::pair:
            return pair_words(key);
        case ValueType::drawn:
            return pair_words(key) + ", or a distribution {\"type\": ...}";
        case ValueType::object:
            return fmt::format("an object {{...}} ({})", key.content->title);
        case ValueType::named_object:
            return fmt::format("an object {{...}} ({}), or one of the names in \"{}\"", key.content->title, key.table);
        case ValueType::list:
            if (key.least == 0) return "a list [...] of objects";
            return key.least == 1 ? "a list [...] of objects, at least one"
                                  : fmt::format("a list [...] of objects, at least {}", key.least);
        case ValueType::list_or_file:
            return "a list [...] of objects, or {\"file\": ...}";
        case ValueType::table:
            return fmt::format("an object {{\"name\": {{...}}}} ({} by name)", key.content->title);
        case ValueType::text_table:
            return "an object {\"name\": \"text\"}";
        case ValueType::quantity:
            return "a number or [x, y, z]";
        case ValueType::vector_pair:
            return "[x, y, z] or [[x, y, z], [spread, spread, spread]], each " + range_words(key.range);
        case ValueType::quantity_table:
            return "an object {\"name\": value}, a value being a number, [mean, spread], [x, y, z] or [[x, y, z], "
                   "[spread, spread, spread]]";
    }
    return "";
}

// Functions that read checked objects.

void read_members(const JsonNode& node, const std::vector<KeySpec>& keys, void* object) {
    for (const KeySpec& key : keys) {
        const JsonNode* value = node.find(key.name);
        if (key.read && value != nullptr && !value->is_null()) key.read(object, *value);
    }
}

ObjectView::ObjectView(const JsonNode& node, const ObjectSpec& spec, std::string path)
    : node_(&node), spec_(&spec), variant_(variant_of(node, spec)), path_(std::move(path)) {}

const JsonNode* ObjectView::value(std::string_view key) const {
    const JsonNode* found = node_->find(key);
    return found == nullptr || found->is_null() ? nullptr : found;
}

bool ObjectView::is_complete() const {
    const std::vector<const KeySpec*> keys = keys_of(*spec_, variant_);
    if (std::any_of(keys.begin(), keys.end(), [&](const KeySpec* key) { return key->required && !has(key->name); })) {
        return false;
    }
    if (variant_ == nullptr || variant_->exactly_one_of.empty()) return true;
    const auto& names = variant_->exactly_one_of;
    return std::count_if(names.begin(), names.end(), [&](std::string_view name) { return has(name); }) == 1;
}

const std::vector<KeySpec>& ObjectView::keys_for(const std::type_info& target) const {
    if (*spec_->target == target) return spec_->keys;
    if (variant_ != nullptr && *variant_->target == target) return variant_->keys;
    throw std::logic_error("no keys of the table set this struct: " + std::string(spec_->title));
}

const KeySpec& ObjectView::container(std::string_view key) const {
    const KeySpec* spec = find_key(*spec_, variant_, key);
    if (spec == nullptr || spec->content == nullptr) {
        throw std::logic_error("no such object in the table: " + std::string(key));
    }
    return *spec;
}

const JsonNode& ObjectView::node(std::string_view key) const {
    const JsonNode* found = value(key);
    return found == nullptr ? kAbsent : *found;
}

std::string ObjectView::text(std::string_view key) const {
    const std::string* found = node(key).text();
    return found == nullptr ? std::string() : *found;
}

ObjectView ObjectView::object(std::string_view key) const { return {node(key), *container(key).content, path_of(key)}; }

std::vector<ObjectView> ObjectView::objects(std::string_view key) const {
    std::vector<ObjectView> views;
    const JsonNode::Array* items = node(key).array();
    if (items == nullptr) return views;
    const ObjectSpec& spec = *container(key).content;
    for (std::size_t i = 0; i < items->size(); ++i) {
        views.emplace_back((*items)[i], spec, path_of_item(path_of(key), i));
    }
    return views;
}

std::vector<NamedObject> ObjectView::named_objects(std::string_view key) const {
    std::vector<NamedObject> objects;
    const JsonNode::Object* members = node(key).object();
    if (members == nullptr) return objects;
    const ObjectSpec& spec = *container(key).content;
    for (const JsonMember& member : *members) {
        objects.push_back(
            {member.key, member.key_location, {member.value, spec, path_of_key(path_of(key), member.key)}});
    }
    return objects;
}

const SourceLocation& ObjectView::location_of(std::string_view key) const {
    const JsonNode* found = node_->find(key);
    return found == nullptr ? node_->location : found->location;
}

std::string ObjectView::path_of(std::string_view key) const { return path_of_key(path_, key); }

// Formats of members by type.

void Format<double>::read(const JsonNode& node, const KeySpec& /*key*/, double& value) {
    value = node.number().value_or(value);
}
std::string Format<double>::text(const KeySpec& /*key*/, double value) {
    if (!std::isfinite(value)) return "";
    std::string text = fmt::format("{}", value);
    // Shortens 1e-09 to 1e-9.
    if (const std::size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
    return text;
}

void Format<bool>::read(const JsonNode& node, const KeySpec& /*key*/, bool& value) {
    if (const bool* truth = std::get_if<bool>(&node.value)) value = *truth;
}
std::string Format<bool>::text(const KeySpec& /*key*/, bool value) { return value ? "true" : "false"; }

void Format<std::string>::read(const JsonNode& node, const KeySpec& /*key*/, std::string& value) {
    if (const std::string* text = node.text()) value = *text;
}
std::string Format<std::string>::text(const KeySpec& /*key*/, const std::string& value) {
    return value.empty() ? "" : fmt::format("\"{}\"", value);
}

void Format<Vec3>::read(const JsonNode& node, const KeySpec& /*key*/, Vec3& value) {
    if (const auto all = node.number()) value = {*all, *all, *all};
    const JsonNode::Array* items = node.array();
    for (std::size_t axis = 0; items != nullptr && axis < 3; ++axis) {
        value[static_cast<int>(axis)] = (*items)[axis].number().value_or(0.0);
    }
}
std::string Format<Vec3>::text(const KeySpec& key, const Vec3& value) {
    if (key.type == ValueType::scale) return fmt::format("{}", value.x);
    return fmt::format("[{}, {}, {}]", value.x, value.y, value.z);
}

void Format<std::array<double, 2>>::read(const JsonNode& node, const KeySpec& /*key*/, std::array<double, 2>& value) {
    const JsonNode::Array* items = node.array();
    for (std::size_t k = 0; items != nullptr && k < value.size(); ++k) value[k] = (*items)[k].number().value_or(0.0);
}
std::string Format<std::array<double, 2>>::text(const KeySpec& /*key*/, const std::array<double, 2>& value) {
    return fmt::format("[{}, {}]", value[0], value[1]);
}

void Format<MeanSpread>::read(const JsonNode& node, const KeySpec& /*key*/, MeanSpread& value) {
    if (const auto mean = node.number()) value = {*mean, 0.0};
    if (const JsonNode::Array* items = node.array()) {
        value = {(*items)[0].number().value_or(0.0), (*items)[1].number().value_or(0.0)};
    }
}
std::string Format<MeanSpread>::text(const KeySpec& key, const MeanSpread& value) {
    return Format<double>::text(key, value.mean);
}

void set_option(KeySpec& key, Rule rule) {
    key.required = key.required || rule == Rule::required;
    key.not_zero = key.not_zero || rule == Rule::not_zero;
    if (rule == Rule::not_empty) key.least = std::max<std::size_t>(key.least, 1);
    if (rule == Rule::two_or_more) key.least = 2;
}

}  // namespace ricochet::detail
