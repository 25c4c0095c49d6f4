/// \file
/// Private to the responses: an impact on any number of surfaces at once.
#pragma once

#include <array>
#include <span>

#include "ricochet/core/vec3.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/coulomb_problem.h"

namespace ricochet {

/// A surface that takes part.
struct ImpactSurface {
    Vec3 normal;               ///< unit, towards the particle
    double restitution = 1.0;  ///< 0..1, at this approach
    double friction = 0.0;     ///< Coulomb's coefficient
    /// As those of Material; only where the particle lands without a rebound.
    double rolling_friction = 0.0;
    double spinning_friction = 0.0;  ///< m
    /// Of its material at the contact, along the surface, m/s, and of the material's turning, rad/s; see SurfaceMotion.
    /// What it does by that is no gain.
    Vec3 velocity{};
    Vec3 angular_velocity{};
    /// m/s, with which the surface itself comes towards the particle; part of `velocity`.
    double advance = 0.0;
    /// The particle is in lasting contact with it: what it may still approach it by is rounding, and no rebound of its
    /// own follows.
    bool is_support = false;
};

/// What an impact does.
struct ImpactResult {
    static constexpr std::size_t kMostSurfaces = CoulombProblem::kMostContacts;

    Motion after;
    /// By what each surface changes the velocity, m/s: its impulse over the mass. In their order.
    std::array<Vec3, kMostSurfaces> velocity_change{};
};

/// The motion after an impact of a point (radius 0) or solid sphere with surfaces that it touches, at most
/// kMostSurfaces. One restitution, e, for all of them: the smallest of those that are approached and do not hold
/// the particle. With the normal velocities u- before and u+ after, u+ + e u- >= 0 and the impulses are >= 0, one of
/// the two zero (Moreau's law); for a surface that holds the particle u+ >= 0 takes the place of the first condition;
/// friction sticks where it can, and slips against the slip that is left otherwise. Surfaces of the same normal are
/// one. Kinetic energy never grows: in wedges that friction can hold, where this law has no answer or one that lets
/// energy in, the impulses are 1 + e times those of the impact without rebound (Poisson's law with one e for all
/// impulses: the normal velocities are the same, but slip that has been stopped comes back e times as fast). Rebounds
/// surface by surface do not have this property: in narrow wedges they multiply energy. Source: J. J. Moreau,
/// "Unilateral contact and dry friction in finite freedom dynamics", CISM 302, Springer 1988. That the other law loses
/// energy: with the impulses P and velocities u of the impact without rebound, and G their matrix, P u <= 0 and P u- =
/// P u - P G P, so P (u+ + u-) = P ((1 + e) u + (1 - e) u-) <= 0.
[[nodiscard]] ImpactResult solve_impact(const Motion& before, double radius, std::span<const ImpactSurface> surfaces);

}  // namespace ricochet
