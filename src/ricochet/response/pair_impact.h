/// \file
/// What two spheres do to each other when they meet.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/response/pair_materials.h"

namespace ricochet {

/// A solid sphere, I = 2/5 m r^2, as it meets others.
struct PairBody {
    Vec3 position;                 ///< m
    Vec3 velocity;                 ///< m/s
    Vec3 spin;                     ///< rad/s
    double inverse_mass = 0.0;     ///< 1/kg; 0: nothing moves it
    double radius = 0.0;           ///< m, > 0
    double inverse_inertia = 0.0;  ///< 1/(kg m^2)
    std::uint32_t material = 0;    ///< its number
};

[[nodiscard]] PairBody pair_body(const Vec3& position, const Vec3& velocity, const Vec3& spin, double mass,
                                 double radius, bool is_fixed);

/// Two of a list of bodies that touch and approach.
struct PairContact {
    std::size_t first = 0;
    std::size_t second = 0;
    Vec3 normal{};          ///< unit, from the first to the second; set by the impact
    Vec3 impulse{};         ///< N s, given to the second; set by the impact
    double approach = 0.0;  ///< m/s, along the normal; set by the impact
};

/// m/s, with which two bodies approach along the line of their centres; below 0 where they part.
[[nodiscard]] double approach_of(const PairBody& a, const PairBody& b);

/// All contacts at once: along each normal the restitution's speed of parting or more, no pull (Moreau), and friction
/// at most mu times the normal impulse, against the slip. One contact by itself is answered in closed form: with the
/// tangential inverse mass 7/2 (1/m1 + 1/m2) of solid spheres, friction stops the slip or slides. Contacts that share
/// spheres are solved together: normal impulses by projected Gauss-Seidel to rounding; frictions from the slip that all
/// begin with, each with the part of a sphere that is its share, so that energy does not grow.
/// A rebound below resting_speed, m/s, where restitution < 1 and an approach above 0, is none.
/// Momentum and angular momentum about any point are kept to rounding (of the gap between the spheres, too), energy
/// where restitution is 1 and friction 0.
/// Sources: J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics", 1988; O. R. Walton, R. L.
/// Braun, Acta Mechanica 63, 1986 (friction of spheres); R. Tonge et al., ACM TOG 31, 2012 (mass splitting).
void resolve_pair_impacts(const PairMaterials& laws, double resting_speed, std::vector<PairBody>& bodies,
                          std::span<PairContact> contacts);

}  // namespace ricochet
