/// \file
/// Closed forms of contact with a single surface. Without resistance to rolling and spinning they equal the general
/// methods bit by bit (CoulombProblem, along_surfaces()), which take many times longer.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "ricochet/core/vec3.h"
#include "ricochet/response/contact_motion.h"
#include "ricochet/response/coulomb_problem.h"

namespace ricochet {

/// Most resistances of one surface: to sliding, rolling and spinning.
inline constexpr std::size_t kMostOfSurface = 3;

/// Solution of the contact problem of one surface.
struct SingleContactForces {
    double normal = 0.0;                                             ///< along the contact's direction, >= 0
    std::array<std::array<double, 2>, kMostOfSurface> resistance{};  ///< along the directions of each resistance
    MotionVector change{};                                           ///< change of the motion by all forces
};

/// Solves a contact with at most kMostOfSurface resistances. The normal force cancels the approach. Each resistance
/// removes its rate as far as its bound allows. If it is moving, it acts with its bound against the heading. `friction`
/// is a factor on the bounds, 0..1. Returns std::nullopt if the normal force depends on a resistance, or if no
/// closed form meets the conditions to kCoulombResidual. With sliding and rolling friction at their bounds, the closed
/// forms need rates of nearly one direction.
[[nodiscard]] std::optional<SingleContactForces> solve_single_contact(const CoulombContact& contact,
                                                                      std::span<const CoulombResistance> resistances,
                                                                      double friction);

/// Returns the motion nearest to the given one that is along a surface of unit normal n: along_surfaces() for one
/// surface on which nothing sticks. The velocity must not be zero. `braked_from`: as in along_surfaces(), in m/s.
[[nodiscard]] Motion along_single_surface(const Motion& motion, double radius, const Vec3& n, double braked_from);

}  // namespace ricochet
