/// \file
/// Private to the responses: contact that lasts, as intervals of constant acceleration. A particle rests, slides, rolls
/// and spins on any number of surfaces at once as one contact problem says (coulomb_problem.h). Pure functions.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// One interval of contact with constant acceleration along the surfaces.
struct ContactInterval {
    Motion motion;           ///< at the start, along the surfaces
    Vec3 acceleration;       ///< along the surfaces, friction included, m/s^2
    Vec3 spin_acceleration;  ///< rad/s^2
    double duration = 0.0;   ///< s; shorter than asked for where slip or turning ends within, or friction turns much
    bool at_rest = false;    ///< for the whole duration its place stays, and its spin with it
    double turn = 0.0;       ///< rad, by which friction turns in it
    bool is_stiff = false;   ///< friction could end a slip, if it were against it, before the interval ends
    std::array<Vec3, kMostSupports> reaction{};  ///< force over the mass with which each surface holds it, m/s^2
    StuckSurfaces stuck{};                       ///< from the end on
    bool ends_at_once = false;  ///< a slip or turning ends within FrictionLimits::negligible_path, or jams
    bool jams = false;          ///< no friction force exists for the slip
};

/// How surfaces grip while a particle is pressed on.
struct FrictionLimits {
    double pressure = 1.0;         ///< factor on friction (a bounce cascade presses with less than the full force)
    double shortest = 0.0;         ///< s; friction that turns sooner turns by kMostHeadingTurn
    double negligible_path = 0.0;  ///< m; motion that friction ends within this distance is rest already
};

/// Returns true if a velocity leaves a surface of unit normal n by more than rounding, so that contact ends.
[[nodiscard]] bool leaves(const Vec3& velocity, const Vec3& n);

/// Plans the contact of a particle under acceleration a with surfaces that hold it (at most kMostSupports count), as if
/// their normals stayed, for at most `duration` seconds. It ends where slip, rolling or spinning comes to a stop at one
/// of them, and before friction has turned by kMaxHeadingTurn (kMostHeadingTurn where that is soon); friction has the
/// direction of the middle of the interval. If no friction force exists for a slip on surfaces at rest, the particle
/// jams: its slip stops at once. A duration of 0 gives the forces alone. stuck: surfaces on which slip and turning are
/// errors of the given motion, and count as none.
[[nodiscard]] ContactInterval plan_interval(const Motion& motion, double radius, const Vec3& a,
                                            std::span<const SupportSurface> surfaces, const FrictionLimits& grip,
                                            double duration, const StuckSurfaces& stuck = {});

/// Returns the motion at rest from which a motion just after impacts differs by no more than these leave by rounding: a
/// velocity that is nothing beside what the forces give in the duration, s, and the turning about tangents that goes
/// with it. A spin about the normal stays. Nothing where surfaces move, or where that motion would not rest.
[[nodiscard]] std::optional<Motion> rest_beside_rounding(const Motion& motion, double radius, const Vec3& a,
                                                         std::span<const SupportSurface> surfaces,
                                                         const FrictionLimits& grip, double duration);

/// As plan_interval() where the surfaces turn: with their normals as they are in the middle of the interval, for a
/// motion along `before`, the same surfaces as they are at its start. What slips and turns there is carried over to the
/// middle.
[[nodiscard]] ContactInterval plan_interval_by_middle(const Motion& motion, double radius, const Vec3& a,
                                                      std::span<const SupportSurface> before,
                                                      std::span<const SupportSurface> middle,
                                                      const FrictionLimits& grip, double duration);

/// Returns the motion after `elapsed` seconds of an interval. velocity: what the path gave there. is_over: the interval
/// has come to its end, so that slip which ends with it is gone to the last bit. The caller knows that better than
/// `elapsed`, which may be a rounded difference.
[[nodiscard]] Motion motion_after(const ContactInterval& interval, double elapsed, bool is_over, const Vec3& velocity,
                                  double radius, std::span<const SupportSurface> surfaces);

}  // namespace ricochet
