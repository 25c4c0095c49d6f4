/// \file
/// What an impact does to a motion, and what planes leave of vectors. Pure functions.
#pragma once

#include <array>
#include <span>

#include "ricochet/core/random.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// What moves: a point (radius 0, no spin) or a solid sphere (moment of inertia 2/5 m r^2).
struct Motion {
    Vec3 velocity;  ///< of the centre, m/s
    Vec3 spin;      ///< angular velocity, rad/s; zero for points
};

/// Velocity of a sphere's material at the contact on a surface of unit normal n, along the surface, m/s: what friction
/// opposes. For a point (radius 0) its own tangential velocity.
[[nodiscard]] Vec3 slip_velocity(const Motion& motion, double radius, const Vec3& n);

/// Motion after an impact with a fixed wall of unit normal n: the normal velocity is turned and scaled by the
/// restitution (Newton); the tangential impulse sticks when at most friction times the normal impulse is needed for
/// that, and slips otherwise (Coulomb). An approach (v . n >= 0) that is none is returned unchanged. A point without
/// losses (restitution 1, friction 0) keeps its speed to rounding, however often. Method: impulse-based contact of a
/// solid sphere, e.g. S. F. Foerster et al., "Measurements of the collision properties of small spheres", Physics of
/// Fluids 6, 1994.
[[nodiscard]] Motion bounce(const Motion& motion, double radius, const Vec3& n, double restitution, double friction);

/// The change of a solid sphere's spin, rad/s, by a change of its velocity, m/s, that is made at the contact on a
/// surface of unit normal n; none of a point's.
[[nodiscard]] Vec3 spin_change_by(const Vec3& velocity_change, const Vec3& n, double radius);

/// Unit direction of a diffuse reflection into the half space of n: the cosine law (Lambert, Knudsen).
[[nodiscard]] Vec3 cosine_direction(const Vec3& n, RandomSequence& random);

/// Velocity of a molecule leaving a wall of unit normal n in full thermal equilibrium; thermal_speed = sqrt(k T / m),
/// m/s. The flux-weighted Maxwell distribution: normal part Rayleigh, tangential parts Gaussian. Exponential variates
/// by comparisons only (J. von Neumann, "Various techniques used in connection with random digits", 1951), so that no
/// logarithm's last bit differs between systems.
[[nodiscard]] Vec3 thermal_velocity(const Vec3& n, double thermal_speed, RandomSequence& random);

/// The vector closest to v among those that approach none of the planes (w . n_i >= 0 for all i). At most three planes
/// count.
[[nodiscard]] Vec3 project_off(const Vec3& v, std::span<const Vec3> normals);

/// The accelerations N_i >= 0, m/s^2, with which planes of the given unit normals (at most three) hold a particle that
/// acceleration a presses onto them: a + sum N_i n_i is what project_off() leaves of a.
[[nodiscard]] std::array<double, 3> normal_accelerations(const Vec3& a, std::span<const Vec3> normals);

/// Time that the rest of a bounce cascade takes, s: the flights 2 v e^k / pressing, k = 0, 1, ..., summed. v: rebound
/// speed; pressing: acceleration towards the surface, > 0; restitution < 1.
[[nodiscard]] double cascade_duration(double rebound_speed, double pressing, double restitution);

}  // namespace ricochet
