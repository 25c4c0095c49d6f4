/// \file
/// Impacts of a motion on planes, and projections of vectors onto planes. Pure functions.
#pragma once

#include <array>
#include <span>

#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"
#include "ricochet/response/impact_law.h"

namespace ricochet {

/// Motion of a point (radius 0, no spin) or a solid sphere (moment of inertia 2/5 m r^2).
struct Motion {
    Vec3 velocity;  ///< of the centre, m/s
    Vec3 spin;      ///< angular velocity, rad/s; zero for points
};

/// Returns the velocity of a sphere's material at the contact, along a surface of unit normal n, in m/s. Friction
/// opposes it. For a point (radius 0), it is the point's tangential velocity.
[[nodiscard]] Vec3 slip_velocity(const Motion& motion, double radius, const Vec3& n);

/// Returns the motion after an impact on a fixed wall of unit normal n. The normal velocity is reversed and scaled by
/// the restitution (Newton). The contact sticks if the tangential impulse needed is at most friction times the normal
/// impulse. Otherwise it slips (Coulomb). A sticking contact reverses the slip velocity, scaled by the tangential
/// restitution (Walton). Finally the tangential velocity of the centre is scaled by the tangential factor. A motion
/// that does not approach the wall (v . n >= 0) is returned unchanged. A point without losses (restitution 1, friction
/// 0) keeps its speed to rounding over any number of bounces. Method: impulse-based contact of a solid sphere, e.g. S.
/// F. Foerster et al., "Measurements of the collision properties of small spheres", Physics of Fluids 6, 1994.
[[nodiscard]] Motion bounce(const Motion& motion, double radius, const Vec3& n, const ImpactLaw& law);

/// Returns the change of a solid sphere's spin, in rad/s, by a velocity change, in m/s. The impulse acts at the contact
/// on a surface of unit normal n. Zero for a point.
[[nodiscard]] Vec3 spin_change_by(const Vec3& velocity_change, const Vec3& n, double radius);

/// Returns the unit direction of a diffuse reflection into the half space of n: the cosine law (Lambert, Knudsen).
[[nodiscard]] Vec3 cosine_direction(const Vec3& n, RandomSequence& random);

/// Returns the velocity of a molecule that leaves a wall of unit normal n in full thermal equilibrium. thermal_speed =
/// sqrt(k T / m), in m/s. The distribution is the flux-weighted Maxwell distribution: Rayleigh along the normal,
/// Gaussian along the tangents. Exponential variates use comparisons only (J. von Neumann, "Various techniques used in
/// connection with random digits", 1951), because the last bit of a logarithm differs between systems.
[[nodiscard]] Vec3 thermal_velocity(const Vec3& n, double thermal_speed, RandomSequence& random);

/// Returns the vector w closest to v that approaches none of the planes (w . n_i >= 0), of which at most three count.
[[nodiscard]] Vec3 project_off(const Vec3& v, std::span<const Vec3> normals);

/// Returns the reactions N_i >= 0, in m/s^2, of planes of the given unit normals (at most three) to a particle's
/// acceleration a. The sum a + sum N_i n_i equals project_off(a).
[[nodiscard]] std::array<double, 3> normal_accelerations(const Vec3& a, std::span<const Vec3> normals);

/// Returns the duration of the rest of a bounce cascade, in s: the sum of the flights 2 v e^k / pressing, k = 0, 1, ...
/// v: rebound speed; pressing: acceleration towards the surface, > 0; restitution < 1.
[[nodiscard]] double cascade_duration(double rebound_speed, double pressing, double restitution);

}  // namespace ricochet
