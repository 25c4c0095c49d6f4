// Attributes and appearance of particles, and their curves over life.

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <span>
#include <utility>

#include "ricochet/core/printable.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

// A key for the appearance of emitters and particles, with the attribute column that it sets.
struct Look {
    std::string_view key;
    std::string_view column;
};
constexpr Look kEmitterLooks[] = {
    {"color", kColorAttribute}, {"opacity", kOpacityAttribute}, {"particle_size", kSizeAttribute}};
// Keys of explicit particles, and of curves over life.
constexpr Look kParticleLooks[] = {
    {"color", kColorAttribute}, {"opacity", kOpacityAttribute}, {"size", kSizeAttribute}};

const ObjectSpec& life_curves_spec() {
    static const ObjectSpec spec = object<Unbound>(
        "curves over life",
        "Factors that multiply the values of a particle at birth as it ages. They are evaluated when a state is "
        "written and never stored. In `over_life` the `time` of a key is the elapsed fraction of the lifetime, from 0 "
        "to 1. In `over_age` it is the age in s.",
        {{"color", ValueType::object, "Factors of the colour, for red, green and blue.", &vector_curve_spec()},
         {"opacity", ValueType::object, "Factor of the opacity.", &number_curve_spec()},
         {"size", ValueType::object, "Factor of the drawn size.", &number_curve_spec()},
         {"attributes", ValueType::table,
          "Curves of factors for attributes with one component. The keys are the names of the attributes.",
          &number_curve_spec()},
         {"vector_attributes", ValueType::table,
          "Curves of factors for attributes with three components. The keys are the names of the attributes.",
          &vector_curve_spec()}});
    return spec;
}

const AttributeDescription* find_declared(const SimulationSetup& setup, std::string_view name) {
    const auto found = std::find_if(setup.attributes.begin(), setup.attributes.end(),
                                    [&](const AttributeDescription& attribute) { return attribute.name == name; });
    return found == setup.attributes.end() ? nullptr : &*found;
}

// Returns the user-declared attribute with this name. Returns a null pointer after reporting an error if there is none.
const AttributeDescription* declared(const SceneContext& context, const SimulationSetup& setup,
                                     const SourceLocation& location, const std::string& path, const std::string& name) {
    const AttributeDescription* found = find_declared(setup, name);
    if (found != nullptr && !looks_attribute(name)) return found;
    std::vector<std::string_view> names;
    for (const AttributeDescription& attribute : setup.attributes) {
        if (!looks_attribute(attribute.name)) names.push_back(attribute.name);
    }
    context.diagnostics().error(location, path, unknown_name("attribute", name, names));
    return nullptr;
}

// Declares the attributes of the appearance keys that an object has.
void declare_used(const ObjectView& view, std::span<const Look> looks, SimulationSetup& setup) {
    for (const Look& look : looks) {
        if (!view.has(look.key) || find_declared(setup, look.column) != nullptr) continue;
        setup.attributes.push_back(*looks_attribute(look.column));
    }
}

// Returns the value of a node with the given number of components. Returns nothing if the node has another form.
std::optional<Vec3> value_of(const JsonNode& node, int components) {
    const bool is_vector = components == 3;
    const JsonNode::Array* items = node.array();
    if (is_vector && (items == nullptr || items->size() != 3)) return std::nullopt;
    Vec3 value;
    for (int axis = 0; axis < components; ++axis) {
        const auto number = (is_vector ? (*items)[static_cast<std::size_t>(axis)] : node).number();
        if (!number) return std::nullopt;
        value[axis] = *number;
    }
    return value;
}

// Returns mean and spread of a node: a single value, or a pair [mean, spread] of values, as in value_of().
std::optional<AttributeSpread> spread_of(const JsonNode& node, int components) {
    if (const auto value = value_of(node, components)) return AttributeSpread{{}, *value, {}};
    const JsonNode::Array* items = node.array();
    if (items == nullptr || items->size() != 2) return std::nullopt;
    const auto mean = value_of((*items)[0], components);
    const auto spread = value_of((*items)[1], components);
    if (!mean || !spread) return std::nullopt;
    return AttributeSpread{{}, *mean, *spread};
}

std::string shape_words(int components, bool spread) {
    if (components == 1) return spread ? "a number or [mean, spread]" : "a number";
    return spread ? "[x, y, z] or [[x, y, z], [spread, spread, spread]]" : "[x, y, z]";
}

/// Returns true if the name is that of a component of this vector attribute in tables, for example "wind_x".
bool is_column_of(const AttributeDescription& vector, const std::string& name) {
    return vector.components == 3 && name.size() == vector.name.size() + 2 && name.starts_with(vector.name) &&
           (name.ends_with("_x") || name.ends_with("_y") || name.ends_with("_z"));
}

/// Returns the reason why an attribute's name is invalid or conflicts with other attributes. Empty if the name is
/// valid.
std::string name_problem(const AttributeDescription& attribute, const std::vector<AttributeDescription>& others) {
    if (!is_column_name(attribute.name)) {
        return "the name has control characters, commas or quotes, expected that of a column";
    }
    if (is_own_array(attribute.name) || looks_attribute(attribute.name)) {
        return "the name is one of the particles' own, expected another one";
    }
    for (const AttributeDescription& other : others) {
        if (!is_column_of(other, attribute.name) && !is_column_of(attribute, other.name)) continue;
        return fmt::format("the attribute and \"{}\" would share a column of tables, expected another name",
                           other.name);
    }
    return {};
}

void build_declared(const SceneContext& context, const NamedObject& named, SimulationSetup& setup) {
    const ObjectView& view = named.view;
    auto attribute = view.read<AttributeDescription>();
    attribute.name = named.name;
    if (const std::string problem = name_problem(attribute, setup.attributes); !problem.empty()) {
        context.diagnostics().error(named.name_location, view.path(), problem);
        return;
    }
    if (attribute.components != 3 && attribute.components != 1) {
        context.error(view, "components", fmt::format("found {}, expected 1 or 3", attribute.components));
        attribute.components = 1;
    }
    if (view.has("default")) {
        const auto value = value_of(view.node("default"), attribute.components);
        if (!value) {
            context.error(view, "default",
                          fmt::format("found {}, expected {} for {} components", described(view.node("default")),
                                      shape_words(attribute.components, false), attribute.components));
        }
        attribute.fallback = value.value_or(Vec3{});
    }
    setup.attributes.push_back(std::move(attribute));
}

/// Declares an attribute that contains numbers of the named things. Reports a scene that declares it by itself.
void declare_number(const SceneContext& context, SimulationSetup& setup, std::string_view name, const char* things) {
    if (find_declared(setup, name) == nullptr) {
        setup.attributes.push_back({std::string(name), 1, {}});
    } else {
        context.error(
            context.root(), "attributes",
            fmt::format("declares \"{}\", which is the number of one of {} here, expected another name", name, things));
    }
}

/// Declares the material attribute if the scene has several materials for spheres, and the drawing attribute if an
/// emitter has the key "drawing".
void declare_numbers(const SceneContext& context, SimulationSetup& setup) {
    const auto& contacts = setup.options.particle_contacts;
    if (contacts && !contacts->materials.empty()) {
        declare_number(context, setup, kMaterialAttribute, "particle_contacts' materials");
    }
    const std::vector<ObjectView> emitters = context.objects("emitters");
    if (std::any_of(emitters.begin(), emitters.end(), [](const ObjectView& view) { return view.has("drawing"); })) {
        declare_number(context, setup, kDrawingAttribute, "the emitters' drawings");
    }
}

LifeCurve life_curve(const SceneContext& context, const ObjectView& view, std::string name, bool is_vector,
                     bool of_lifetime) {
    if (is_vector) return {std::move(name), vector_curve_of(view, context.diagnostics()), of_lifetime};
    const KeyedCurve<double> curve = number_curve_of(view, context.diagnostics());
    std::vector<CurveKey<Vec3>> keys;
    for (const CurveKey<double>& key : curve.keys()) keys.push_back({key.time, {key.value, key.value, key.value}});
    return {std::move(name), KeyedCurve<Vec3>(std::move(keys), curve.interpolation(), curve.ends()), of_lifetime};
}

void read_named_curves(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                       int components, bool of_lifetime, EmitterDescription& emitter) {
    for (const NamedObject& named : view.named_objects(components == 3 ? "vector_attributes" : "attributes")) {
        const ObjectView& curve = named.view;
        const auto* attribute = declared(context, setup, named.name_location, curve.path(), named.name);
        if (attribute == nullptr || curve.is_absent()) continue;
        if (attribute->components != components) {
            context.diagnostics().error(
                named.name_location, curve.path(),
                fmt::format("the attribute has {} components, it belongs in \"{}\"", attribute->components,
                            components == 3 ? "attributes" : "vector_attributes"));
        } else {
            emitter.curves.push_back(life_curve(context, curve, named.name, components == 3, of_lifetime));
        }
    }
}

void read_curves(const SceneContext& context, const SimulationSetup& setup, const ObjectView& owner, const char* key,
                 EmitterDescription& emitter) {
    if (!owner.has(key)) return;
    const bool of_lifetime = std::string_view(key) == "over_life";
    const ObjectView view = owner.object(key);
    if (of_lifetime && !owner.has("lifetime")) {
        context.error(owner, key, "only goes together with the key \"lifetime\"; over_age needs none");
    }
    for (const Look& look : kParticleLooks) {
        if (!view.has(look.key)) continue;
        emitter.curves.push_back(
            life_curve(context, view.object(look.key), std::string(look.column), look.key == "color", of_lifetime));
    }
    read_named_curves(context, setup, view, 1, of_lifetime, emitter);
    read_named_curves(context, setup, view, 3, of_lifetime, emitter);
}

// Calls use(attribute, value) for every value of the key "attributes". If use() returns false, the value has the wrong
// number of components and is reported.
template <class Use>
void for_each_attribute(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view, bool spread,
                        const Use& use) {
    const JsonNode::Object* members = view.node("attributes").object();
    if (members == nullptr) return;
    for (const JsonMember& member : *members) {
        const std::string path = path_of_key(view.path_of("attributes"), member.key);
        const auto* attribute = declared(context, setup, member.key_location, path, member.key);
        if (attribute == nullptr || member.value.is_null() || use(*attribute, member.value)) continue;
        context.diagnostics().error(
            member.value.location, path,
            fmt::format("found {}, expected {}", described(member.value), shape_words(attribute->components, spread)));
    }
}

}  // namespace

const ObjectSpec& attribute_spec() {
    static const ObjectSpec spec =
        object<AttributeDescription>("attribute",
                                     "A user-defined value of every particle. It is written to frames. Only forces "
                                     "that read an attribute depend on it, for example `charge`.",
                                     {{"components", &AttributeDescription::components, between(1.0, 3.0), "",
                                       "Number of components: 1, or 3 for a vector."},
                                      {"default", ValueType::quantity, kCoordinate, "",
                                       "Value of particles without a value of their own.", Without{"0"}}});
    return spec;
}

Fields<EmitterDescription> emitter_look_fields() {
    return {{"color", ValueType::vector_pair, kFraction, "",
             "Red, green and blue, 0 to 1 (linear light). Drawn values outside this range are clamped.",
             Without{"[1, 1, 1] if other particles have colours; no column otherwise"}},
            {"opacity", ValueType::pair, kFraction, "",
             "Opacity from 0 (invisible) to 1 (covers everything behind). Drawn values outside this range are clamped.",
             Without{"1 if others have one; no column otherwise"}},
            {"particle_size", ValueType::pair, kLengthOrZero, "m", "Drawn radius. Collisions use `particle_radius`.",
             LowEnd{kNotNegative}, Without{"particle_radius"}},
            {"attributes", ValueType::quantity_table, kCoordinate, "", "Values of the scene's `attributes`, by name.",
             Without{"their defaults"}},
            {"material", ValueType::text, "Material of the particles: a name in `particle_contacts.materials`.",
             Without{"the parent's, else the first"}},
            {"drawing", ValueType::object, "How its particles are drawn.", &drawing_spec(),
             Without{"the parent's, else the one of `picture`"}},
            {"over_life", ValueType::object, "Factors over the lifetime. Keys go from 0 (birth) to 1 (end of life).",
             &life_curves_spec(), Without{"none"}},
            {"over_age", ValueType::object, "Factors over the age in s.", &life_curves_spec(), Without{"none"}}};
}

Fields<Particle> particle_look_fields() {
    return {{"color", ValueType::vector, kFraction, "", "Red, green and blue, 0 to 1 (linear light).",
             Without{"[1, 1, 1] if others have colours"}},
            {"opacity", ValueType::number, kFraction, "", "Opacity from 0 (invisible) to 1 (covers everything behind).",
             Without{"1 if others have one"}},
            {"size", ValueType::number, kLengthOrZero, "m", "Drawn radius.", Without{"its radius"}},
            {"attributes", ValueType::quantity_table, kCoordinate, "",
             "Values of the scene's `attributes`, by name, without a spread.", Without{"their defaults"}},
            {"material", ValueType::text, "Material of the particle: a name in `particle_contacts.materials`.",
             Without{"the first"}}};
}

void build_attributes(const SceneContext& context, SimulationSetup& setup) {
    for (const NamedObject& named : context.root().named_objects("attributes")) build_declared(context, named, setup);
    declare_numbers(context, setup);
    for (const ObjectView& view : context.objects("emitters")) {
        declare_used(view, kEmitterLooks, setup);
        for (const char* const key : {"over_life", "over_age"}) declare_used(view.object(key), kParticleLooks, setup);
    }
    for (const ObjectView& view : context.objects("particles")) declare_used(view, kParticleLooks, setup);
}

void read_looks(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                EmitterDescription& emitter) {
    for (const Look& look : kEmitterLooks) {
        if (!view.has(look.key)) continue;
        AttributeSpread spread =
            spread_of(view.node(look.key), look.key == "color" ? 3 : 1).value_or(AttributeSpread{});
        spread.name = look.column;
        emitter.attributes.push_back(std::move(spread));
    }
    for_each_attribute(context, setup, view, true, [&](const AttributeDescription& attribute, const JsonNode& node) {
        auto spread = spread_of(node, attribute.components);
        if (!spread) return false;
        spread->name = attribute.name;
        emitter.attributes.push_back(std::move(*spread));
        return true;
    });
    if (const auto material = material_of(context, setup, view)) {
        emitter.attributes.push_back({std::string(kMaterialAttribute), *material, {}});
    }
    if (view.has("drawing")) {
        const auto number = static_cast<double>(drawing_number(context, view));
        emitter.attributes.push_back({std::string(kDrawingAttribute), {number, 0.0, 0.0}, {}});
    }
    read_curves(context, setup, view, "over_life", emitter);
    read_curves(context, setup, view, "over_age", emitter);
}

std::vector<AttributeValue> particle_values(const SceneContext& context, const SimulationSetup& setup,
                                            const ObjectView& view) {
    std::vector<AttributeValue> values(setup.attributes.size(), missing_attribute());
    const auto set = [&](const AttributeDescription* column, const Vec3& value) {
        values[static_cast<std::size_t>(column - setup.attributes.data())] = value;
    };
    for (const Look& look : kParticleLooks) {
        if (!view.has(look.key)) continue;
        const auto value = value_of(view.node(look.key), look.key == "color" ? 3 : 1);
        if (value) set(find_declared(setup, look.column), *value);
    }
    for_each_attribute(context, setup, view, false, [&](const AttributeDescription& attribute, const JsonNode& node) {
        const auto value = value_of(node, attribute.components);
        if (value) set(&attribute, *value);
        return value.has_value();
    });
    if (const auto material = material_of(context, setup, view)) {
        set(find_declared(setup, kMaterialAttribute), *material);
    }
    return values;
}

}  // namespace ricochet::detail
