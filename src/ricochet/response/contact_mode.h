/// \file
/// Resting, sliding and rolling contact: what a particle does while something presses it onto a surface. Pure
/// functions.
#pragma once

#include <array>
#include <span>

#include "ricochet/core/vec3.h"
#include "ricochet/response/bounce.h"

namespace ricochet {

/// One stretch of contact with constant acceleration along the surface.
struct Stretch {
    Motion motion;           ///< at the start, along the surface
    Vec3 acceleration;       ///< along the surface, friction included, m/s^2
    Vec3 spin_acceleration;  ///< rad/s^2
    double duration = 0.0;   ///< s; shorter than asked for when slip or motion ends within, or friction turns much
    bool rolls = false;      ///< from its end on the sphere rolls without slip (set at the end of the stretch)
    bool stops = false;      ///< motion comes to a stop at the end
    bool at_rest = false;    ///< nothing moves for the whole duration
};

/// The grip of a surface while a particle is pressed on.
struct Grip {
    double friction = 0.0;          ///< Coulomb coefficient
    double rolling_friction = 0.0;  ///< see Material
    double pressure = 1.0;  ///< factor on the pressing force (a bounce cascade presses with less than the full force)
    double shortest = 0.0;  ///< s; stretches are not cut shorter than this because friction turns
    double negligible_way = 0.0;  ///< m; motion that friction ends within this way is rest already
};

/// The accelerations N_i >= 0, m/s^2, with which planes of the given unit normals (at most three) hold a particle that
/// acceleration a presses onto them: a + sum N_i n_i is what project_off() leaves of a.
[[nodiscard]] std::array<double, 3> normal_accelerations(const Vec3& a, std::span<const Vec3> normals);

/// Stretches of a step that are not cut further because friction turns: the usual 1 / Grip::shortest.
inline constexpr double kShortestStretches = 32.0;

/// Plans the contact of a particle under acceleration a with planes of the given unit normals (at most three), for at
/// most `duration` seconds: velocity and acceleration lose what presses into the planes, friction holds, brakes the
/// slip, or keeps a sphere rolling (5/7 of the acceleration) where it grips enough for that. Friction keeps its
/// direction over a stretch, so stretches end before it has turned by kMaxHeadingTurn. Against several planes at once a
/// sphere is braked like a point, its spin left alone.
[[nodiscard]] Stretch plan_stretch(const Motion& motion, double radius, const Vec3& a, std::span<const Vec3> normals,
                                   const Grip& grip, double duration);

/// The motion after `elapsed` seconds of a stretch, from what the path gave (its velocity there; the spin of before):
/// spun up, at a stop, or rolling on a surface of unit normal n where the stretch says so.
[[nodiscard]] Motion end_of_stretch(const Stretch& stretch, double elapsed, Motion motion, double radius,
                                    const Vec3& n);

/// Spin of a sphere that rolls with velocity v on a surface of unit normal n; what it had about the normal is kept.
[[nodiscard]] Vec3 rolling_spin(const Motion& motion, double radius, const Vec3& n);

/// Time that the rest of a bounce cascade takes, s: the flights 2 v e^k / pressing, k = 0, 1, ..., summed. v: rebound
/// speed; pressing: acceleration towards the surface, > 0; restitution < 1.
[[nodiscard]] double cascade_duration(double rebound_speed, double pressing, double restitution);

}  // namespace ricochet
