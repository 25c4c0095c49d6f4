/// \file
/// Private to the simulation: warnings about a setup, and the bounds on which they depend.
#pragma once

#include <string>
#include <vector>

#include "ricochet/dynamics/stability.h"
#include "ricochet/simulation.h"
#include "ricochet/simulation/collision_scene.h"

namespace ricochet {

/// Returns the name of an object in quotes, or without a name its number in a list of the scene.
[[nodiscard]] std::string named(const std::string& name, const char* list, std::size_t number);

/// Returns upper bounds of the oscillation rates of the setup's particles in their first step, for a force between
/// pairs. Particles oscillate faster than later if they start nearer to each other than at rest. They also do so with
/// more neighbours than in a packing. Bound: let k be the stiffness and n the unit vector of each pair. Each particle i
/// has the matrix sum_j k (1/m_i + 1/m_j) n n^T. The largest eigenvalue of these matrices is an upper bound of the
/// eigenvalues of the system. Reason: |u_i/sqrt(m_i) - u_j/sqrt(m_j)|^2 <= (1/m_i + 1/m_j) (|u_i|^2 + |u_j|^2). Returns
/// zero rates for forces of unknown steepness.
[[nodiscard]] OscillationRates rates_at_start(const SimulationSetup& setup, const ParticlesForceEntry& entry);

/// Returns a warning if the integrator does not conserve the energy of particles under forces on single particles. A
/// trial steps a few particles without colliders, springs and other particles. A warning is returned if the energy
/// grows by more than a hundredth of the kinetic energy in the time of the run. A warning is also returned if a
/// particle falls into a point of infinite force. Forces without a potential and custom forces are not tested.
[[nodiscard]] std::vector<std::string> energy_warnings(const SimulationSetup& setup);

/// Returns true if the setup does not use implicit_euler, but would be valid with this integrator.
[[nodiscard]] bool may_be_implicit(const SimulationSetup& setup);

/// Returns warnings, one line each, and includes energy_warnings(). Compares the time step with the stability bounds of
/// drag, springs, and forces between particles. For forces between particles, the steepness must be known
/// (steepness_of()). Further warnings name children that are born in overlap under a force that grows without bound.
[[nodiscard]] std::vector<std::string> stability_warnings(const SimulationSetup& setup);

/// Warnings for the user about a valid setup whose run may give unexpected results.
class StartWarnings {
public:
    /// Compares the time step with the stability bounds of contacts, forces and springs.
    explicit StartWarnings(const SimulationSetup& setup);

    [[nodiscard]] const std::vector<std::string>& texts() const { return texts_; }
    /// Returns true if a message about diverging motion may suggest implicit_euler.
    [[nodiscard]] bool knows_implicit() const { return knows_implicit_; }
    /// Adds warnings about particles that overlap surfaces. If spheres meet each other, also adds warnings about
    /// spheres that overlap other spheres, and counts them.
    void add_overlaps(const CollisionScene& scene, const Particles& particles, bool do_spheres_meet,
                      SimulationStatistics& statistics);

private:
    std::vector<std::string> texts_;
    bool knows_implicit_;
};

}  // namespace ricochet
