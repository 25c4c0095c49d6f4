// Validates contacts between spheres: settings, materials, and parts of a setup that exclude such contacts.
#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "ricochet/response/pair_materials.h"
#include "ricochet/response/settings_table.h"
#include "ricochet/simulation/validation.h"
#include "ricochet/verify/sphere_overlaps.h"

namespace ricochet {
namespace {

/// Largest number of named materials. With more materials, the table of pairs in a scene would not be readable.
constexpr std::size_t kMostMaterials = 1000;

/// Limits of masses, in kg, whose products and inverses stay in range. Local: a limit of input values.
constexpr double kLeastMass = 1e-100;
constexpr double kLargestMass = 1e100;

void require_mass(const Subject& subject, double mass) {
    subject.require_in(mass, kLeastMass, kLargestMass, "mass", "1e-100 to 1e100 (kg) where spheres meet");
}

void validate_names(const PairContactSettings& contacts, const Subject& subject) {
    if (contacts.materials.size() > kMostMaterials) {
        subject.refuse("materials", contacts.materials.size(), fmt::format("at most {}", kMostMaterials));
    }
    std::set<std::string> taken;
    for (const std::string& name : contacts.materials) {
        if (name.empty() || !taken.insert(name).second) {
            subject.refuse("materials", "\"" + name + "\"", "names, each once");
        }
    }
    const MaterialNumbers numbers(contacts.materials);
    std::set<std::pair<std::size_t, std::size_t>> pairs;
    for (const MaterialPair& pair : contacts.pairs) {
        for (const std::string& name : {pair.first, pair.second}) {
            if (!numbers.of(name)) subject.refuse("pairs", "\"" + name + "\"", "names of `materials`");
        }
        subject.require_settings(pair.material, kSphereContactTable<PairMaterial>);
        subject.require_settings(pair.material, kImpactLawTable<PairMaterial>);
        const std::size_t first = *numbers.of(pair.first);
        const std::size_t second = *numbers.of(pair.second);
        if (pairs.insert(std::minmax(first, second)).second) continue;
        subject.refuse("pairs", fmt::format("\"{}\" and \"{}\" twice", pair.first, pair.second), "each pair once");
    }
}

std::string expected_material(const PairContactSettings& contacts) {
    return fmt::format("a whole number below {}, of one of particle_contacts' materials", contacts.materials.size());
}

void validate_column(const SimulationSetup& setup, const Subject& subject) {
    const PairContactSettings& contacts = *setup.options.particle_contacts;
    const auto& all = setup.attributes;
    const auto column =
        std::ranges::find_if(all, [](const AttributeDescription& a) { return a.name == kMaterialAttribute; });
    if (column == all.end()) {
        subject.refuse("attributes", "none that is named \"material\"",
                       "it to be declared: it says of which of `materials` a particle is");
    }
    if (column->components != 1) subject.refuse("attribute \"material\"", "a vector", "one component");
    if (!is_material(column->fallback, contacts.materials.size())) {
        subject.refuse("default of the attribute \"material\"", column->fallback.x, expected_material(contacts));
    }
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const EmitterDescription& emitter = setup.emitters[k];
        for (const AttributeSpread& value : emitter.attributes) {
            if (value.name != kMaterialAttribute) continue;
            if (is_material(value.mean, contacts.materials.size()) && value.spread.x == 0.0) continue;
            Subject("emitter", k, emitter.name)
                .refuse("material", fmt::format("{:g} +- {:g}", value.mean.x, value.spread.x),
                        expected_material(contacts) + ", without a spread");
        }
    }
}

/// Refuses springs between overlapping spheres, which contacts would stretch in every step.
void validate_joined(const SimulationSetup& setup, const Subject& subject) {
    for (const Spring& spring : setup.springs) {
        if (std::max(spring.first, spring.second) >= setup.particles.size()) continue;
        const Particle& first = setup.particles[spring.first];
        const Particle& second = setup.particles[spring.second];
        const double smaller = std::min(first.radius, second.radius);
        const double distance = length(second.position - first.position);
        const double overlap = first.radius + second.radius - distance;
        if (smaller == 0.0 || (first.pinned && second.pinned) || !(overlap > kMostMetOverlap * smaller)) continue;
        subject.refuse("springs",
                       fmt::format("one between spheres {} and {}, which stand {:.3g} m in each other", spring.first,
                                   spring.second, overlap),
                       fmt::format("radii whose sum is at most their distance, {:.6g} m", distance));
    }
}

/// Refuses the method `events` if forces press spheres together, because this method has no lasting contact.
void validate_method(const SimulationSetup& setup, const Subject& subject) {
    const bool is_pulled = !setup.springs.empty() || !setup.particles_forces.empty();
    if (!is_pulled || setup.options.particle_contacts->method != PairMethod::events) return;
    subject.refuse(
        "method", "events",
        "auto beside springs and forces between particles: they press spheres together, and this method has no "
        "lasting contact");
}

/// Refuses parts of a setup that exclude contacts of spheres.
void validate_company(const SimulationSetup& setup, const Subject& subject) {
    if (setup.options.response != ResponseKind::exact) {
        subject.refuse("response", name_of(setup.options.response), "exact: the others move each particle for itself");
    }
    if (setup.options.flow) subject.refuse("motion", "a flow", "forces: particles in a flow do not meet each other");
    if (setup.solver) subject.refuse("solver", "one of the program's own", "none beside spheres that meet");
    if (!setup.springs.empty() && setup.options.integrator.kind == IntegratorKind::implicit_euler) {
        subject.refuse("integrator", name_of(setup.options.integrator.kind),
                       "an explicit one where springs join spheres that meet: its equations do not know their impacts");
    }
    if (!setup.bodies.empty()) {
        subject.refuse("bodies", setup.bodies.size(), "none that impulses move beside spheres that meet");
    }
    const bool moves = std::ranges::any_of(
        setup.colliders, [](const ColliderDescription& c) { return !c.frame.empty() || is_deforming(c); });
    if (moves && kicks_first(setup.options.integrator.kind)) {
        subject.refuse("integrator", name_of(setup.options.integrator.kind),
                       "another integrator if colliders move: this one would apply its kick twice");
    }
}

}  // namespace

void validate_sphere(const Particle& particle, std::size_t number, const PairContactSettings& contacts,
                     std::span<const AttributeDescription> columns) {
    if (particle.radius > 0.0) require_mass(Subject("particle", number), particle.mass);
    if (contacts.materials.empty()) return;
    const auto column =
        std::ranges::find_if(columns, [](const AttributeDescription& a) { return a.name == kMaterialAttribute; });
    const auto k = static_cast<std::size_t>(column - columns.begin());
    if (k >= particle.attributes.size() || is_missing(particle.attributes[k])) return;
    if (is_material(particle.attributes[k], contacts.materials.size())) return;
    Subject("particle", number).refuse("material", particle.attributes[k].x, expected_material(contacts));
}

void validate_particle_contacts(const SimulationSetup& setup) {
    if (!setup.options.particle_contacts) return;
    const PairContactSettings& contacts = *setup.options.particle_contacts;
    const Subject subject("particle_contacts");
    subject.require_settings(contacts, kSphereContactTable<PairContactSettings>);
    subject.require_settings(contacts, kImpactLawTable<PairContactSettings>);
    subject.require_settings(contacts, kPairBudgetTable);
    validate_names(contacts, subject);
    for (std::size_t k = 0; k < setup.particles.size(); ++k) {
        validate_sphere(setup.particles[k], k, contacts, setup.attributes);
    }
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const EmitterDescription& emitter = setup.emitters[k];
        if (emitter.parent && emitter.parent->share) continue;  // masses follow from the parent's mass
        require_mass(Subject("emitter", k, emitter.name), least_mass(emitter));
        require_mass(Subject("emitter", k, emitter.name), most_mass(emitter));
    }
    if (!contacts.materials.empty()) validate_column(setup, subject);
    validate_company(setup, subject);
    validate_method(setup, subject);
    validate_joined(setup, subject);
}

}  // namespace ricochet
