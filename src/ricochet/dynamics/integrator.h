/// \file
/// Integrators by name, and the path that each says a particle takes inside a step.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "ricochet/dynamics/force.h"
#include "ricochet/geometry/path.h"

namespace ricochet {

/// Methods a scene can name.
enum class IntegratorKind {
    symplectic_euler,  ///< order 1: kick, then drift in straight lines; a bounce turns the drift
    midpoint,          ///< order 2: explicit midpoint (Runge 1895)
    rk4,               ///< order 4: the classical Runge-Kutta method (Kutta 1901)
    ballistic,         ///< acceleration held over the step: a parabola, exact for constant acceleration
};

[[nodiscard]] std::optional<IntegratorKind> integrator_from_name(std::string_view name);
[[nodiscard]] std::string_view name_of(IntegratorKind kind);
/// All names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string_view> integrator_names();

/// Position and velocity, m and m/s.
struct PhaseState {
    Vec3 position;
    Vec3 velocity;
};

/// What a particle does until the end of the step, or until something is in its way.
struct Flight {
    Path path;          ///< where it goes
    Vec3 acceleration;  ///< what the forces do at the start, m/s^2
    double kick_duration =
        0.0;             ///< s of force that the velocity along the path already contains (0: none, it builds up)
    ForceInput start{};  ///< the state that the flight starts from; one-step methods step from it again
    Vec3 end_velocity;   ///< velocity at the end of the path, m/s
};

/// The flight that starts at the beginning of a step (or at birth), over `duration` seconds.
///
/// symplectic_euler is a splitting: one kick with the whole step's force, then force-free drift; an impact turns the
/// drift and the forces do not act again in that step. Kick and drift are each exact flows (with elastic walls the
/// drift is a billiard), so the method stays symplectic with bounces and an elastic ball's height stays bounded.
/// Kicking again after each impact would lose energy at every bounce in the order of g * dt * speed. Source: E. Hairer,
/// C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd ed., section VI.3 (splitting).
///
/// ballistic holds the acceleration of the step's start over the step, and evaluates it anew after each impact.
///
/// midpoint and rk4 make their ordinary step; the path is the cubic Hermite polynomial through both end states, whose
/// error of fourth order in the duration is that of the impact's time (E. Hairer, S. P. Norsett, G. Wanner, "Solving
/// Ordinary Differential Equations I", section II.6, dense output). Where the acceleration is uniform the path is the
/// exact parabola.
[[nodiscard]] Flight begin_flight(IntegratorKind kind, const ForceField& forces, const ForceInput& state,
                                  double duration);
/// The flight that goes on after an impact, with the reflected velocity in `state`.
[[nodiscard]] Flight resume_flight(IntegratorKind kind, const ForceField& forces, const ForceInput& state,
                                   const Flight& before, double duration);
/// Velocity at flight time s: what is reflected at an impact and stored at the end. For midpoint and rk4 it is that of
/// a step of length s from the flight's start: the Hermite path's own derivative would lose an order.
[[nodiscard]] Vec3 velocity_at(IntegratorKind kind, const ForceField& forces, const Flight& flight, double s);

/// Position and velocity at flight time s: midpoint and rk4 step from the flight's start again, the others are on the
/// flight's path.
[[nodiscard]] PhaseState state_at(IntegratorKind kind, const ForceField& forces, const Flight& flight, double s);

}  // namespace ricochet
