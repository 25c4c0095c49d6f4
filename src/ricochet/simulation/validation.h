/// \file
/// Private to the simulation: what a simulation refuses. Every check throws InputError with one line that names the
/// object and the value.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "ricochet/simulation.h"

namespace ricochet {

/// Everything in a setup that its own class does not check (forces, emitters, springs and frames check their values).
/// Returns it.
const SimulationSetup& validated(const SimulationSetup& setup);

/// What its parts cannot do together: colliders that move, bodies, spheres that meet, flows, forces between particles.
void validate_together(const SimulationSetup& setup);

/// What changes temperatures: its values, and what it needs of particles and of what moves them.
void validate_heat(const SimulationSetup& setup);
/// What forces that ask for temperatures need of the rest.
void validate_thermal_forces(const SimulationSetup& setup);

/// What spheres do when they meet, their materials, and what else there is.
void validate_particle_contacts(const SimulationSetup& setup);
/// A particle that is to meet others: its mass, and whether it is of one of the materials; columns: of its attributes.
void validate_sphere(const Particle& particle, std::size_t number, const PairContactSettings& contacts,
                     std::span<const AttributeDescription> columns);

/// A particle, by its number among those that are given; columns: how many attributes particles have.
void validate(const Particle& particle, std::size_t number, std::size_t columns);
/// materials: how many there are.
void validate(const ColliderDescription& collider, std::size_t number, std::size_t materials);

}  // namespace ricochet
