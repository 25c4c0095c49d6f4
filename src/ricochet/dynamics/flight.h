/// \file
/// The path that each integrator says a particle takes inside a step.
#pragma once

#include <cstdint>

#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Position and velocity, m and m/s.
struct PhaseState {
    Vec3 position;
    Vec3 velocity;
};

/// What a particle does until the end of the step, or until it hits something.
struct Flight {
    Path path;          ///< where it goes
    Vec3 acceleration;  ///< what the forces do at the start, m/s^2
    double kick_duration =
        0.0;             ///< s of force that the velocity along the path already contains (0: none, it builds up)
    ForceInput start{};  ///< the state that the flight starts from; one-step methods step from it again
    Vec3 end_velocity;   ///< velocity at the end of the path, m/s
    double next_duration = 0.0;  ///< s that an adaptive method would try next; 0: no idea
    bool steps_again = false;    ///< velocities along the path are those of a shorter step, not the path's derivative
    // Of adaptive methods:
    double shortest = 0.0;       ///< s, the shortest sub-step of the step that the flight belongs to
    std::uint32_t substeps = 0;  ///< of that step so far, with this one
    bool is_coarse = false;      ///< the tolerance is not kept: the sub-step could not be shorter

    [[nodiscard]] bool has_spent_substeps() const { return substeps >= kMostSubsteps; }
};

/// The flight that starts at the beginning of a step (or at birth), over `duration` seconds; an adaptive method may end
/// it earlier, at the end of its first sub-step.
///
/// forward_euler goes straight on with the velocity that it has. velocity_verlet (L. Verlet 1967; velocity form: W. C.
/// Swope et al., J. Chem. Phys. 76, 1982) flies the parabola of the first force; forces that depend on the velocity see
/// the one predicted with it.
///
/// dormand_prince (J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6, 1980) halves its step until the embedded
/// error estimates of position and velocity and the estimated distance between trajectory and path, h^4 / 384 times the
/// fourth derivative, are within the tolerance, or the sub-step is as short as it may be (kShortestSubstep).
///
/// symplectic_euler is a splitting: one kick with the whole step's force, then force-free drift; an impact turns the
/// drift and the forces do not act again in that step. Kick and drift are each exact flows (with elastic walls the
/// drift is a billiard), so the method stays symplectic with bounces and an elastic ball's height stays bounded.
/// Kicking again after each impact would lose energy at every bounce in the order of g * dt * speed. Source: E. Hairer,
/// C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd ed., section VI.3 (splitting).
///
/// implicit_euler kicks with the force at the end of the step, found by Newton's method, and drifts; an impact turns
/// the drift as with symplectic_euler. It damps what is faster than the step and is for stiff forces. Source: E.
/// Hairer, G. Wanner, "Solving Ordinary Differential Equations II", section IV.3.
///
/// ballistic holds the acceleration of the step's start over the step, and evaluates it anew after each impact.
///
/// midpoint and rk4 make their ordinary step; the path is the cubic Hermite polynomial through both end states, whose
/// error of fourth order in the duration is that of the impact's time (E. Hairer, S. P. Norsett, G. Wanner, "Solving
/// Ordinary Differential Equations I", section II.6, dense output). Where the acceleration is uniform the path is the
/// exact parabola.
[[nodiscard]] Flight begin_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state,
                                  double duration);
/// The flight that goes on after an impact, with the reflected velocity in `state`.
[[nodiscard]] Flight resume_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state,
                                   const Flight& before, double duration);
/// Velocity at flight time s: what is reflected at an impact and stored at the end. It is that of a step of length s
/// from the flight's start: the Hermite path's own derivative would lose an order.
[[nodiscard]] Vec3 velocity_at(const Integrator& integrator, const ForceField& forces, const Flight& flight, double s);

/// For an acceleration that depends on neither position, velocity nor time: the parabola on which the ends of all
/// further steps of `time_step` seconds lie, up to rounding, if nothing is hit. It begins with the flight,
/// which and whose successors lie within |acceleration| time_step^2 / 8 of it. duration >= that of the flight, s.
[[nodiscard]] Path look_ahead_path(const Integrator& integrator, const Flight& flight, double time_step,
                                   double duration);

/// Position and velocity at flight time s: midpoint, rk4 and dormand_prince step from the flight's start again, the
/// others are on the flight's path.
[[nodiscard]] PhaseState state_at(const Integrator& integrator, const ForceField& forces, const Flight& flight,
                                  double s);

// Steps of particles that hit nothing: where begin_flight() would lead to, without its path.

/// One step under an acceleration that depends on neither position, velocity nor time, prepared for many particles. The
/// state after it has the same bits as the end of begin_flight()'s flight.
class FreeFlight {
public:
    /// acceleration in m/s^2, duration in s.
    FreeFlight(const Integrator& integrator, const Vec3& acceleration, double duration)
        : duration_(duration), kick_(duration * acceleration) {
        if (kicks_first(integrator.kind)) {
            drift_kick_ = kick_;
        } else if (integrator.kind != IntegratorKind::forward_euler) {
            drift_kick_ = (0.5 * duration) * acceleration;
        }
    }

    /// The state at the end of the step. A kick of zero changes no bit: flush_tiny() knows but one zero.
    [[nodiscard]] PhaseState step(const Vec3& position, const Vec3& velocity) const {
        return {flush_tiny(position + duration_ * (velocity + drift_kick_)), velocity + kick_};
    }

    /// True when the velocity stays: only its zeros may change their sign, with the first step.
    [[nodiscard]] bool is_straight() const { return kick_ == Vec3{} && drift_kick_ == Vec3{}; }
    [[nodiscard]] double duration() const { return duration_; }

private:
    double duration_;
    Vec3 kick_;
    Vec3 drift_kick_;
};

// First-order motion: the path of a particle that goes with a flow, x' = g(x, t), by the integrators that have a
// meaning there.

/// A piece of path along a flow.
struct FlowPath {
    Path path;
    double next_duration = 0.0;  ///< s that an adaptive method would try next; 0: no idea
    bool is_coarse = false;      ///< the tolerance is not kept: the sub-step could not be shorter
};

/// True for the methods of first-order motion: forward_euler, midpoint, rk4 and dormand_prince. The others step
/// position and velocity separately and have no meaning here.
[[nodiscard]] bool carries_along_flows(IntegratorKind kind);

/// The path from a position at a time over `duration` seconds (> 0); dormand_prince may end it earlier, at the end of
/// its first sub-step, for which it tries `first` seconds, and that it makes no shorter than `shortest` seconds (0:
/// kShortestSubstep of the duration). Throws InputError for a method that has no meaning here.
///
/// forward_euler is a straight line with the flow's velocity at the start (first order). midpoint (second order) and
/// rk4 (fourth) make their ordinary step; the path is the cubic Hermite polynomial through both ends with the flow's
/// velocities there, whose error is of fourth order in the duration. dormand_prince halves its step until the embedded
/// estimate of its error and the distance between that cubic and the method's own interpolant in the middle of the
/// step, where it is largest, are within the tolerance of the position; that of the velocity plays no role. Sources: as
/// in integrator.h; interpolant: L. F. Shampine, "Some practical Runge-Kutta formulas", Mathematics of Computation 46,
/// 1986.
[[nodiscard]] FlowPath flow_path(const Integrator& integrator, const FlowField& flow, const Vec3& position, double time,
                                 double duration, double first, double shortest = 0.0);

}  // namespace ricochet
