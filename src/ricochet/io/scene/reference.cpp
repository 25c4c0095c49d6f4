// The reference of the scene format in Markdown, made from the table of keys.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "ricochet/io/scene.h"
#include "ricochet/io/scene/context.h"

namespace ricochet {
namespace {

using detail::KeySpec;
using detail::ObjectSpec;
using detail::ValueType;
using detail::Variant;

constexpr const char* kIntroduction = R"(# The scene file

This page is made by the program (`ricochet schema --markdown`) from the table that the reader uses.

A scene is JSON with `//` and `/* */` comments, all quantities in SI units. Paths are relative to the scene file. Keys
that are not listed here are errors, and so are keys that appear twice, values out of range, and files that are not
there; `ricochet check SCENE` reports all of them at once, each with line, column and path
(`scene.json:12:15: colliders[1].file: ...`) and the nearest known name. `ricochet schema` prints a JSON Schema for
editors (it is also in `docs/scene.schema.json`; a scene may name it with the key `$schema`).

    {
      "ricochet": 1,
      "simulation": {"time_step": 0.01, "duration": 4, "seed": 7},
      "forces": [{"type": "gravity", "acceleration": [0, 0, -9.81]}],
      "materials": {"rubber": {"restitution": 0.8, "friction": 0.3}},
      "colliders": [{"name": "floor", "type": "plane", "point": [0, 0, 0], "normal": [0, 0, 1], "material": "rubber"}],
      "emitters": [{"type": "disk", "center": [0, 0, 3], "normal": [0, 0, -1], "radius": 0.5,
                    "rate": [2000, 200], "speed": [3, 0.5], "lifetime": [4, 1]}]
    }

Conventions: [x, y, z] is a point or a vector. Where a number or [mean, spread] is allowed, the pair means values
uniform between mean - spread and mean + spread. No coordinate, length or speed may exceed 1e75.
Particles are points of mass 1 kg unless told otherwise; ids are given in the order of creation, explicit particles
first. The births of an emitter depend on the seed and on the emitter alone, never on the time step: the burst is born
at `start`, birth k (from 0) when the integral of the rate passes k + 1/2.
)";

constexpr const char* kTables = R"(
## Particle tables

`"particles": {"file": "start.csv"}` names a file of comma-separated values. Its first line names the columns: `x`, `y`
and `z` must be there, `vx`, `vy`, `vz`, `mass` and `radius` may (0, 1 kg and 0 otherwise), in any order; further columns
are attributes that the scene declares (`name`, or `name_x`, `name_y`, `name_z`) and `color_x`, `color_y`, `color_z`,
`opacity` and `size`. Every other line is a particle. The final state that a run writes with `--output-state` can be read back; its columns `id`, `age`,
`contacts`, `resting` and `unsimulated_time` are not used, and a warning says so.

## Changes from the command line

`ricochet run` and `ricochet check` take `--set PATH=VALUE`, as often as wanted, applied in order before anything is
checked: `--set simulation.time_step=0.001`, `--set colliders[0].scale=[1,2,1]`,
`--set 'materials["old rubber"].friction=0.2'`. VALUE is JSON; what is not JSON is a text
(`--set simulation.integrator=ballistic`). Keys that are not there are added, list items must exist.
)";

std::string default_words(const KeySpec& key) {
    if (key.required) return "required";
    if (!key.default_value.empty()) return fmt::format("`{}`", key.default_value);
    return key.without.empty() ? "" : std::string(key.without);
}

// A vertical bar would end a table cell.
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
        if (!key.built) continue;
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
        text += " must be there.\n";
    }
    text += key_table(variant.keys);
    for (const KeySpec& key : variant.keys) {
        if (key.type != ValueType::list || key.content == nullptr) continue;
        text += fmt::format("\nEach of `{}`: {}\n{}", key.name, key.content->description, key_table(key.content->keys));
    }
    return text;
}

// Objects within an object that only it has.
std::string nested_sections(const std::string& heading, const std::vector<KeySpec>& keys) {
    std::string text;
    for (const KeySpec& key : keys) {
        // Turns have a section of their own.
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
        text += "The key `type` says which kind.\n";
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

void append_not_built(const std::string& where, const std::vector<KeySpec>& keys, std::string& text) {
    for (const KeySpec& key : keys) {
        if (!key.built) text += fmt::format("- {}`{}`\n", where, key.name);
    }
}

std::string not_built_section() {
    std::string text =
        "\n## Not built yet\n\nThese belong to the format; this version refuses them by name and never ignores "
        "them:\n\n";
    for (const KeySpec& key : detail::scene_spec().keys) {
        if (key.content == nullptr) continue;
        const std::string where = fmt::format("`{}` ", key.name);
        append_not_built(where, key.content->keys, text);
        for (const Variant& variant : key.content->variants) append_not_built(where, variant.keys, text);
    }
    return text + "- `particles` from .ply and .vtp files\n";
}

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
    text += object_section("curve", detail::number_curve_spec());
    text += object_section("vector curve", detail::vector_curve_spec());
    return text + kTables + not_built_section();
}

}  // namespace ricochet
