/// \file
/// Private to the responses: lasting contact as intervals of constant acceleration. A particle rests, slides, rolls and
/// spins on any number of surfaces at once, as one contact problem (coulomb_problem.h). Pure functions.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "ricochet/response/along_surfaces.h"
#include "ricochet/response/contact_motion.h"

namespace ricochet {

/// Rate of decay, per step, up to which the Runge-Kutta method is used. Local: a bound of stability of its stages,
/// which is 2.78.
inline constexpr double kStageLimit = 2.5;

/// Change of a sphere's slip by friction, over the acceleration of its centre. A mathematical constant.
inline constexpr double kSlipAcceleration = 3.5;

/// One interval of contact with constant acceleration along the surfaces.
struct ContactInterval {
    Motion motion;           ///< at the start, along the surfaces
    Vec3 acceleration;       ///< along the surfaces, friction included, m/s^2
    Vec3 spin_acceleration;  ///< rad/s^2
    double duration = 0.0;   ///< s; shorter than requested if slip or rotation ends within, or friction turns much
    bool at_rest = false;    ///< position and spin are constant for the whole duration
    double turn = 0.0;       ///< rad, by which friction turns in the interval
    bool is_stiff = false;   ///< friction could end a slip against it before the interval ends
    std::array<Vec3, kMostSupports> reaction{};  ///< force over the mass by each surface, m/s^2
    StuckSurfaces stuck{};                       ///< after the end
    bool ends_at_once = false;  ///< slip or rotation ends within FrictionLimits::negligible_path, or jams
    bool jams = false;          ///< no friction force exists for the slip
};

/// Limits of friction while a particle is pressed on.
struct FrictionLimits {
    double pressure = 1.0;         ///< factor on friction (a bounce cascade presses with less than the full force)
    double shortest = 0.0;         ///< s; friction that turns sooner may turn by up to kMostHeadingTurn
    double negligible_path = 0.0;  ///< m; if friction ends a motion within this distance, it counts as rest
};

/// Returns true if a velocity leaves a surface of unit normal n by more than rounding, so that contact ends.
[[nodiscard]] bool leaves(const Vec3& velocity, const Vec3& n);

/// Plans the contact of a particle under acceleration a with surfaces that hold it, with constant normals, for at most
/// `duration`, in s. At most kMostSupports surfaces count. The interval ends when slip, rolling or spinning stops on
/// one of them, and before friction has turned by kMaxHeadingTurn. If that would be very soon, the limit is
/// kMostHeadingTurn. Friction has the direction of the middle of the interval. If no friction force exists for a slip
/// on surfaces at rest, the particle jams: its slip stops at once. A duration of 0 gives the forces alone.
/// stuck: surfaces on which slip and rotation are errors of the given motion, and count as zero.
[[nodiscard]] ContactInterval plan_interval(const Motion& motion, double radius, const Vec3& a,
                                            std::span<const SupportSurface> surfaces, const FrictionLimits& grip,
                                            double duration, const StuckSurfaces& stuck = {});

/// Returns the motion at rest to which a motion just after impacts is equal up to rounding. The given velocity, and the
/// rotation about tangents that belongs to it, must be small. They are compared with the effect of the forces in the
/// duration, in s. A spin about the normal stays. Returns std::nullopt if surfaces move, or if that motion would not
/// rest.
[[nodiscard]] std::optional<Motion> rest_beside_rounding(const Motion& motion, double radius, const Vec3& a,
                                                         std::span<const SupportSurface> surfaces,
                                                         const FrictionLimits& grip, double duration);

/// Plans as plan_interval(), for surfaces that turn: with their normals in the middle of the interval. The motion is
/// along `before`, the same surfaces at the start. Its slip and rotation there are transferred to the middle.
[[nodiscard]] ContactInterval plan_interval_by_middle(const Motion& motion, double radius, const Vec3& a,
                                                      std::span<const SupportSurface> before,
                                                      std::span<const SupportSurface> middle,
                                                      const FrictionLimits& grip, double duration);

/// Returns the motion after `elapsed`, in s, of an interval. velocity: velocity of the path at that time. is_over: the
/// interval has reached its end, so slip that ends with it is exactly zero. The caller knows that better than
/// `elapsed`, which may be a rounded difference.
[[nodiscard]] Motion motion_after(const ContactInterval& interval, double elapsed, bool is_over, const Vec3& velocity,
                                  double radius, std::span<const SupportSurface> surfaces);

}  // namespace ricochet
