// The JSON Schema of scene files, made from the table of keys.
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "ricochet/io/scene.h"
#include "ricochet/io/scene/context.h"

namespace ricochet {
namespace {

using detail::KeySpec;
using detail::ObjectSpec;
using detail::Range;
using detail::ValueType;
using detail::Variant;
using Json = nlohmann::ordered_json;

// Whole numbers stand without a fraction; 2^64 stands for the largest seed, one below it.
Json bound(double value) {
    if (value == 0x1p64) return std::numeric_limits<std::uint64_t>::max();
    if (value >= 0.0 && value < 0x1p53 && value == std::floor(value)) return static_cast<std::uint64_t>(value);
    return value;
}

Json number_schema(const Range& range, const char* type = "number") {
    Json schema = {{"type", type}};
    if (std::isfinite(range.lower)) schema[range.lower_open ? "exclusiveMinimum" : "minimum"] = bound(range.lower);
    if (std::isfinite(range.upper)) schema["maximum"] = bound(range.upper);
    return schema;
}

Json three_of(Json item) { return {{"type", "array"}, {"items", std::move(item)}, {"minItems", 3}, {"maxItems", 3}}; }

Json vector_schema(const KeySpec& key) {
    Json schema = three_of(number_schema(key.range));
    if (key.not_zero) schema["not"] = {{"const", {0, 0, 0}}};
    return schema;
}

Json scale_schema(const KeySpec& key) {
    Json factor = number_schema(key.range);
    factor["not"] = {{"const", 0}};
    return {{"oneOf", Json::array({factor, three_of(factor)})}};
}

Json pair_schema(const KeySpec& key) {
    const Json mean = number_schema(key.range);
    const Json spread = number_schema({.lower = 0.0, .upper = key.range.upper});
    const Json pair = {
        {"type", "array"}, {"prefixItems", Json::array({mean, spread})}, {"minItems", 2}, {"maxItems", 2}};
    return {{"oneOf", Json::array({mean, pair})}};
}

Json two_of(Json item) { return {{"type", "array"}, {"items", std::move(item)}, {"minItems", 2}, {"maxItems", 2}}; }

Json quantity_schema(const KeySpec& key) {
    return {{"oneOf", Json::array({number_schema(key.range), vector_schema(key)})}};
}

// A number, a vector, or a pair of two alike, the second of which is a spread.
Json spread_schema(const KeySpec& key) {
    const Range spread{.lower = 0.0, .upper = key.range.upper};
    const auto pair = [](const Json& mean, const Json& width) {
        return Json{{"type", "array"}, {"prefixItems", Json::array({mean, width})}, {"minItems", 2}, {"maxItems", 2}};
    };
    return {{"oneOf", Json::array({number_schema(key.range), vector_schema(key),
                                   pair(number_schema(key.range), number_schema(spread)),
                                   pair(vector_schema(key), three_of(number_schema(spread)))})}};
}

Json text_schema() { return {{"type", "string"}, {"minLength", 1}, {"pattern", "^[^\\u0000-\\u001f\\u007f]*$"}}; }

Json choice_schema(const KeySpec& key) {
    Json names = Json::array();
    for (const detail::Choice& choice : key.choices) names.push_back(choice.name);
    return {{"enum", names}};
}

std::string definition_name(const ObjectSpec& spec) {
    std::string name(spec.title);
    for (char& c : name) c = c == ' ' ? '_' : c;
    return name;
}

Json reference_to(const ObjectSpec& spec) { return {{"$ref", "#/$defs/" + definition_name(spec)}}; }

Json list_schema(const KeySpec& key) {
    Json schema = {{"type", "array"}, {"items", reference_to(*key.content)}};
    if (key.not_empty) schema["minItems"] = 1;
    return schema;
}

Json value_schema(const KeySpec& key) {
    switch (key.type) {
        case ValueType::number:
            return number_schema(key.range);
        case ValueType::integer:
            return number_schema(key.range, "integer");
        case ValueType::boolean:
            return {{"type", "boolean"}};
        case ValueType::text:
        case ValueType::file:
            return text_schema();
        case ValueType::choice:
            return choice_schema(key);
        case ValueType::integers:
            return {{"type", "array"},
                    {"items", number_schema({.lower = 0.0, .upper = 0x1p64}, "integer")},
                    {"minItems", 1}};
        case ValueType::vector:
            return vector_schema(key);
        case ValueType::scale:
            return scale_schema(key);
        case ValueType::pair:
            return pair_schema(key);
        case ValueType::object:
            return reference_to(*key.content);
        case ValueType::named_object:
            return {{"oneOf", Json::array({reference_to(*key.content), text_schema()})}};
        case ValueType::list:
            return list_schema(key);
        case ValueType::list_or_file:
            return {{"oneOf", Json::array({list_schema(key), reference_to(detail::particle_file_spec())})}};
        case ValueType::table:
            return {{"type", "object"},
                    {"propertyNames", {{"minLength", 1}}},
                    {"additionalProperties", reference_to(*key.content)}};
        case ValueType::quantity:
            return quantity_schema(key);
        case ValueType::vector_pair: {
            const Json vector = vector_schema(key);
            return {{"oneOf", Json::array({vector, two_of(vector)})}};
        }
        case ValueType::quantity_table:
            return {{"type", "object"},
                    {"propertyNames", {{"minLength", 1}}},
                    {"additionalProperties", spread_schema(key)}};
        case ValueType::text_table:
            return {{"type", "object"}, {"propertyNames", {{"minLength", 1}}}, {"additionalProperties", text_schema()}};
    }
    return {};
}

Json key_schema(const KeySpec& key) {
    Json schema = {{"description", key.unit.empty() ? std::string(key.description)
                                                    : fmt::format("{} Unit: {}.", key.description, key.unit)}};
    schema.update(value_schema(key));
    if (!key.default_value.empty()) schema["default"] = Json::parse(key.default_value);
    return schema;
}

Json object_schema(const ObjectSpec& spec, const Variant* variant) {
    Json properties = Json::object();
    Json required = Json::array();
    Json needs = Json::object();
    if (variant != nullptr) {
        properties["type"] = {{"const", variant->name}};
        required.push_back("type");
    }
    for (const KeySpec* key : keys_of(spec, variant)) {
        if (!key->built) continue;
        properties[std::string(key->name)] = key_schema(*key);
        if (key->required) required.push_back(key->name);
        if (!key->needs.empty()) needs[std::string(key->name)] = Json::array({key->needs});
    }
    Json schema = {{"description", variant == nullptr ? spec.description : variant->description},
                   {"type", "object"},
                   {"properties", properties},
                   {"additionalProperties", false}};
    if (!required.empty()) schema["required"] = required;
    if (!needs.empty()) schema["dependentRequired"] = needs;
    if (variant != nullptr && !variant->exactly_one_of.empty()) {
        for (const std::string_view name : variant->exactly_one_of) {
            schema["oneOf"].push_back({{"required", Json::array({name})}});
        }
    }
    return schema;
}

Json definition(const ObjectSpec& spec) {
    if (spec.variants.empty()) return object_schema(spec, nullptr);
    Json choices = Json::array();
    for (const Variant& variant : spec.variants) choices.push_back(object_schema(spec, &variant));
    return {{"description", spec.description}, {"oneOf", choices}};
}

// The object and everything inside it.
void add_definitions(const ObjectSpec& spec, Json& definitions) {
    const auto add_contents = [&](const std::vector<KeySpec>& keys) {
        for (const KeySpec& key : keys) {
            if (key.content == nullptr || definitions.contains(definition_name(*key.content))) continue;
            definitions[definition_name(*key.content)] = definition(*key.content);
            add_definitions(*key.content, definitions);
        }
    };
    add_contents(spec.keys);
    for (const Variant& variant : spec.variants) add_contents(variant.keys);
}

}  // namespace

std::string scene_schema() {
    const ObjectSpec& scene = detail::scene_spec();
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"}, {"title", "Ricochet scene"}};
    schema.update(object_schema(scene, nullptr));
    Json definitions = Json::object();
    add_definitions(scene, definitions);
    definitions[definition_name(detail::particle_file_spec())] = definition(detail::particle_file_spec());
    schema["$defs"] = definitions;
    return schema.dump(2) + "\n";
}

}  // namespace ricochet
