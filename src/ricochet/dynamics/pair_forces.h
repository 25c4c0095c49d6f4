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

// Short-range pairs: every two particles within a distance, found by a grid.

/// Two particles, as a law of pairs sees them.
struct PairState {
    double distance = 0.0;           ///< of the centres, m, > 0
    Vec3 direction;                  ///< unit, from the second to the first
    Vec3 relative_velocity;          ///< of the first against the second, m/s
    std::array<double, 2> masses{};  ///< kg
    std::array<double, 2> radii{};   ///< m
    std::array<std::uint64_t, 2> ids{};
};

/// A law of pairs as functions of the user's own. They must be pure.
struct PairLaw {
    double cutoff = 0.0;  ///< m, > 0: beyond it the force is zero
    /// The cutoff is that of the gap between the surfaces, not of the distance of the centres.
    bool between_surfaces = false;
    std::function<Vec3(const PairState&)> force;             ///< on the first, N; the second gets the opposite
    std::function<double(const PairState&)> potential = {};  ///< of the pair, J; empty: it has none
    bool depends_on_velocity = false;
};
/// Every pair is evaluated once, and its force given to both with opposite signs. Pairs are added in the order of the
/// particles. Particles at one place (distance 0) do nothing to each other.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_pair_force(PairLaw law);

struct LennardJonesSettings {
    double depth = 1.0;     ///< epsilon, J, > 0: of the well
    double diameter = 1.0;  ///< sigma, m, > 0: the distance of zero potential
    double cutoff = 2.5;    ///< in diameters, > 1
};
/// U = 4 epsilon ((sigma/r)^12 - (sigma/r)^6), cut off smoothly: the force at the cutoff is taken off everywhere, so
/// that force and potential end there without a step. Sources: J. E. Lennard-Jones, Proc. R. Soc. A 106, 1924; shifted
/// force: S. Toxvaerd, J. C. Dyre, J. Chem. Phys. 134, 2011.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_lennard_jones(const LennardJonesSettings& settings);

struct CohesionSettings {
    double stiffness = 0.0;  ///< N/m, >= 0, near contact
    double range = 0.0;      ///< m, > 0: the gap between the surfaces at which they let go
    double damping = 0.0;    ///< N s/m, >= 0, along the line of the centres, within the range
};
/// With the gap g between the surfaces of two particles: they attract each other by k g (1 - g / R)^2 for 0 < g < R
/// (at most 4/27 k R, at R/3) and push each other away by -k g where they overlap; damping is c times the speed along
/// the line, weakened by (1 - g / R)^2 too. Potential k g^2 / 2 in overlap, k R^2 (s^2/2 - 2 s^3/3 + s^4/4) with
/// s = g / R in the gap, so that all is smooth; taken from its value beyond.
[[nodiscard]] std::shared_ptr<const ParticlesForce> make_cohesion(const CohesionSettings& settings);

}  // namespace ricochet
