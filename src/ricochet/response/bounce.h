/// \file
/// What an impact does to a velocity. Pure functions.
#pragma once

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

}  // namespace ricochet
