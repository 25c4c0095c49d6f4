// Forces between particles: the keys of each type, and the function that makes the force.
#include <fmt/format.h>

#include <utility>

#include "ricochet/dynamics/pair_forces.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/io/scene/context.h"

namespace ricochet::detail {
namespace {

using ParticlesForcePointer = std::shared_ptr<const ParticlesForce>;
using ParticlesForceLaw = Law<ParticlesForcePointer>;

template <class Settings, class Maker>
ParticlesForceLaw law(std::string_view name, std::string_view description, const Fields<Settings>& fields, Maker make) {
    return {variant(name, description, fields), [make](const ObjectView& view) { return make(view.read<Settings>()); }};
}

template <class Settings>
Fields<Settings> inverse_square_fields() {
    using S = InverseSquareSettings;
    return {{"softening", &S::softening, kLengthOrZero, "m",
             "Length over which each particle is spread. The force is weaker within it. Without it, close encounters "
             "need steps as short as the encounter."},
            {"method", &S::method, "Method that sums the forces.",
             Choices{choice(SumMethod::automatic, "direct up to 1500 particles, a tree beyond"),
                     choice(SumMethod::direct,
                            "every pair by itself: exact, costs grow with the square of the number of particles"),
                     choice(SumMethod::tree, "distant groups by their moments")}},
            {"opening", &S::opening, positive_up_to(1.0), "",
             "For the tree: a group is summed as one if its radius divided by its distance is below this value. "
             "Smaller values are more exact and slower."}};
}

ParticlesForceLaw mutual_gravity() {
    using G = GravitySettings;
    return law<G>(
        "gravity", "Newton's law between all pairs of particles, by their masses.",
        joined<G>({{{"constant", &G::constant, kCoordinate, "m^3/(kg s^2)",
                     "Gravitational constant. Negative values repel. Scenes with their own units often use 1."}},
                   inverse_square_fields<G>()}),
        &make_mutual_gravity);
}

ParticlesForceLaw charge() {
    using C = ChargeSettings;
    return law<C>("charge", "Coulomb's law between all pairs of particles. Their charge is an attribute.",
                  joined<C>({{{"attribute", &C::attribute,
                               "Name of the attribute, with one component, that contains the charge in C."},
                              {"constant", &C::constant, kCoordinate, "N m^2/C^2",
                               "Coulomb constant. Negative values attract like charges."}},
                             inverse_square_fields<C>()}),
                  &make_coulomb_force);
}

ParticlesForceLaw lennard_jones() {
    using L = LennardJonesSettings;
    return law<L>("lennard_jones",
                  "Force of neutral atoms: repulsion by the 12th and attraction by the 6th power of the distance, with "
                  "a smooth cutoff. The potential is lowest near a distance of 1.12 diameters.",
                  {{"depth", &L::depth, kPositive, "J", "Depth of the potential at its minimum, without the cutoff."},
                   {"diameter", &L::diameter, kLength, "m", "Distance of the centres at which the potential is 0."},
                   {"cutoff",
                    &L::cutoff,
                    {.lower = 1.0, .upper = 1000.0, .lower_open = true},
                    "",
                    "Distance, in diameters, beyond which there is no force."}},
                  &make_lennard_jones);
}

ParticlesForceLaw cohesion() {
    using C = CohesionSettings;
    return law<C>(
        "cohesion",
        "Cohesion of spheres: a spring between their surfaces, F = k g (1 - g / range)^2 at the gap g. It ends at the "
        "gap `range`, and it pushes overlapping spheres apart.",
        {{"stiffness", &C::stiffness, kLengthOrZero, "N/m", "Stiffness k of the spring near contact.", kRequired},
         {"range", &C::range, kLength, "m", "Gap between the surfaces at which the force ends.", kRequired},
         {"damping", &C::damping, kLengthOrZero, "N s/m", "Damping along the line of the centres, within the range."}},
        &make_cohesion);
}

const std::vector<ParticlesForceLaw>& particles_force_laws() {
    static const std::vector<ParticlesForceLaw> laws = {mutual_gravity(), charge(), lennard_jones(), cohesion()};
    return laws;
}

// Keys of every force between particles.
struct ParticlesForceKeys {
    std::vector<std::uint64_t> particles;
    std::string emitter;
};

void read_emitter(const SceneContext& context, const SimulationSetup& setup, const ObjectView& view,
                  ParticlesForceEntry& entry) {
    if (!view.has("emitter")) return;
    const std::string name = view.read<ParticlesForceKeys>().emitter;
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

/// Reports settings that cannot be combined with forces between particles.
void check_company(const SceneContext& context, const SimulationSetup& setup) {
    if (context.objects("particle_forces").empty()) return;
    const auto refuse = [&](const char* why) { context.error(context.root(), "particle_forces", why); };
    if (setup.options.flow) refuse("a flow carries the particles, forces between them would do nothing: expected none");
    if (setup.options.integrator.kind == IntegratorKind::implicit_euler) {
        refuse(
            "the equations of the integrator implicit_euler do not include forces between particles: expected another "
            "integrator, for example velocity_verlet");
    }
    if (!setup.bodies.empty()) {
        refuse("forces between particles cannot be combined with bodies that impulses move: expected none");
    }
}

}  // namespace

const ObjectSpec& particle_force_spec() {
    static const ObjectSpec spec = object<ParticlesForceKeys>(
        "force between particles",
        "A force of particles on each other. Forces add up. It acts between all particles unless `particles` or "
        "`emitter` selects some of them.",
        {{"particles", &ParticlesForceKeys::particles, "Ids of the particles that take part.", Without{"all"}},
         {"emitter", &ParticlesForceKeys::emitter, "Name of an emitter whose particles take part.", Without{"all"}}},
        variants_of(particles_force_laws()));
    return spec;
}

void build_particle_forces(const SceneContext& context, SimulationSetup& setup) {
    check_company(context, setup);
    for (const ObjectView& view : context.objects("particle_forces")) {
        const ParticlesForceLaw* law = law_of(particles_force_laws(), view);
        if (law == nullptr) continue;
        ParticlesForceEntry entry;
        entry.force = made(context, view, [&] { return law->make(view); });
        if (!entry.force) continue;
        if (view.has("particles")) entry.particles = view.read<ParticlesForceKeys>().particles;
        warn_of_unknown_ids(context, view, setup, entry.particles);
        read_emitter(context, setup, view, entry);
        check_attributes(context, setup, view, *entry.force);
        setup.particles_forces.push_back(std::move(entry));
    }
}

}  // namespace ricochet::detail
