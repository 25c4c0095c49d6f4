// Contacts between spheres: materials of pairs, and settings that cannot be combined with these contacts.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "ricochet/io/scene/context.h"
#include "ricochet/response/pair_materials.h"
#include "ricochet/response/settings_table.h"

namespace ricochet::detail {
namespace {

Fields<PairMaterial> material_fields() {
    constexpr Without kOther{"the value for all spheres"};
    Fields<PairMaterial> law = fields_of<PairMaterial>(kImpactLawTable<PairMaterial>, kOther);
    for (Field<PairMaterial>& field : law) field.needs = {};  // the needed key may be that for all spheres
    return joined<PairMaterial>({fields_of<PairMaterial>(kSphereContactTable<PairMaterial>, kOther), law});
}

const ObjectSpec& own_material_spec() {
    static const ObjectSpec spec =
        object<PairMaterial>("sphere material", "Contact between spheres of this material.", material_fields());
    return spec;
}

const ObjectSpec& material_pair_spec() {
    static const ObjectSpec spec = object<PairMaterial>(
        "pair of materials", "Contact between spheres of two materials.",
        joined<PairMaterial>({{{"first", ValueType::text, "Name of a material.", kRequired},
                               {"second", ValueType::text, "Name of another material.", kRequired}},
                              material_fields()}));
    return spec;
}

void warn_about_idle_law(const SceneContext& context, const ObjectView& view, const PairMaterial& material) {
    if (!view.has("tangential_restitution") || material.tangential_restitution == 0.0 || material.friction > 0.0)
        return;
    context.warn(view, "tangential_restitution", "nothing comes of it without friction");
}

/// Returns the material that an object describes. Members with absent keys have the values that apply to all spheres.
PairMaterial material_at(const SceneContext& context, const ObjectView& view, const PairContactSettings& all) {
    PairMaterial material = material_of_all(all);
    view.read_into(material);
    if (view.has("restitution_exponent") && !material.restitution_speed) {
        context.error(view, "restitution_exponent", "only goes together with the key \"restitution_speed\"");
    }
    warn_about_idle_law(context, view, material);
    return material;
}

void read_pairs(const SceneContext& context, const ObjectView& view, PairContactSettings& settings) {
    const std::vector<std::string_view> known(settings.materials.begin(), settings.materials.end());
    const MaterialNumbers numbers(settings.materials);
    std::set<std::pair<std::size_t, std::size_t>> taken;
    for (const ObjectView& pair : view.objects("pairs")) {
        MaterialPair read{pair.text("first"), pair.text("second"), material_at(context, pair, settings)};
        bool is_known = true;
        for (const char* key : {"first", "second"}) {
            const std::string name = pair.text(key);
            if (!pair.has(key) || numbers.of(name)) continue;
            is_known = false;
            context.error(pair, key, unknown_name("material among particle_contacts.materials", name, known));
        }
        if (!is_known || !pair.is_complete()) continue;
        if (read.first == read.second) {
            context.error(
                pair, "second",
                fmt::format(
                    "found \"{}\" twice, expected two materials: contacts within one material are set in `materials`",
                    read.first));
            continue;
        }
        const std::size_t first = *numbers.of(read.first);
        const std::size_t second = *numbers.of(read.second);
        if (taken.insert(std::minmax(first, second)).second) {
            settings.pairs.push_back(std::move(read));
        } else {
            context.error(
                pair, "second",
                fmt::format("\"{}\" and \"{}\" are there already, expected each pair once", read.first, read.second));
        }
    }
}

}  // namespace

const ObjectSpec& particle_contacts_spec() {
    using P = PairContactSettings;
    static const ObjectSpec spec = object<P>(
        "particle contacts", "Contacts between spheres.",
        joined<P>(
            {fields_of<P>(kSphereContactTable<P>),
             fields_of<P>(kImpactLawTable<P>),
             {{"method", &P::method, "Method that resolves contacts between spheres.",
               Choices{choice(PairMethod::automatic, "auto",
                              "as `contacts` if spheres press on each other or impacts follow each other closely, else "
                              "as `events`"),
                       choice(PairMethod::events, "events", "impact by impact, each at its exact time"),
                       choice(PairMethod::contacts, "contacts",
                              "all contacts of a step at once, with an error of first order in the step, except for "
                              "two spheres that meet alone")}}},
             fields_of<P>(kPairBudgetTable),
             {{"materials", ValueType::table,
               "Materials of spheres by name, with the contact between spheres of the same material. Emitters and "
               "particles select a material by the key `material`. The column `material` of particles is its number in "
               "this order.",
               &own_material_spec(), Without{"all spheres have the same material"}},
              {"pairs", ValueType::list, "Contacts between spheres of two materials.", &material_pair_spec()}}}));
    return spec;
}

void read_particle_contacts(const SceneContext& context, SimulationOptions& options) {
    if (!context.root().has("particle_contacts")) return;
    const ObjectView view = context.root().object("particle_contacts");
    auto settings = view.read<PairContactSettings>();
    warn_about_idle_law(context, view, material_of_all(settings));
    for (const NamedObject& named : view.named_objects("materials")) {
        settings.materials.push_back(named.name);
        settings.pairs.push_back({named.name, named.name, material_at(context, named.view, settings)});
    }
    read_pairs(context, view, settings);
    options.particle_contacts = std::move(settings);
}

std::optional<AttributeValue> material_of(const SceneContext& context, const SimulationSetup& setup,
                                          const ObjectView& view) {
    if (!view.has("material")) return std::nullopt;
    const std::string name = view.text("material");
    if (!setup.options.particle_contacts || setup.options.particle_contacts->materials.empty()) {
        context.error(view, "material",
                      "only goes together with particle_contacts.materials, which declares the names; materials of "
                      "walls are set at the walls");
        return std::nullopt;
    }
    const JsonNode::Object* const given = view.has("attributes") ? view.node("attributes").object() : nullptr;
    const auto is_it = [](const auto& member) { return member.key == kMaterialAttribute; };
    if (given != nullptr && std::any_of(given->begin(), given->end(), is_it)) {
        context.error(view, "material",
                      "found beside the attribute \"material\", which is its number: expected one of them");
        return std::nullopt;
    }
    const std::vector<std::string>& materials = setup.options.particle_contacts->materials;
    const auto found = std::find(materials.begin(), materials.end(), name);
    if (found == materials.end()) {
        context.error(
            view, "material",
            unknown_name("material among particle_contacts.materials", name, {materials.begin(), materials.end()}));
        return std::nullopt;
    }
    return AttributeValue{static_cast<double>(found - materials.begin()), 0.0, 0.0};
}

void check_particle_contacts(const SceneContext& context, const SimulationSetup& setup) {
    if (!setup.options.particle_contacts) return;
    const auto refuse = [&](bool refused, std::string_view what) {
        if (refused)
            context.error(context.root(), "particle_contacts", fmt::format("does not go together with {}", what));
    };
    refuse(setup.options.response != ResponseKind::exact,
           fmt::format("the response \"{}\", expected \"exact\"", name_of(setup.options.response)));
    refuse(setup.options.flow != nullptr, "a flow that carries the particles, expected \"motion\": \"forces\"");
    refuse(!setup.springs.empty() && setup.options.integrator.kind == IntegratorKind::implicit_euler,
           "springs and the integrator \"implicit_euler\", whose equations do not include impacts of spheres: expected "
           "an explicit one, for example \"velocity_verlet\"");
    refuse(!setup.bodies.empty(),
           "a frame's \"body\", which impulses move: give that frame \"motions\", or leave out particle_contacts");
    const bool is_pulled = !setup.springs.empty() || !context.objects("particle_forces").empty();
    if (is_pulled && setup.options.particle_contacts->method == PairMethod::events) {
        context.error(context.root().object("particle_contacts"), "method",
                      "found \"events\" beside springs or forces between particles, expected \"auto\": these press "
                      "spheres together, and \"events\" resolves only single impacts");
    }
    const bool has_particles = !setup.particles.empty() || !setup.emitters.empty();
    if (has_particles && has_only_points(setup)) {
        context.warn(context.root(), "particle_contacts",
                     "all particles are points, which never meet: it does nothing; give them a radius");
    }
}

}  // namespace ricochet::detail
