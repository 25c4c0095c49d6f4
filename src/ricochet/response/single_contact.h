/// \file
/// Closed forms of contact with a single surface. They equal the general methods bit by bit (CoulombProblem,
/// along_surfaces()), which take many times longer.
#pragma once

#include <array>
#include <optional>

#include "ricochet/core/vec3.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/coulomb_problem.h"

namespace ricochet {

/// Solution of the contact problem of one surface.
struct SingleContactForces {
    double normal = 0.0;                 ///< along the contact's direction, >= 0
    std::array<double, 2> tangential{};  ///< along the directions of friction
    MotionVector change{};               ///< change of the motion by both
};

/// Solves a contact without resistance (`slip` is null), or with friction. The normal force cancels the approach.
/// Friction removes the slip as far as its bound allows. For a moving slip, it acts with its bound against the heading.
/// `friction` is a factor on the bound, 0..1. Returns std::nullopt if the directions depend on each other, or rounding
/// leaves more than kCoulombResidual.
[[nodiscard]] std::optional<SingleContactForces> solve_single_contact(const CoulombContact& contact,
                                                                      const CoulombResistance* slip, double friction);

/// Returns the motion nearest to the given one that is along a surface of unit normal n: along_surfaces() for one
/// surface on which nothing sticks. The velocity must not be zero. `braked_from`: as in along_surfaces(), in m/s.
[[nodiscard]] Motion along_single_surface(const Motion& motion, double radius, const Vec3& n, double braked_from);

}  // namespace ricochet
