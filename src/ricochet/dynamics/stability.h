/// \file
/// Longest stable steps of integrators with oscillating systems. Private to the library.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/dynamics/particles_force.h"
#include "ricochet/dynamics/springs.h"

namespace ricochet {

/// Upper bounds of the rates of all oscillations.
struct OscillationRates {
    double omega_squared = 0.0;  ///< largest eigenvalue of the stiffness over the masses, in 1/s^2
    double gamma = 0.0;          ///< largest eigenvalue of the damping over the masses, in 1/s
    /// Smallest ratio of damping to stiffness over the single oscillators, in s. Used for forward_euler.
    double least_damper = std::numeric_limits<double>::infinity();
};

/// Returns the longest stable step, in s, with the limits of longest_stable_step() in springs.h.
[[nodiscard]] double longest_stable_step(IntegratorKind kind, const OscillationRates& rates);

/// Returns the rates of the springs by Gershgorin's bound, see longest_stable_step() in springs.h.
[[nodiscard]] OscillationRates rates_of(std::span<const Spring> springs, const std::vector<Particle>& particles);

/// Returns the factor by which a step of h seconds multiplies the energy of an oscillation with these rates: the
/// squared modulus of the stability polynomial of Runge-Kutta methods at h times the eigenvalue. For other methods the
/// factor is 1, because they conserve or damp the energy while they are stable.
[[nodiscard]] double energy_factor(IntegratorKind kind, double omega_squared, double gamma, double h);

/// Effect of a force of forces.h on the energy of a particle.
struct EnergyLaw {
    bool is_dissipative = false;  ///< true if the force removes energy; it may also add energy from a flow
    bool varies = false;          ///< true if the force depends on position or velocity, and conserves an energy
    bool is_magnetic = false;     ///< true if a part of the force depends on the velocity and does no work
    bool is_singular = false;     ///< true if the attraction grows without bound
};
/// Returns the energy law of a force; nothing for forces without a potential and for user-defined forces.
[[nodiscard]] std::optional<EnergyLaw> energy_law_of(const Force& force);
/// Returns the energy law of a force that acts on all particles.
[[nodiscard]] std::optional<EnergyLaw> energy_law_of_global_force(const Force& force);

/// Largest coordinates, in m, and velocity components, in m/s, at which forces and flows must be finite. Beyond it,
/// powers overflow even in valid forces. Local: a limit of input values.
inline constexpr double kLargestJudged = 1e25;

/// Largest stiffness of a pair force along the line of the centres, within its attractive range, and largest damping.
struct PairSteepness {
    double stiffness = 0.0;  ///< in N/m
    double damping = 0.0;    ///< in N s/m
};
/// Returns the steepness; nothing for user-defined forces and for forces that grow without bound.
[[nodiscard]] std::optional<PairSteepness> steepness_of(const ParticlesForce& force);

/// Two particles within the cutoff of a pair force, with the steepness at their distance.
struct SteepPair {
    std::size_t first = 0;  ///< index of a particle in the lists
    std::size_t second = 0;
    Vec3 direction;  ///< unit vector along the line of the centres
    PairSteepness steepness;
};
/// Returns the pairs within the cutoff at which the force has a positive stiffness, so that they could oscillate. The
/// list is empty if steepness_of() returns nothing for the force.
[[nodiscard]] std::vector<SteepPair> steep_pairs(const ParticlesForce& force, const ParticlesView& particles);

/// Returns true for gravity and charge without softening, whose force grows without bound as two particles approach.
[[nodiscard]] bool lacks_softening(const ParticlesForce& force);

/// Returns true for the drags of forces.h, on all particles or on some.
[[nodiscard]] bool is_drag(const Force& force);
/// Returns true for the drags of forces.h on all particles.
[[nodiscard]] bool is_drag_law(const Force& force);

/// Returns the rate, in 1/s, at which a drag damps velocity changes in its direction, from central differences.
[[nodiscard]] double damping_rate(const Force& drag, const ForceInput& input);

}  // namespace ricochet
