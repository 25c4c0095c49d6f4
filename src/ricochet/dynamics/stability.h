/// \file
/// Private to the library: the longest stable steps of integrators with oscillating systems.
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
    /// Smallest ratio of damping to stiffness of the single oscillators, in s (needed by forward_euler).
    double least_damper = std::numeric_limits<double>::infinity();
};

/// Returns the longest step, in s; longer steps may diverge. It is infinite for implicit_euler and for dormand_prince,
/// which chooses its own steps. Throws InputError for an unknown kind. The limits of the other methods are:
/// - symplectic_euler, velocity_verlet and ballistic: h^2 omega^2 + 2 h gamma < 4.
/// - Runge-Kutta methods: h times the largest eigenvalue must lie in their region of stability.
/// - forward_euler: every damper must remove the energy that the step adds to its own oscillator.
[[nodiscard]] double longest_stable_step(IntegratorKind kind, const OscillationRates& rates);

/// Returns the rates of the springs by Gershgorin's bound, see longest_stable_step() in springs.h.
[[nodiscard]] OscillationRates rates_of(std::span<const Spring> springs, const std::vector<Particle>& particles);

/// Returns the factor by which a step of h seconds multiplies the energy of an oscillation with these rates. It is the
/// squared modulus of the method's stability polynomial at h times the eigenvalue, for the Runge-Kutta methods. The
/// other methods return 1: while stable, they conserve the energy or damp it.
[[nodiscard]] double energy_factor(IntegratorKind kind, double omega_squared, double gamma, double h);

/// Effect of a force of forces.h on the energy of a particle.
struct EnergyLaw {
    bool is_dissipative = false;  ///< it removes energy, or adds some from a flow
    bool varies = false;          ///< it depends on position or velocity, and has an energy to conserve
    bool is_magnetic = false;     ///< a part of it depends on the velocity and does no work
    bool is_singular = false;     ///< it attracts without bound
};
/// Returns the energy law of a force; nothing for forces without a potential and for user-defined forces.
[[nodiscard]] std::optional<EnergyLaw> energy_law_of(const Force& force);
/// Returns the energy law of a force that acts on all particles.
[[nodiscard]] std::optional<EnergyLaw> energy_law_of_law(const Force& force);

/// Largest positions, in m, and velocities, in m/s, at which forces and flows must be finite. Methods may try states
/// beyond it, where powers overflow even in valid forces. Local: a limit of input values.
inline constexpr double kLargestJudged = 1e25;

/// Largest stiffness of a force of pairs along the line of the particles, within its attractive range, and its largest
/// damping. It is that of cohesion at contact, and of lennard_jones at the distance of rest.
struct PairSteepness {
    double stiffness = 0.0;  ///< in N/m
    double damping = 0.0;    ///< in N s/m
};
/// Returns the steepness; nothing for user-defined forces and for forces that grow without bound.
[[nodiscard]] std::optional<PairSteepness> steepness_of(const ParticlesForce& force);

/// Two particles nearer than the cutoff of a force of pairs, with the steepness at their distance.
struct SteepPair {
    std::size_t first = 0;  ///< indices in the lists
    std::size_t second = 0;
    Vec3 direction;  ///< of unit length
    PairSteepness steepness;
};
/// Returns the near pairs at which the force has a positive stiffness, so that particles could oscillate. It returns
/// none for forces without a steepness_of().
[[nodiscard]] std::vector<SteepPair> steep_pairs(const ParticlesForce& force, const ParticlesView& particles);

/// Returns true for gravity and charge without softening, whose force grows without bound as two particles approach.
[[nodiscard]] bool lacks_softening(const ParticlesForce& force);

/// Returns true for the drags of forces.h, on all particles or on some.
[[nodiscard]] bool is_drag(const Force& force);
/// Returns true for the drags of forces.h on all particles.
[[nodiscard]] bool is_drag_law(const Force& force);

/// Returns the rate, in 1/s, at which a drag damps velocity changes along the drag, from central differences. It is the
/// coefficient over the mass for linear drag, and twice that times the speed for quadratic drag.
[[nodiscard]] double damping_rate(const Force& drag, const ForceInput& input);

}  // namespace ricochet
