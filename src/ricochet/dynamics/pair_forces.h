/// \file
/// Forces between particles that are near each other, defined by pair laws.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/particles_force.h"

namespace ricochet {

// Short-range forces: they act on all pairs of particles within a cutoff. A grid finds these pairs.

/// State of two particles: the input of a pair law.
struct PairState {
    double distance = 0.0;           ///< distance of the centres, in m, > 0
    Vec3 direction;                  ///< unit vector from the second to the first particle
    Vec3 relative_velocity;          ///< velocity of the first particle relative to the second, in m/s
    std::array<double, 2> masses{};  ///< in kg
    std::array<double, 2> radii{};   ///< in m
    std::array<std::uint64_t, 2> ids{};
};

/// User-defined pair law. Its functions must be pure.
struct PairLaw {
    double cutoff = 0.0;  ///< in m, > 0: the force is zero beyond it
    /// True if the cutoff applies to the gap between the surfaces, not to the distance of the centres.
    bool between_surfaces = false;
    /// Force on the first particle, in N; the opposite force acts on the second.
    std::function<Vec3(const PairState&)> force;
    /// Potential energy of the pair, in J; empty: no potential.
    std::function<double(const PairState&)> potential = {};
    bool depends_on_velocity = false;
};
/// Makes a force from a pair law. The force of every pair is computed once and acts on both particles with opposite
/// signs. The forces of the pairs are added in the order of the particles. Particles at the same position (distance 0)
/// do not interact.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_pair_force(PairLaw law);

struct LennardJonesSettings {
    double depth = 1.0;     ///< depth of the well, epsilon, in J, > 0
    double diameter = 1.0;  ///< distance of zero potential, sigma, in m, > 0
    double cutoff = 2.5;    ///< cutoff distance, in diameters, > 1
};
/// Returns the Lennard-Jones force with U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6). The value of the force at the
/// cutoff is subtracted at all distances, so force and potential are continuous at the cutoff. Sources: J. E.
/// Lennard-Jones, Proc. R. Soc. A 106, 1924; shifted force: S. Toxvaerd, J. C. Dyre, J. Chem. Phys. 134, 2011.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_lennard_jones(const LennardJonesSettings& settings);

struct CohesionSettings {
    double stiffness = 0.0;  ///< stiffness near contact, in N/m, >= 0
    double range = 0.0;      ///< gap between the surfaces at which the attraction ends, in m, > 0
    double damping = 0.0;    ///< damping along the line of the centres within the range, in N s/m, >= 0
};
/// Returns a cohesion force with stiffness k, range R and damping c. g is the gap between the surfaces of two
/// particles. For 0 < g < R the particles attract each other with the force k g (1 - g / R)^2. Its maximum is 4/27 k R,
/// at g = R/3. If the particles overlap, they repel each other with the force -k g. The damping force is c times the
/// relative speed along the line of the centres. In the gap it is also multiplied by (1 - g / R)^2.
///
/// The potential is k g^2 / 2 if the particles overlap. In the gap it is k R^2 (s^2/2 - 2 s^3/3 + s^4/4) with s = g /
/// R. The value at g = R is subtracted from both, so that force and potential are continuous.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_cohesion(const CohesionSettings& settings);

}  // namespace ricochet
