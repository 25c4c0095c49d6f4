/// \file
/// An impact on any number of surfaces at once.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "ricochet/core/vec3.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/coulomb_problem.h"

namespace ricochet {

/// A surface that takes part in the impact.
struct ImpactSurface {
    Vec3 normal;               ///< unit, towards the particle
    double restitution = 1.0;  ///< 0..1, at this approach speed
    double friction = 0.0;     ///< Coulomb coefficient
    /// Resistance to rolling and spinning, as in Material. Used only for a landing without a rebound.
    double rolling_friction = 0.0;
    double spinning_friction = 0.0;  ///< m
    /// Velocity of the surface and its material at the contact, in m/s, and angular velocity of the material, in rad/s;
    /// see SurfaceMotion. The work that the surface does by this motion does not count as a gain of energy.
    Vec3 velocity{};
    Vec3 angular_velocity{};
    /// Speed of the surface towards the particle, in m/s; part of `velocity`.
    double advance = 0.0;
    /// True in lasting contact. An approach speed is then a rounding error and causes no rebound of its own.
    bool is_support = false;
    double tangential_restitution = 0.0;  ///< 0..1, see ImpactLaw
    double tangential_factor = 1.0;       ///< 0..1, see ImpactLaw
    double static_friction = 0.0;         ///< see ImpactLaw
};

/// Result of an impact.
struct ImpactResult {
    static constexpr std::size_t kMostSurfaces = CoulombProblem::kMostContacts;

    Motion after;
    /// Velocity change by each surface, in m/s (its impulse per unit mass), in the order of the surfaces.
    std::array<Vec3, kMostSurfaces> velocity_change{};
    /// Velocity change by the tangential factor, in m/s, which acts at the centre, and the number of its surface.
    Vec3 slowing{};
    std::size_t slowed_by = 0;
};

/// Returns the motion after an impact of a point (radius 0) or solid sphere with surfaces that it touches, at most
/// kMostSurfaces. Surfaces with the same normal count as one. Kinetic energy never grows.
///
/// All surfaces use one restitution e: the smallest among the approached surfaces that do not support the particle. Let
/// u- and u+ be the normal velocities before and after the impact. Then u+ + e u- >= 0, the impulses are >= 0, and one
/// of the two is zero (Moreau's law). For a supporting surface, the first condition is u+ >= 0. Friction stops the slip
/// if possible. A single hit surface, beside supporting ones, also reverses the slip with its tangential restitution.
/// Otherwise friction acts against the remaining slip. A contact that slips after all has the friction of slip, other
/// contacts the static one. Finally, the smallest tangential factor scales the part of the velocity that is tangential
/// to all surfaces.
///
/// In wedges in which friction can hold a particle, this law may have no solution, or one that adds energy. The
/// impulses are then 1 + e times the impulses of the impact without rebound (Poisson's law with one e for all
/// impulses). The normal velocities are the same as with Moreau's law, but slip that friction stops returns with e
/// times its speed, without tangential restitution. Separate rebounds from one surface after another are not used,
/// because they multiply energy in narrow wedges.
///
/// Poisson's law adds no energy. Proof with the impulses P and velocities u of the impact without rebound, and their
/// matrix G: P u <= 0 and P u- = P u - P G P, so P (u+ + u-) = P ((1 + e) u + (1 - e) u-) <= 0. Source: J. J. Moreau,
/// "Unilateral contact and dry friction in finite freedom dynamics", CISM 302, Springer 1988.
[[nodiscard]] ImpactResult solve_impact(const Motion& before, double radius, std::span<const ImpactSurface> surfaces);

}  // namespace ricochet
