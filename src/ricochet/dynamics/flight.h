/// \file
/// Path of a particle inside a step, as planned by each integrator.
#pragma once

#include <cstdint>

#include "ricochet/core/tolerances.h"
#include "ricochet/dynamics/flows.h"
#include "ricochet/dynamics/forces.h"
#include "ricochet/dynamics/integrator.h"
#include "ricochet/geometry/predicates/predicates.h"
#include "ricochet/geometry/sweep/path.h"

namespace ricochet {

/// Position and velocity, in m and m/s.
struct PhaseState {
    Vec3 position;
    Vec3 velocity;
};

/// Planned motion of a particle until the end of the step or the next impact.
struct Flight {
    Path path;          ///< the trajectory
    Vec3 acceleration;  ///< acceleration by the forces at the start, in m/s^2
    /// Duration, in s, of the force that the velocity along the path already contains; 0 if the velocity builds up.
    double kick_duration = 0.0;
    ForceInput start{};          ///< state at the start of the flight; one-step methods step from it again
    Vec3 end_velocity;           ///< velocity at the end of the path, in m/s
    double next_duration = 0.0;  ///< step, in s, that an adaptive method would try next; 0: unknown
    /// True if velocities along the path come from a shorter step instead of the path's derivative.
    bool steps_again = false;
    // For adaptive methods:
    double shortest = 0.0;       ///< shortest substep, in s, of the step that the flight belongs to
    std::uint32_t substeps = 0;  ///< substeps of that step so far, including this one
    bool is_coarse = false;      ///< the tolerance is not met, because the substep could not be shorter

    [[nodiscard]] bool has_spent_substeps() const { return substeps >= kMostSubsteps; }
};

/// Returns the flight of `duration` seconds that starts at the beginning of a step or at birth. An adaptive method may
/// end it earlier, at the end of its first substep.
///
/// forward_euler moves in a straight line with the current velocity. velocity_verlet (L. Verlet 1967; velocity form: W.
/// C. Swope et al., J. Chem. Phys. 76, 1982) follows the parabola of the first force. Forces that depend on the
/// velocity see the velocity predicted with that force.
///
/// dormand_prince (J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6, 1980) halves its step until three estimates
/// are within the tolerance: the embedded errors of position and velocity, and the distance between trajectory and path
/// (h^4 / 384 times the fourth derivative). It stops halving at the shortest allowed substep (kShortestSubstep).
///
/// symplectic_euler is a splitting: one kick with the force of the whole step, then force-free drift. An impact
/// reflects the drift, and the forces do not act again in that step. Kick and drift are each exact flows (with elastic
/// walls the drift is a billiard). The method therefore stays symplectic with bounces, and the height of an elastic
/// ball stays bounded. Another kick after each impact would lose energy of the order g * dt * speed at every bounce.
/// Source: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd ed., section VI.3 (splitting).
///
/// implicit_euler kicks with the force at the end of the step, found by Newton's method, and then drifts. An impact
/// reflects the drift, as with symplectic_euler. It is for stiff forces and damps motion that is faster than the step.
/// Source: E. Hairer, G. Wanner, "Solving Ordinary Differential Equations II", section IV.3.
///
/// ballistic keeps the acceleration constant over the step, and evaluates it again after each impact.
///
/// midpoint and rk4 make their ordinary step. The path is the cubic Hermite polynomial through both end states. Its
/// error is of fourth order in the duration, and so is the error of the time of impact (E. Hairer, S. P. Norsett, G.
/// Wanner, "Solving Ordinary Differential Equations I", section II.6, dense output). If the acceleration is uniform,
/// the path is the exact parabola.
[[nodiscard]] Flight begin_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state,
                                  double duration);
/// Returns the flight that continues after an impact, with the reflected velocity in `state`.
[[nodiscard]] Flight resume_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state,
                                   const Flight& before, double duration);
/// Returns the velocity at flight time s, in s, which an impact reflects and the end of the step stores. It is the
/// velocity of a step of length s from the flight's start, because the derivative of the Hermite path would lose an
/// order.
[[nodiscard]] Vec3 velocity_at(const Integrator& integrator, const ForceField& forces, const Flight& flight, double s);

/// Returns a parabola for an acceleration that depends on neither position, velocity nor time. If nothing is hit, the
/// ends of all further steps of `time_step` seconds lie on it, up to rounding. It begins with the flight. The flight
/// and its successors lie within |acceleration| time_step^2 / 8 of it. duration: in s, at least that of the flight.
[[nodiscard]] Path look_ahead_path(const Integrator& integrator, const Flight& flight, double time_step,
                                   double duration);

/// Returns position and velocity at flight time s, in s. midpoint, rk4 and dormand_prince step from the flight's start
/// again; the other methods evaluate the flight's path.
[[nodiscard]] PhaseState state_at(const Integrator& integrator, const ForceField& forces, const Flight& flight,
                                  double s);

// Steps of particles that hit nothing: the end state of begin_flight() without its path.

/// One step under an acceleration that depends on neither position, velocity nor time, prepared for many particles. Its
/// end state has the same bits as the end of begin_flight()'s flight.
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

    /// Returns the state at the end of the step. A kick of zero changes no bit, because flush_tiny() leaves only one
    /// kind of zero.
    [[nodiscard]] PhaseState step(const Vec3& position, const Vec3& velocity) const {
        return {flush_tiny(position + duration_ * (velocity + drift_kick_)), velocity + kick_};
    }

    /// Returns true if the velocity does not change, except for the signs of its zeros in the first step.
    [[nodiscard]] bool is_straight() const { return kick_ == Vec3{} && drift_kick_ == Vec3{}; }
    [[nodiscard]] double duration() const { return duration_; }

private:
    double duration_;
    Vec3 kick_;
    Vec3 drift_kick_;
};

// First-order motion: the path of a particle that moves with a flow, x' = g(x, t), by the integrators that support it.

/// Piece of a path along a flow.
struct FlowPath {
    Path path;
    double next_duration = 0.0;  ///< step, in s, that an adaptive method would try next; 0: unknown
    bool is_coarse = false;      ///< the tolerance is not met, because the substep could not be shorter
};

/// Returns true for the methods of first-order motion: forward_euler, midpoint, rk4 and dormand_prince. The other
/// methods step position and velocity separately, which has no meaning for first-order motion.
[[nodiscard]] bool carries_along_flows(IntegratorKind kind);

/// Returns the path from a position at a time over `duration` seconds (> 0). dormand_prince may end it earlier, at the
/// end of its first substep. It tries `first` seconds and goes no shorter than `shortest` seconds (0: kShortestSubstep
/// of the duration). Throws InputError for a method without first-order motion.
///
/// forward_euler is a straight line with the flow's velocity at the start (first order). midpoint (second order) and
/// rk4 (fourth) make their ordinary step. The path is the cubic Hermite polynomial through both ends with the flow's
/// velocities there, whose error is of fourth order in the duration.
///
/// dormand_prince halves its step until two errors are within the position tolerance. One is the embedded error
/// estimate. The other is the distance between the cubic and the method's own interpolant in the middle of the step,
/// where it is largest. The velocity tolerance plays no role. Sources: see integrator.h; interpolant: L. F. Shampine,
/// "Some practical Runge-Kutta formulas", Mathematics of Computation 46, 1986.
[[nodiscard]] FlowPath flow_path(const Integrator& integrator, const FlowField& flow, const Vec3& position, double time,
                                 double duration, double first, double shortest = 0.0);

}  // namespace ricochet
