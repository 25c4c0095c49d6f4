#include "inspect/scene_schema.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "ricochet/io/scene/context.h"

namespace ricochet {

namespace {

using detail::KeySpec;
using detail::ObjectSpec;
using detail::ValueType;
using detail::Variant;
using Json = nlohmann::ordered_json;

// Returns a bound of a range as JSON; whole numbers become integers. The value 2^64 stands for the largest seed, 2^64 -
// 1.
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

// Returns the schema of a number, a vector, or a pair [mean, spread] of two numbers or two vectors.
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
    if (key.least > 0) schema["minItems"] = key.least;
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
        case ValueType::two_numbers:
            return two_of(number_schema(key.range));
        case ValueType::scale:
            return scale_schema(key);
        case ValueType::pair:
            return pair_schema(key);
        case ValueType::drawn: {
            Json schema = pair_schema(key);
            schema["oneOf"].push_back(reference_to(*key.content));
            return schema;
        }
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
        if (variant->name == spec.default_type) {
            properties["type"]["default"] = variant->name;
        } else {
            required.push_back("type");
        }
    }
    for (const KeySpec* key : keys_of(spec, variant)) {
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

// Adds the definitions of all objects that this object contains, at any depth.
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

// The Markdown reference.

namespace {

using detail::KeySpec;
using detail::ObjectSpec;
using detail::ValueType;
using detail::Variant;

constexpr const char* kIntroduction = R"(# The scene file

`ricochet schema --markdown` generates this page from the table that the reader uses.

A scene is JSON with `//` and `/* */` comments. All quantities are in SI units. Paths are relative to the scene file.
Unknown keys, duplicate keys, values out of range and missing files are errors. `ricochet check SCENE` reports all
errors at once. Each error has a line, a column and a path (`scene.json:12:15: colliders[1].file: ...`) and suggests the
nearest known name. `ricochet schema` prints a JSON Schema for editors. It is also in `docs/scene.schema.json`, and a
scene can name it with the key `$schema`.

    {
      "ricochet": 1,
      "simulation": {"time_step": 0.01, "duration": 4, "seed": 7},
      "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
      "materials": {"rubber": {"restitution": 0.8, "friction": 0.3}},
      "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "rubber"}],
      "emitters": [{"type": "disk", "center": [0, 0, 3], "normal": [0, 0, -1], "radius": 0.5,
                    "rate": [2000, 200], "speed": [3, 0.5], "lifetime": [4, 1]}]
    }

Conventions: [x, y, z] is a point or a vector. If a number or [mean, spread] is allowed, the pair means uniform values
between mean - spread and mean + spread. No coordinate, length or speed may exceed 1e75. Particles are points with a
mass of 1 kg by default. Ids follow the order of creation, and explicit particles come first. The births of an emitter
depend only on the seed and the emitter, not on the time step. The burst is born at `start`. Birth k (from 0) happens
when the integral of the rate passes k + 1/2.
)";

constexpr const char* kTables = R"(
## Particle tables

`"particles": {"file": "start.csv"}` names a file of comma-separated values. Its first line names the columns, in any
order. `x`, `y` and `z` are required. Optional columns, with their defaults, are:

- `vx`, `vy`, `vz`, `radius`, `spin_x`, `spin_y` and `spin_z`: 0
- `mass`: 1 kg
- `lifetime`: for ever, as for `inf` or an empty cell
- attributes that the scene declares (`name`, or `name_x`, `name_y`, `name_z`)
- `color_x`, `color_y`, `color_z`, `opacity` and `size`

Every other line is a particle. The final state that a run writes with `--output-state` can be read back. Its `lifetime`
is the remaining lifetime. Its columns `id`, `age`, `contacts`, `resting` and `unsimulated_time` are ignored with a
warning.

## Warnings

`ricochet check` prints one line for each setting that can run but is probably a mistake. Its exit code stays 0. It
warns of:

- particles that start inside a mesh that is closed except for small holes (openings of cups and funnels are not holes)
- particles of which some start inside a closed collider and some outside
- closed meshes with overlapping shells
- spheres that overlap at birth
- emitters that find few positions off the surfaces
- spheres wider than the narrowest opening of a funnel below them
- radii below 1000 units in the last place of the coordinates
- children at impacts, a response or a contact log without a collider
- penalty sub-steps and spring steps beyond their stability bounds
- meshes larger than 200 m (STL: 20 m) or smaller than 1 mm without a stated `scale`
- `bounds` that exclude start positions of particles

`run` gives the last two warnings as well. The check examines 256 draws of each emitter, at the start of its births, and
up to 2000 explicit particles.

## Memory

A scene that needs more memory than is available is refused before it allocates any. The message is one line and names
the key with the largest share (exit code 2). The estimate includes particles of bursts, and of rates over their times
and lifetimes. It also includes explicit particles, ropes and cloth, tables, grids, meshes and the contact log.

`ricochet check` prints the estimate, which is close to the peak of a run, in units of 1000. It assumes:

- 380 bytes per particle, and 80 more with `run --verify`
- if springs join particles, 800 bytes per particle and 200 per spring, and four times as much with `implicit_euler`
- 456 bytes per triangle

Particles that `bounds`, absorbing surfaces or shattering can retire count for one step of their rate only, because
their number is unknown. The number of children is unknown, too. If births exceed the memory, the run ends with one line
(exit code 1). The available memory is the smallest of these limits: the rest of the control group of the process, the
rest of `ulimit -v` and `ulimit -d`, and the available memory of the machine with its swap.

`simulation.most_particles` (100 million by default) is a separate limit. Births beyond it are refused and counted, the
same ones on every machine. A larger `burst` gives a warning, and a larger number of explicit particles an error.

## Changes from the command line

`ricochet run` and `ricochet check` accept `--set PATH=VALUE` any number of times. They apply the changes in order
before all checks: `--set simulation.time_step=0.001`, `--set colliders[0].scale=[1,2,1]`,
`--set 'materials["old rubber"].friction=0.2'`. VALUE is JSON. Any other value is a text
(`--set simulation.integrator=ballistic`). Missing keys are added, but list items must exist.
)";

std::string default_words(const KeySpec& key) {
    if (key.required) return "required";
    if (!key.default_value.empty()) return fmt::format("`{}`", key.default_value);
    return key.without.empty() ? "" : std::string(key.without);
}

// Escapes vertical bars in the text of a table cell, because a bar would end the cell.
std::string cell(const std::string& text) {
    std::string result;
    for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
    return result;
}

std::string meaning(const KeySpec& key) {
    std::string text(key.description);
    for (const detail::Choice& choice : key.choices) {
        text += fmt::format(" `{}`: {}.", choice.name, choice.description);
    }
    if (!key.needs.empty()) text += fmt::format(" Only together with `{}`.", key.needs);
    return text;
}

std::string key_table(const std::vector<KeySpec>& keys) {
    std::string text = "\n| Key | Value | Default | Meaning |\n|---|---|---|---|\n";
    for (const KeySpec& key : keys) {
        text += fmt::format("| `{}` | {} | {} | {} |\n", key.name, cell(expectation(key)), cell(default_words(key)),
                            cell(meaning(key)));
    }
    return text;
}

std::string variant_section(const Variant& variant) {
    std::string text = fmt::format("\n### `\"type\": \"{}\"`\n\n{}\n", variant.name, variant.description);
    if (!variant.exactly_one_of.empty()) {
        text += "Exactly one of";
        for (const std::string_view name : variant.exactly_one_of) {
            text += fmt::format("{} `{}`", name == variant.exactly_one_of.front() ? "" : " and", name);
        }
        text += " must be present.\n";
    }
    text += key_table(variant.keys);
    for (const KeySpec& key : variant.keys) {
        if (key.type != ValueType::list || key.content == nullptr) continue;
        text += fmt::format("\nEach of `{}`: {}\n{}", key.name, key.content->description, key_table(key.content->keys));
    }
    return text;
}

// Returns one section for each object that a key contains, except for rotations.
std::string nested_sections(const std::string& heading, const std::vector<KeySpec>& keys) {
    std::string text;
    for (const KeySpec& key : keys) {
        // Many objects contain rotations, so one separate section describes them.
        if (key.type != ValueType::object || key.content == nullptr || key.content == &detail::rotation_spec())
            continue;
        text += fmt::format("\n### `{}.{}`\n\n{}\n", heading, key.name, key.content->description);
        text += key_table(key.content->keys);
    }
    return text;
}

std::string object_section(const std::string& heading, const ObjectSpec& spec) {
    std::string text = fmt::format("\n## {}\n\n{}\n", heading, spec.description);
    if (!spec.variants.empty()) {
        text += "The key `type` selects the kind.";
        if (!spec.default_type.empty()) text += fmt::format(" Its default is `{}`.", spec.default_type);
        text += "\n";
        if (!spec.keys.empty()) text += "\nKeys of every kind:\n";
    }
    if (!spec.keys.empty()) text += key_table(spec.keys);
    text += nested_sections(heading, spec.keys);
    for (const Variant& variant : spec.variants) text += variant_section(variant);
    return text;
}

std::string heading_of(const KeySpec& key) {
    switch (key.type) {
        case ValueType::list:
        case ValueType::list_or_file:
            return fmt::format("{} (a list)", key.name);
        case ValueType::table:
            return fmt::format("{} (by name)", key.name);
        default:
            return std::string(key.name);
    }
}

constexpr std::string_view kNotBuilt =
    "\n## Not built yet\n\nThese features belong to the format. This version refuses them by name and never ignores "
    "them:\n\n"
    "- `particles` from .ply and .vtp files\n";

}  // namespace

std::string scene_reference() {
    const ObjectSpec& scene = detail::scene_spec();
    std::string text = kIntroduction;
    text += "\n## The scene\n" + key_table(scene.keys);
    for (const KeySpec& key : scene.keys) {
        if (key.content != nullptr) text += object_section(heading_of(key), *key.content);
    }
    const ObjectSpec& motion = *find_key(detail::frame_spec(), nullptr, "motions")->content;
    text += object_section("rotation", detail::rotation_spec());
    text += object_section("motions of a frame (a list)", motion);
    text += object_section("motion of a collider (a list)", detail::key_pose_spec());
    text += object_section("histogram of a counter (a list)", detail::histogram_spec());
    text += object_section("deformation of a mesh", detail::deformation_spec());
    text += object_section("distribution of a drawn value", detail::distribution_spec());
    text += object_section("cloud of an emitter", detail::cloud_spec());
    text += object_section("drawing of an emitter", detail::drawing_spec());
    text += object_section("curve", detail::number_curve_spec());
    text += object_section("vector curve", detail::vector_curve_spec());
    text += object_section("scale curve", detail::scale_curve_spec());
    return text + kTables + std::string(kNotBuilt);
}

}  // namespace ricochet
