/// \file
/// Impacts between spheres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"
#include "ricochet/response/pair_materials.h"

namespace ricochet {

/// A solid sphere in an impact with other spheres. Its moment of inertia is 2/5 m r^2.
struct PairBody {
    Vec3 position;                 ///< m
    Vec3 velocity;                 ///< m/s
    Vec3 spin;                     ///< rad/s
    double inverse_mass = 0.0;     ///< 1/kg; 0: the sphere is fixed
    double radius = 0.0;           ///< m, > 0
    double inverse_inertia = 0.0;  ///< 1/(kg m^2)
    std::uint32_t material = 0;    ///< number of its material
};

[[nodiscard]] PairBody pair_body(const Vec3& position, const Vec3& velocity, const Vec3& spin, double mass,
                                 double radius, bool is_fixed);

/// Contact of two bodies of a list that touch and approach each other.
struct PairContact {
    std::size_t first = 0;
    std::size_t second = 0;
    Vec3 normal{};          ///< unit, from the first to the second; set by the impact
    Vec3 impulse{};         ///< N s, given to the second; set by the impact
    double approach = 0.0;  ///< m/s, along the normal; set by the impact
};

/// Returns the speed, in m/s, at which two bodies approach along the line of their centres. Negative if they separate.
[[nodiscard]] double approach_of(const PairBody& a, const PairBody& b);
/// Returns the least separation speed after an impact, in m/s: 0 if a rebound with losses would be too slow.
[[nodiscard]] double rebound_speed(const PairMaterial& law, double resting_speed, double approach);

/// Resolves all contacts at once. Along each normal, the bodies separate at least at the speed given by restitution,
/// and no impulse pulls (Moreau). Friction acts against the slip and is at most mu times the normal impulse.
///
/// A single contact is solved in closed form, with the tangential inverse mass 7/2 (1/m1 + 1/m2) of solid spheres.
/// Contacts that share spheres are solved together. Their normal impulses are computed by projected Gauss-Seidel
/// iterations to rounding. Their friction impulses are computed from the slip before the impact. For friction, the mass
/// of a sphere is divided among its contacts, so that energy does not grow.
///
/// If restitution < 1, rebounds slower than resting_speed, in m/s, are suppressed. Momentum and angular momentum about
/// any point are conserved to rounding, which includes the rounding of the gap between the spheres. Energy is conserved
/// if restitution is 1 and friction 0.
///
/// Sources: J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics", 1988; O. R. Walton, R. L.
/// Braun, Acta Mechanica 63, 1986 (friction of spheres); R. Tonge et al., ACM TOG 31, 2012 (mass splitting).
void resolve_pair_impacts(const PairMaterials& laws, double resting_speed, std::vector<PairBody>& bodies,
                          std::span<PairContact> contacts);

}  // namespace ricochet
