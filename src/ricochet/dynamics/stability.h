/// \file
/// Private to the library: the longest steps that integrators can make with what oscillates.
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

/// No oscillation is faster, nor damped faster.
struct OscillationRates {
    double omega_squared = 0.0;  ///< 1/s^2: the largest eigenvalue of the stiffness over the masses
    double gamma = 0.0;          ///< 1/s: the same of the damping
    /// s: every oscillator's own damping over its stiffness is at least this (forward_euler needs it)
    double least_damper = std::numeric_limits<double>::infinity();
};

/// s: longer steps may explode. Infinite for implicit_euler, which needs none, and dormand_prince, which chooses its
/// own. symplectic_euler, velocity_verlet and ballistic are stable while h^2 omega^2 + 2 h gamma < 4; the Runge-Kutta
/// methods while h times the largest eigenvalue stays within their region of stability; forward_euler where every own
/// damper takes out what its step puts in. Throws InputError for a kind that does not exist.
[[nodiscard]] double longest_stable_step(IntegratorKind kind, const OscillationRates& rates);

/// Rates of the springs by Gershgorin's bound, see longest_stable_step() in springs.h.
[[nodiscard]] OscillationRates rates_of(std::span<const Spring> springs, const std::vector<Particle>& particles);

/// Factor by which a step of h seconds multiplies the energy of an oscillation with these rates: the squared modulus of
/// the method's stability polynomial at h times the eigenvalue. For the Runge-Kutta methods; 1 for the others, which
/// neither gain nor lose energy where they are stable, or damp.
[[nodiscard]] double energy_factor(IntegratorKind kind, double omega_squared, double gamma, double h);

/// What a force of forces.h does to the energy of a particle.
struct EnergyLaw {
    bool is_dissipative = false;  ///< it takes energy away, or brings some from a flow
    bool varies = false;          ///< it depends on position or velocity and has an energy to keep
    bool is_magnetic = false;     ///< a part of it depends on the velocity and does no work
    bool is_singular = false;     ///< it attracts without bound
};
/// Nothing for forces without a potential, and for those of the user's own.
[[nodiscard]] std::optional<EnergyLaw> energy_law_of(const Force& force);
/// The same of one that acts on all particles.
[[nodiscard]] std::optional<EnergyLaw> energy_law_of_law(const Force& force);

/// m, and m/s: positions and velocities up to which forces and flows are expected to give finite numbers. Farther out,
/// where methods may try states, powers of them overflow in forces that are sound.
inline constexpr double kLargestJudged = 1e25;

/// How steep a force of two particles is along their line where it is steepest of what it holds together, and what it
/// drags at most: of cohesion at contact, of lennard_jones at the distance of rest.
struct PairSteepness {
    double stiffness = 0.0;  ///< N/m
    double damping = 0.0;    ///< N s/m
};
/// Nothing for forces that are not known: those of the user's own, and those that grow without bound.
[[nodiscard]] std::optional<PairSteepness> steepness_of(const ParticlesForce& force);

/// Two particles nearer than the cutoff of a force of pairs, and how steep that is at their distance.
struct SteepPair {
    std::size_t first = 0;  ///< places in the lists
    std::size_t second = 0;
    Vec3 direction;  ///< of unit length
    PairSteepness steepness;
};
/// Returns the near pairs at which the force holds or repels, so that particles could oscillate. None for forces whose
/// steepness_of() is not known.
[[nodiscard]] std::vector<SteepPair> steep_pairs(const ParticlesForce& force, const ParticlesView& particles);

/// Gravity and charges without softening: the nearer two come to each other the more they do, without bound.
[[nodiscard]] bool lacks_softening(const ParticlesForce& force);

/// True for the drags of forces.h, on all particles or on some.
[[nodiscard]] bool is_drag(const Force& force);
/// The same on all.
[[nodiscard]] bool is_drag_law(const Force& force);

/// 1/s: how fast a drag damps velocities beside the particle's own at most, from central differences along the drag
/// itself: of a linear one its coefficient over the mass, of a quadratic one twice that times the speed.
[[nodiscard]] double damping_rate(const Force& drag, const ForceInput& input);

}  // namespace ricochet
