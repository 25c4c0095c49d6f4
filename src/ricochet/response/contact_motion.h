/// \file
/// What contact does to a motion: impacts, and resting, sliding and rolling while something presses a particle onto a
/// surface. Pure functions.
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

/// Surfaces that hold a particle at one time, at most.
inline constexpr std::size_t kMostHolding = 3;

/// A surface that holds a particle.
struct HoldingSurface {
    Vec3 normal;                    ///< unit, towards the particle
    double friction = 0.0;          ///< Coulomb coefficient
    double rolling_friction = 0.0;  ///< see Material
    /// What the surface's curvature adds to the rates, m/s^2: of the distance, and of the slip.
    double bend = 0.0;
    Vec3 slip_bend{};
};

/// What does not move at a surface.
struct Stuck {
    bool to_slip = false;
    bool to_turning = false;  ///< resistance to rolling holds it
};

/// One interval of contact with constant acceleration along the surface.
struct ContactInterval {
    Motion motion;           ///< at the start, along the surface
    Vec3 acceleration;       ///< along the surface, friction included, m/s^2
    Vec3 spin_acceleration;  ///< rad/s^2
    double duration = 0.0;   ///< s; shorter than asked for when slip or motion ends within, or friction turns much
    bool rolls = false;      ///< from its end on the sphere rolls without slip (set at the end of the interval)
    bool stops = false;      ///< motion comes to a stop at the end
    bool at_rest = false;    ///< nothing moves for the whole duration
    /// Of several surfaces: with what force over the mass each holds, m/s^2, and what is stuck from the end on.
    std::array<Vec3, kMostHolding> push{};
    std::array<Stuck, kMostHolding> stuck{};
};

/// How surfaces grip while a particle is pressed on.
struct Grip {
    double pressure = 1.0;  ///< factor on the pressing force (a bounce cascade presses with less than the full force)
    double shortest = 0.0;  ///< s; intervals are not cut shorter than this because friction turns
    double negligible_path = 0.0;  ///< m; motion that friction ends within this distance is rest already
};

/// The accelerations N_i >= 0, m/s^2, with which planes of the given unit normals (at most three) hold a particle that
/// acceleration a presses onto them: a + sum N_i n_i is what project_off() leaves of a.
[[nodiscard]] std::array<double, 3> normal_accelerations(const Vec3& a, std::span<const Vec3> normals);

/// Intervals of a step that are not cut further because friction turns: the usual 1 / Grip::shortest.
inline constexpr double kShortestIntervals = 32.0;

/// Plans the contact of a particle under acceleration a with surfaces that hold it (at most kMostHolding), as if they
/// were flat, for at most `duration` seconds: velocity and acceleration lose what presses into them, friction holds,
/// brakes the slip, or keeps a sphere rolling (on one surface 5/7 of the acceleration) where it grips enough for that.
/// Friction keeps its direction over an interval, so intervals end before it has turned by kMaxHeadingTurn.
[[nodiscard]] ContactInterval plan_interval(const Motion& motion, double radius, const Vec3& a,
                                            std::span<const HoldingSurface> surfaces, const Grip& grip,
                                            double duration);

/// The motion after `elapsed` seconds of an interval, from what the path gave (its velocity there; the spin of before):
/// spun up, at a stop, or rolling where the interval says so.
[[nodiscard]] Motion end_of_interval(const ContactInterval& interval, double elapsed, Motion motion, double radius,
                                     std::span<const HoldingSurface> surfaces);

/// Spin of a sphere that rolls with velocity v on a surface of unit normal n; what it had about the normal is kept.
[[nodiscard]] Vec3 rolling_spin(const Motion& motion, double radius, const Vec3& n);

/// Time that the rest of a bounce cascade takes, s: the flights 2 v e^k / pressing, k = 0, 1, ..., summed. v: rebound
/// speed; pressing: acceleration towards the surface, > 0; restitution < 1.
[[nodiscard]] double cascade_duration(double rebound_speed, double pressing, double restitution);

}  // namespace ricochet
