/// \file
/// Private to the simulation: warnings about a setup, and the bounds on which they depend.
#pragma once

#include <string>
#include <vector>

#include "ricochet/dynamics/stability.h"
#include "ricochet/simulation.h"
#include "ricochet/simulation/collision_scene.h"

namespace ricochet {

/// Returns the rates of oscillation of the setup's particles in their first step, by a force between pairs. Particles
/// that are nearer to each other than at rest, or have more neighbours than a packing gives them, oscillate faster than
/// later. Bound: let k be the stiffness and n the unit vector of each pair. Each particle i has the matrix
/// sum_j k (1/m_i + 1/m_j) n n^T. The largest eigenvalue of these matrices bounds those of the system. Reason:
/// |u_i/sqrt(m_i) - u_j/sqrt(m_j)|^2 <= (1/m_i + 1/m_j) (|u_i|^2 + |u_j|^2). Zero for forces of unknown
/// steepness.
[[nodiscard]] OscillationRates rates_at_start(const SimulationSetup& setup, const ParticlesForceEntry& entry);

/// Returns a warning if an integrator does not keep the energy of forces on single particles. A few particles are
/// stepped without colliders, springs and other particles. The warning comes if the energy grows by more than a
/// hundredth of the energy of the motion in the time of the run. It also comes if a particle falls into a point of
/// infinite force. Forces without a potential and custom forces are not judged.
[[nodiscard]] std::vector<std::string> energy_warnings(const SimulationSetup& setup);

/// Returns true if the setup has another integrator than implicit_euler and would not be refused with it.
[[nodiscard]] bool may_be_implicit(const SimulationSetup& setup);

/// Returns warnings, a line each. They compare the time step with the stability bounds of drag, of springs, and of
/// forces between particles with a known steepness (steepness_of()). They also name children that are born in overlap
/// while a force grows without bound. energy_warnings() are included.
[[nodiscard]] std::vector<std::string> stability_warnings(const SimulationSetup& setup);

/// Sentences for the user about a valid setup whose run may surprise.
class StartWarnings {
public:
    /// Compares the time step with the stability bounds of contacts, forces and springs.
    explicit StartWarnings(const SimulationSetup& setup);

    [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }
    /// Returns true if a message about diverging motion may suggest implicit_euler.
    [[nodiscard]] bool knows_implicit() const { return knows_implicit_; }
    /// Adds warnings of particles of the setup that overlap surfaces or, if spheres meet, each other. Counts the
    /// latter.
    void add_overlaps(const CollisionScene& scene, const Particles& particles, bool do_spheres_meet,
                      SimulationStatistics& statistics);

private:
    std::vector<std::string> texts_;
    bool knows_implicit_;
};

}  // namespace ricochet
