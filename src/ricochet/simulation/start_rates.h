/// \file
/// Private to the simulation: how fast particles that act on each other can oscillate where they stand at the start.
#pragma once

#include "ricochet/dynamics/stability.h"
#include "ricochet/simulation.h"

namespace ricochet {

/// Rates of the setup's particles in their first step, by a force of pairs. Particles that stand nearer to each other
/// than at rest, or have more neighbours than a packing gives them, oscillate faster than later.
/// Bound: with the stiffness k and the unit vector n of each pair, no eigenvalue is above the largest eigenvalue, over
/// all particles i, of the sum of k (1/m_i + 1/m_j) n n^T, since |u_i/sqrt(m_i) - u_j/sqrt(m_j)|^2 is at most
/// (1/m_i + 1/m_j) (|u_i|^2 + |u_j|^2). Zero for forces whose steepness is not known.
[[nodiscard]] OscillationRates rates_at_start(const SimulationSetup& setup, const ParticlesForceEntry& entry);

}  // namespace ricochet
