/// \file
/// Private to the simulation: checks of setups. Every check throws InputError with one line that names the object and
/// the value.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Checks everything in a setup that its own class does not check (forces, emitters, springs and frames check their
/// values). Returns the setup.
const SimulationSetup& validated(const SimulationSetup& setup);

/// Checks parts that cannot be combined: moving colliders, bodies, spheres that meet, flows, forces between particles.
void validate_together(const SimulationSetup& setup);

/// Checks the settings that change temperatures, and their requirements on particles and on motion.
void validate_heat(const SimulationSetup& setup);
/// Checks the requirements of forces that depend on temperatures.
void validate_thermal_forces(const SimulationSetup& setup);

/// Checks contacts between spheres, their materials, and their combination with other settings.
void validate_particle_contacts(const SimulationSetup& setup);
/// Checks a particle that can meet others: its mass, and that it has one of the materials. columns: of its attributes.
void validate_sphere(const Particle& particle, std::size_t number, const PairContactSettings& contacts,
                     std::span<const AttributeDescription> columns);

/// Checks a particle. number: among the given particles. columns: number of attributes of particles.
void validate(const Particle& particle, std::size_t number, std::size_t columns);
/// Checks a collider. materials: number of materials.
void validate(const ColliderDescription& collider, std::size_t number, std::size_t materials);

}  // namespace ricochet
