// Forces between particles: the keys of each, beside what is made of them.
#include <fmt/format.h>

#include <utility>

#include "ricochet/dynamics/pair_forces.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

using ForcePointer = std::shared_ptr<const ParticlesForce>;
using ForceLaw = Law<ForcePointer>;

template <class Settings, class Maker>
ForceLaw law(std::string_view name, std::string_view description, const Fields<Settings>& fields, Maker make) {
    return {variant(name, description, fields), [make](const ObjectView& view) { return make(view.read<Settings>()); }};
}

template <class Settings>
Fields<Settings> inverse_square_fields() {
    using S = InverseSquareSettings;
    return {
        {"softening", &S::softening, kLengthOrZero, "m",
         "Length over which each particle is smeared out: the force is weaker within it. Without it two that come "
         "near each other need steps as short as their passage."},
        {"method", &S::method, "How all are added up.",
         Choices{choice(SumMethod::automatic, "direct up to 1500 particles, by a tree beyond"),
                 choice(SumMethod::direct, "every pair by itself: exact, costs grow with the square of their number"),
                 choice(SumMethod::tree, "distant groups by their moments")}},
        {"opening", &S::opening, positive_up_to(1.0), "",
         "Of the tree: groups are taken together from where their radius over their distance is smaller than this. "
         "Smaller is more exact and slower."}};
}

ForceLaw gravity() {
    using G = GravitySettings;
    return law<G>("gravity", "Newton's law between every two particles, by their masses.",
                  joined<G>({{{"constant", &G::constant, kCoordinate, "m^3/(kg s^2)",
                               "Of gravitation; negative repels. Scenes with units of their own often have 1."}},
                             inverse_square_fields<G>()}),
                  &make_mutual_gravity);
}

ForceLaw charge() {
    using C = ChargeSettings;
    return law<C>(
        "charge", "Coulomb's law between every two particles, by a charge that they carry as an attribute.",
        joined<C>({{{"attribute", &C::attribute, "The attribute, of one component, that holds the charge in C."},
                    {"constant", &C::constant, kCoordinate, "N m^2/C^2", "Coulomb's; negative attracts like charges."}},
                   inverse_square_fields<C>()}),
        &make_coulomb_force);
}

ForceLaw lennard_jones() {
    using L = LennardJonesSettings;
    return law<L>("lennard_jones",
                  "The force of neutral atoms: repulsion by the 12th, attraction by the 6th power of the distance, cut "
                  "off smoothly. The least potential is near a distance of 1.12 diameters.",
                  {{"depth", &L::depth, kPositive, "J", "How deep the least potential is, without the cutoff."},
                   {"diameter", &L::diameter, kLength, "m", "Distance of the centres at which the potential is 0."},
                   {"cutoff",
                    &L::cutoff,
                    {.lower = 1.0, .upper = 1000.0, .lower_open = true},
                    "",
                    "Diameters beyond which there is no force."}},
                  &make_lennard_jones);
}

ForceLaw cohesion() {
    using C = CohesionSettings;
    return law<C>(
        "cohesion",
        "Spheres that stick: a spring between their surfaces that lets go at a gap, F = k g (1 - g / range)^2, and "
        "pushes back where they overlap.",
        {{"stiffness", &C::stiffness, kLengthOrZero, "N/m", "The k: the spring's near contact.", kRequired},
         {"range", &C::range, kLength, "m", "Gap between the surfaces at which they let go.", kRequired},
         {"damping", &C::damping, kLengthOrZero, "N s/m", "Along the line of the centres, within the range."}},
        &make_cohesion);
}

const std::vector<ForceLaw>& force_laws() {
    static const std::vector<ForceLaw> laws = {gravity(), charge(), lennard_jones(), cohesion()};
    return laws;
}

// What every force says.
struct ForceKeys {
    std::vector<std::uint64_t> particles;
    std::string emitter;
};

void read_emitter(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                  ParticlesForceEntry& entry) {
    if (!view.has("emitter")) return;
    const std::string name = view.read<ForceKeys>().emitter;
    std::vector<std::string_view> known;
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        known.push_back(setup.emitters[k].name);
        if (setup.emitters[k].name == name) entry.emitters.push_back(static_cast<std::uint32_t>(k));
    }
    if (entry.emitters.empty()) context.error(view, "emitter", unknown_name("emitter", name, known));
}

void check_attributes(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                      const ParticlesForce& force) {
    for (const std::string& name : force.attributes()) {
        std::vector<std::string_view> known;
        for (const AttributeDescription& column : setup.attributes) known.push_back(column.name);
        const auto column = std::find(known.begin(), known.end(), name);
        if (column == known.end()) {
            context.error(view, "attribute",
                          unknown_name("attribute", name, known) + "; declare it in the scene's `attributes`");
        } else if (setup.attributes[static_cast<std::size_t>(column - known.begin())].components != 1) {
            context.error(view, "attribute", fmt::format("\"{}\" is a vector, expected one component", name));
        }
    }
}

/// What does not go together with forces between particles.
void check_company(const SceneContext& context, const SimulationSetup& setup) {
    if (context.objects("particle_forces").empty()) return;
    const auto refuse = [&](const char* why) { context.error(context.root(), "particle_forces", why); };
    if (setup.options.flow) refuse("a flow carries the particles, forces between them would do nothing: expected none");
    if (setup.options.integrator.kind == IntegratorKind::implicit_euler) {
        refuse(
            "the equations of the integrator implicit_euler do not hold forces between particles: expected another, "
            "for example velocity_verlet");
    }
    if (!setup.bodies.empty()) {
        refuse("beside bodies that impulses move there are no forces between particles: expected none");
    }
}

}  // namespace

const ObjectSpec& particle_force_spec() {
    static const ObjectSpec spec = object<ForceKeys>(
        "force between particles",
        "Forces of particles on each other; they add up. All particles take part unless `particles` or `emitter` names "
        "those between which the force acts.",
        {{"particles", &ForceKeys::particles, "Ids of particles that take part.", Without{"all"}},
         {"emitter", &ForceKeys::emitter, "Name of an emitter: what it gives birth to takes part.", Without{"all"}}},
        variants_of(force_laws()));
    return spec;
}

void build_particle_forces(const SceneContext& context, SimulationSetup& setup) {
    check_company(context, setup);
    for (const ObjectView& view : context.objects("particle_forces")) {
        const ForceLaw* law = law_of(force_laws(), view);
        if (law == nullptr) continue;
        ParticlesForceEntry entry;
        entry.force = made(context, view, [&] { return law->make(view); });
        if (!entry.force) continue;
        if (view.has("particles")) entry.particles = view.read<ForceKeys>().particles;
        warn_of_unknown_ids(context, view, setup, entry.particles);
        read_emitter(context, setup, view, entry);
        check_attributes(context, setup, view, *entry.force);
        setup.particles_forces.push_back(std::move(entry));
    }
}

}  // namespace ricochet::detail
