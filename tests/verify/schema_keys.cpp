#include <algorithm>
#include <string>
#include <vector>

#include "verify/schema_scene.h"

namespace ricochet::test {
namespace {

using Json = nlohmann::json;

const Json& resolved(const Json& schema, const Json& rule, std::string& owner) {
    if (!rule.contains("$ref")) return rule;
    owner = rule["$ref"].get<std::string>().substr(8);
    return schema["$defs"][owner];
}

std::string named(const std::string& owner, const Json& rule) {
    if (!rule["properties"].contains("type")) return owner;
    return owner + "(" + rule["properties"]["type"]["const"].get<std::string>() + ")";
}

/// Returns true if a rule is one of several alternatives. Objects also have lists of keys of which one is required.
bool has_alternatives(const Json& rule) { return rule.contains("oneOf") && !rule.contains("properties"); }

/// Returns true if a value may match the rule.
bool fits(const Json& rule, const Json& value) {
    if (rule.contains("$ref")) return value.is_object();
    const std::string type = rule.value("type", "");
    if (type == "object" && value.is_object()) {
        return !rule.contains("properties") || !rule["properties"].contains("type") ||
               rule["properties"]["type"]["const"] == value.value("type", "");
    }
    return (type == "array" && value.is_array()) || (type == "string" && value.is_string());
}

void walk(const Json& schema, const Json& of_value, std::string owner, const Json& value, std::set<std::string>& keys) {
    const Json& rule = resolved(schema, of_value, owner);
    if (has_alternatives(rule)) {
        for (const Json& one : rule["oneOf"]) {
            if (fits(one, value)) return walk(schema, one, owner, value, keys);
        }
        return;
    }
    if (value.is_array() && rule.contains("items")) {
        for (const Json& item : value) walk(schema, rule["items"], owner, item, keys);
    }
    if (!value.is_object()) return;
    for (const auto& [key, of_key] : value.items()) {
        if (rule.contains("properties") && rule["properties"].contains(key)) {
            keys.insert(named(owner, rule) + "." + key);
            walk(schema, rule["properties"][key], owner, of_key, keys);
        } else if (rule.contains("additionalProperties") && rule["additionalProperties"].is_object()) {
            walk(schema, rule["additionalProperties"], owner, of_key, keys);
        }
    }
}

void add_all(const Json& rule, const std::string& owner, std::set<std::string>& keys) {
    for (const Json& one : has_alternatives(rule) ? rule["oneOf"] : Json::array({rule})) {
        for (const auto& [key, unused] : one["properties"].items()) keys.insert(named(owner, one) + "." + key);
    }
}

}  // namespace

std::vector<std::string> names_of(const std::string& owner, const std::string& key) {
    if (key == "flows") return {"w0", "w1"};
    if (key == "frames") return {"f0", "f1"};
    if (key == "group_materials") return {"side"};
    if (key == "vector_attributes") return {"tag"};
    if (key == "attributes" && owner == "curves_over_life") return {"temperature"};
    if (key == "attributes") return {"temperature", "charge", "tag"};
    if (owner == "particle_contacts") return {"a", "b"};
    return {"m0", "m1", "m2"};
}

void add_keys(const Json& schema, const Json& scene, std::set<std::string>& keys) {
    walk(schema, schema, "scene", scene, keys);
}

std::string reason_not_drawn(const std::string& key) {
    for (const char* const owner : {"camera.", "picture.", "drawing.", "stretch.", "collider_looks."}) {
        if (key.starts_with(owner)) return "it is for pictures";
    }
    for (const char* const name : {".camera", ".picture", ".looks", ".drawing"}) {
        if (key.ends_with(name)) return "it is for pictures";
    }
    if (key == "scene.$schema") return "it is for editors";
    const bool is_of_output = key.starts_with("output.") && key != "output.contacts";
    if (is_of_output) return "it selects output files, which are not written here";
    for (const char* const name : {"burst", "frame", "rate_per_area", "rate_per_frame", "start", "stop"}) {
        if (key == std::string("emitter(child).") + name) return "the reader refuses it";
    }
    if (key == "emitter(mesh).up" || key == "springs(cloth).up") return "it rotates a mesh while it is read";
    return {};
}

std::set<std::string> all_keys(const Json& schema) {
    std::set<std::string> keys;
    add_all(schema, "scene", keys);
    for (const auto& [name, rule] : schema["$defs"].items()) add_all(rule, name, keys);
    return keys;
}

}  // namespace ricochet::test
