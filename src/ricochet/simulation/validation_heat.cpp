// Validates the settings of heat, and the parts of a setup that they need.
#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "ricochet/dynamics/settings_table.h"
#include "ricochet/simulation/validation.h"

namespace ricochet {
namespace {

void require_temperature(const Subject& subject, double value, std::string_view what) {
    subject.require(value, kTemperature, what, "K");
}

void validate_numbers(const HeatSettings& heat, const Subject& subject) {
    subject.require_settings(heat, kHeatTable);
    subject.require_settings(heat, kHeatFractionTable);
    if (heat.convection) Subject("heat.convection").require_settings(*heat.convection, kConvectionTable);
    if (heat.exchanges() || heat.is_heated_by_surfaces()) return;
    subject.refuse("convection, emissivity, impact_fraction and friction_fraction", "none",
                   "at least one of them: nothing would change a temperature");
}

/// Validates the temperature attribute. Returns its column.
std::size_t validate_attribute(const SimulationSetup& setup, const Subject& subject, const char* why) {
    const auto& all = setup.attributes;
    const auto found = std::ranges::find_if(
        all, [](const AttributeDescription& column) { return column.name == kTemperatureAttribute; });
    if (found == all.end()) {
        subject.refuse("attributes", "none that is named \"temperature\"",
                       fmt::format("it to be declared: {}, in K", why));
    }
    if (found->components != 1) subject.refuse("attribute \"temperature\"", "a vector", "one component (K)");
    require_temperature(subject, found->fallback.x, "default of the attribute \"temperature\"");
    return static_cast<std::size_t>(found - all.begin());
}

/// Refuses convection and radiation for particles without a surface. least: smallest radius, in m.
void validate_radius(const Subject& subject, const HeatSettings& heat, double least) {
    if (!heat.exchanges() || least > 0.0) return;
    subject.refuse("radius", least,
                   "more than 0 (m): convection and radiation, which `heat` has, go by a particle's surface");
}

void validate_particles(const SimulationSetup& setup, std::size_t column) {
    for (std::size_t k = 0; k < setup.particles.size(); ++k) {
        const Particle& particle = setup.particles[k];
        const Subject subject("particle", k);
        validate_radius(subject, *setup.heat, particle.radius);
        if (particle.attributes.size() <= column || is_missing(particle.attributes[column])) continue;
        require_temperature(subject, particle.attributes[column].x, kTemperatureAttribute);
    }
    for (std::size_t k = 0; k < setup.emitters.size(); ++k) {
        const EmitterDescription& emitter = setup.emitters[k];
        const Subject subject("emitter", k, emitter.name);
        const bool is_shared = emitter.parent && emitter.parent->share;  // radii follow from the parent's radius
        if (!is_shared) validate_radius(subject, *setup.heat, emitter.radius.least());
        for (const AttributeSpread& spread : emitter.attributes) {
            if (spread.name != kTemperatureAttribute) continue;
            require_temperature(subject, spread.mean.x - spread.spread.x, "least temperature");
            require_temperature(subject, spread.mean.x + spread.spread.x, "largest temperature");
        }
    }
}

/// Refuses heat from surfaces if the energy that surfaces take from particles is not known.
void validate_friction(const SimulationSetup& setup, const Subject& heat) {
    const auto refuse = [&](bool refused, std::string_view found, std::string_view expected) {
        if (refused) heat.refuse("impact_fraction and friction_fraction", found, expected);
    };
    refuse(setup.options.response != ResponseKind::exact, name_of(setup.options.response),
           "the response exact, because only exact records losses at surfaces, or both 0");
    refuse(setup.options.flow != nullptr, "a flow that carries the particles",
           "motion by forces, or both 0: particles in a flow have no energy to lose");
    refuse(setup.options.particle_contacts.has_value(), "particle_contacts",
           "none, or both 0: losses between spheres cannot be separated from losses at surfaces");
    const bool act_on_each_other = !setup.springs.empty() || !setup.particles_forces.empty() || setup.solver;
    refuse(act_on_each_other, "particles that act on each other",
           "none, or both 0: energy lost to surfaces cannot be separated from energy exchanged by particles");
    refuse(!setup.bodies.empty(), "bodies that impulses move", "frames that move by their motions alone, or both 0");
    for (std::size_t k = 0; k < setup.materials.size(); ++k) {
        const Material& material = setup.materials[k];
        if (!material.wall_temperature) continue;
        Subject("material", k, material.name)
            .refuse(
                "wall_temperature", *material.wall_temperature,
                "none beside impact_fraction and friction_fraction: the wall alone determines speeds after impacts");
    }
}

}  // namespace

void validate_heat(const SimulationSetup& setup) {
    if (!setup.heat) return;
    const Subject subject("heat");
    validate_numbers(*setup.heat, subject);
    const std::size_t column = validate_attribute(setup, subject, "it is what heat changes");
    validate_particles(setup, column);
    if (setup.heat->is_heated_by_surfaces()) validate_friction(setup, subject);
}

void validate_thermal_forces(const SimulationSetup& setup) {
    const bool needs =
        std::ranges::any_of(setup.forces, [](const auto& force) { return force && force->needs_temperature(); });
    if (!needs) return;
    const Subject subject("thermal buoyancy");
    (void)validate_attribute(setup, subject, "the lift goes by it");
    const bool act_on_each_other =
        !setup.springs.empty() || !setup.particles_forces.empty() || setup.solver || setup.options.particle_contacts;
    if (act_on_each_other) {
        subject.refuse("particles", "some that act on each other",
                       "none of springs, particle_forces and particle_contacts: parcels of gas move by themselves");
    }
}

}  // namespace ricochet
