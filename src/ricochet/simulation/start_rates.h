/// \file
/// Private to the simulation: the fastest oscillations of particles that act on each other, at their first positions.
#pragma once

#include "ricochet/dynamics/stability.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Returns the rates of oscillation of the setup's particles in their first step, by a force between pairs. Particles
/// that are nearer to each other than at rest, or have more neighbours than a packing gives them, oscillate faster than
/// later. Bound: let k be the stiffness and n the unit vector of each pair. Each particle i has the matrix
/// sum_j k (1/m_i + 1/m_j) n n^T. No eigenvalue of the system is above the largest eigenvalue of these matrices, since
/// |u_i/sqrt(m_i) - u_j/sqrt(m_j)|^2 is at most (1/m_i + 1/m_j) (|u_i|^2 + |u_j|^2). Zero for forces of unknown
/// steepness.
[[nodiscard]] OscillationRates rates_at_start(const SimulationSetup& setup, const ParticlesForceEntry& entry);

}  // namespace ricochet
