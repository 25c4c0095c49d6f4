/// \file
/// Forces between particles that are near each other: laws of pairs.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>

#include "ricochet/core/vec3.h"
#include "ricochet/dynamics/particles_force.h"

namespace ricochet {

// Short-range pairs: all pairs of particles within a distance, found by a grid.

/// Two particles, as seen by a law of pairs.
struct PairState {
    double distance = 0.0;           ///< of the centres, in m, > 0
    Vec3 direction;                  ///< unit vector from the second to the first
    Vec3 relative_velocity;          ///< of the first against the second, in m/s
    std::array<double, 2> masses{};  ///< in kg
    std::array<double, 2> radii{};   ///< in m
    std::array<std::uint64_t, 2> ids{};
};

/// Law of pairs as user functions, which must be pure.
struct PairLaw {
    double cutoff = 0.0;  ///< in m, > 0: the force is zero beyond it
    /// True if the cutoff limits the gap between the surfaces instead of the distance of the centres.
    bool between_surfaces = false;
    std::function<Vec3(const PairState&)> force;             ///< on the first, in N; the second gets the opposite
    std::function<double(const PairState&)> potential = {};  ///< of the pair, in J; empty: no potential
    bool depends_on_velocity = false;
};
/// Makes a force from a law of pairs. Every pair is evaluated once, and its force acts on both particles with opposite
/// signs. Pairs are added in the order of the particles. Particles at the same position (distance 0) do not interact.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_pair_force(PairLaw law);

struct LennardJonesSettings {
    double depth = 1.0;     ///< depth of the well, epsilon, in J, > 0
    double diameter = 1.0;  ///< distance of zero potential, sigma, in m, > 0
    double cutoff = 2.5;    ///< in diameters, > 1
};
/// Returns the Lennard-Jones force with U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6). The force at the cutoff is
/// subtracted everywhere, so force and potential end there without a step. Sources: J. E. Lennard-Jones, Proc. R. Soc.
/// A 106, 1924; shifted force: S. Toxvaerd, J. C. Dyre, J. Chem. Phys. 134, 2011.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_lennard_jones(const LennardJonesSettings& settings);

struct CohesionSettings {
    double stiffness = 0.0;  ///< near contact, in N/m, >= 0
    double range = 0.0;      ///< gap between the surfaces at which the attraction ends, in m, > 0
    double damping = 0.0;    ///< along the line of the centres, within the range, in N s/m, >= 0
};
/// Returns a cohesion force with the gap g between the surfaces of two particles. They attract each other by k g (1 - g
/// / R)^2 for 0 < g < R. The maximum is 4/27 k R, at R/3. In overlap they repel each other by -k g. Damping is c times
/// the speed along the line, also weakened by (1 - g / R)^2.
///
/// The potential is k g^2 / 2 in overlap. In the gap it is k R^2 (s^2/2 - 2 s^3/3 + s^4/4) with s = g / R. Both are
/// measured from the value beyond the range, so that force and potential are continuous.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_cohesion(const CohesionSettings& settings);

}  // namespace ricochet
