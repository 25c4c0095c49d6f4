/// \file
/// Lasting contact as intervals of constant acceleration. A particle rests, slides, rolls and spins on any number of
/// surfaces at once, as one contact problem (coulomb_problem.h). Pure functions.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// Largest rate of decay times step of a Runge-Kutta step. Local: from the stability bound of the method, 2.78.
inline constexpr double kStageLimit = 2.5;

/// Rate of change of a sphere's slip over the acceleration of its centre, both by friction. A mathematical constant.
inline constexpr double kSlipAcceleration = 3.5;

/// One interval of contact with constant acceleration along the surfaces.
struct ContactInterval {
    Motion motion;           ///< at the start, along the surfaces
    Vec3 acceleration;       ///< along the surfaces, friction included, m/s^2
    Vec3 spin_acceleration;  ///< rad/s^2
    double duration = 0.0;   ///< s; shorter than requested if slip or rotation ends earlier, or friction turns by much
    bool at_rest = false;    ///< position and spin are constant for the whole duration
    double turn = 0.0;       ///< rad, angle by which the direction of friction turns in the interval
    bool is_stiff = false;   ///< friction could stop a motion within a fraction of the interval
    std::array<Vec3, kMostSupports> reaction{};  ///< force of each surface per unit mass, m/s^2
    StuckSurfaces stuck{};                       ///< after the end
    bool ends_at_once = false;  ///< slip or rotation ends within FrictionLimits::negligible_path, or jams
    bool jams = false;          ///< no friction force exists for the slip
};

/// Limits of friction while a particle is pressed onto surfaces.
struct FrictionLimits {
    double pressure = 1.0;  ///< factor on friction (a bounce cascade presses with less than the full force)
    /// Shortest duration of an interval, in s. If friction turns faster, it may turn by up to kMostHeadingTurn.
    double shortest = 0.0;
    double negligible_path = 0.0;  ///< m; if friction ends a motion within this distance, it counts as rest
};

/// Returns true if a velocity leads away from a surface of unit normal n by more than rounding, so that contact ends.
[[nodiscard]] bool leaves(const Vec3& velocity, const Vec3& n);

/// Plans the contact of a particle under acceleration a with surfaces that hold it, with constant normals, for at most
/// `duration`, in s. At most kMostSupports surfaces count. The interval ends when slip, rolling or spinning stops on
/// one of them, and before the direction of friction has turned by kMaxHeadingTurn (kMostHeadingTurn if it turns very
/// fast). Friction has its direction in the middle of the interval. If no friction force exists for a slip on surfaces
/// at rest, the particle jams: its slip stops at once. With a duration of 0, only the forces are computed. stuck:
/// surfaces on which slip or rotation counts as zero, because it is an error of the given motion.
[[nodiscard]] ContactInterval plan_interval(const Motion& motion, double radius, const Vec3& a,
                                            std::span<const SupportSurface> surfaces, const FrictionLimits& grip,
                                            double duration, const StuckSurfaces& stuck = {});

/// Returns the motion at rest if a motion just after impacts differs from rest only by rounding. Its velocity and
/// rotation about tangents must be negligible next to the velocity that the forces can cause in the duration, in s. The
/// result keeps the spin about the normal. Returns std::nullopt if surfaces move, or if the particle would not stay at
/// rest.
[[nodiscard]] std::optional<Motion> rest_beside_rounding(const Motion& motion, double radius, const Vec3& a,
                                                         std::span<const SupportSurface> surfaces,
                                                         const FrictionLimits& grip, double duration);

/// Plans an interval like plan_interval(), for surfaces whose normals turn. `before` contains the surfaces at the
/// start, along which the motion leads. `middle` contains the same surfaces in the middle of the interval. Forces are
/// computed with `middle`, and the initial slip and rotation are turned to the normals there.
[[nodiscard]] ContactInterval plan_interval_by_middle(const Motion& motion, double radius, const Vec3& a,
                                                      std::span<const SupportSurface> before,
                                                      std::span<const SupportSurface> middle,
                                                      const FrictionLimits& grip, double duration);

/// Returns the motion after `elapsed`, in s, of an interval. velocity: velocity of the path at that time. is_over: the
/// interval has reached its end (`elapsed` may be rounded), so slip that ends with it is exactly zero.
[[nodiscard]] Motion motion_after(const ContactInterval& interval, double elapsed, bool is_over, const Vec3& velocity,
                                  double radius, std::span<const SupportSurface> surfaces);

}  // namespace ricochet
