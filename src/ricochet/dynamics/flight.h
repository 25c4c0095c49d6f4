/// \file
/// Path of a particle within a step, as planned by each integrator.
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
    Path path;          ///< path of the particle
    Vec3 acceleration;  ///< acceleration by the forces at the start, in m/s^2
    /// Duration, in s, for which the force has already been applied to the velocity along the path. 0 if the velocity
    /// changes gradually.
    double kick_duration = 0.0;
    ForceInput start{};  ///< state at the start of the flight; one-step methods repeat their step from this state
    Vec3 end_velocity;   ///< velocity at the end of the path, in m/s
    double next_duration = 0.0;  ///< duration, in s, that an adaptive method would try next; 0: unknown
    /// True if velocities along the path are computed by a shorter step of the method, not by the path's derivative.
    bool steps_again = false;
    // For adaptive methods:
    double shortest = 0.0;       ///< shortest allowed substep, in s, in the step that contains the flight
    std::uint32_t substeps = 0;  ///< substeps of that step so far, including this one
    bool is_coarse = false;      ///< true if the shortest allowed substep does not meet the tolerance

    [[nodiscard]] bool has_spent_substeps() const { return substeps >= kMostSubsteps; }
};

/// Returns the flight of `duration` seconds from the beginning of a step or from birth.
/// - forward_euler: a straight line with the current velocity.
/// - velocity_verlet (L. Verlet 1967; velocity form: W. C. Swope et al., J. Chem. Phys. 76, 1982): the parabola of the
///   force at the start. The force at the end is evaluated with the velocity predicted from the force at the start.
/// - symplectic_euler: one kick with the force of the whole step, then a force-free drift. An impact reflects the
/// drift,
///   and the forces do not act again in that step. Kick and drift are exact Hamiltonian flows, so the method stays
///   symplectic with elastic bounces. A second kick after an impact would lose energy of the order g * dt * speed at
///   every bounce. Source: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", 2nd ed., section VI.3.
/// - implicit_euler: the same with the force at the end of the step, found by Newton's method. It suits stiff forces,
///   and damps oscillations with periods shorter than the step. Source: E. Hairer, G. Wanner, "Solving Ordinary
///   Differential Equations II", section IV.3.
/// - ballistic: the parabola of a constant acceleration, which is evaluated again after each impact.
/// - midpoint and rk4: the cubic Hermite polynomial through both end states. The errors of the path and of the time of
///   impact are of fourth order in the duration (E. Hairer, S. P. Norsett, G. Wanner, "Solving Ordinary Differential
///   Equations I", section II.6, dense output). If the acceleration is uniform, the path is the exact parabola.
/// - dormand_prince (J. R. Dormand, P. J. Prince, J. Comput. Appl. Math. 6, 1980): the flight ends with the first
///   substep. The substep is halved until three estimates are within the tolerance: the embedded errors of position and
///   velocity, and the distance between trajectory and path (h^4 / 384 times the fourth derivative). The shortest
///   substep is kShortestSubstep of the duration.
[[nodiscard]] Flight begin_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state,
                                  double duration);
/// Returns the flight that continues after an impact, with the reflected velocity in `state`.
[[nodiscard]] Flight resume_flight(const Integrator& integrator, const ForceField& forces, const ForceInput& state,
                                   const Flight& before, double duration);
/// Returns the velocity at flight time s, in s. It is computed by a step of length s from the flight's start, because
/// the derivative of the Hermite path is less accurate by one order.
[[nodiscard]] Vec3 velocity_at(const Integrator& integrator, const ForceField& forces, const Flight& flight, double s);

/// Returns a parabola of an acceleration, in m/s^2, through the end of a flight, over the flight and beyond. If the
/// forces give this acceleration everywhere and always, and the particle hits nothing, all steps of `time_step` seconds
/// end on the parabola, up to rounding. The distance of their paths from it is at most |acceleration| time_step^2 / 8.
/// duration: in s, at least that of the flight.
[[nodiscard]] Path look_ahead_path(const Integrator& integrator, const Flight& flight, const Vec3& acceleration,
                                   double time_step, double duration);

/// Returns position and velocity at flight time s, in s. midpoint, rk4 and dormand_prince repeat a step of length s
/// from the flight's start. The other methods evaluate the flight's path.
[[nodiscard]] PhaseState state_at(const Integrator& integrator, const ForceField& forces, const Flight& flight,
                                  double s);

// Steps of particles that hit nothing: the same end state as begin_flight(), without a path.

/// One step under an acceleration that depends on neither position, velocity nor time. The object is reused for many
/// particles. The end state has the same bits as the end of the flight from begin_flight().
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

    /// Returns the state at the end of the step. A zero kick changes no bit, because flush_tiny() removes negative
    /// zeros.
    [[nodiscard]] PhaseState step(const Vec3& position, const Vec3& velocity) const {
        return {flush_tiny(position + duration_ * (velocity + drift_kick_)), velocity + kick_};
    }

    /// Returns true if the step does not change the velocity, except for the sign of zeros.
    [[nodiscard]] bool is_straight() const { return kick_ == Vec3{} && drift_kick_ == Vec3{}; }
    [[nodiscard]] double duration() const { return duration_; }

private:
    double duration_;
    Vec3 kick_;
    Vec3 drift_kick_;
};

// First-order motion: the path of a particle that moves with a flow, x' = g(x, t). Some integrators support it.

/// Piece of a path along a flow.
struct FlowPath {
    Path path;
    double next_duration = 0.0;  ///< duration, in s, that an adaptive method would try next; 0: unknown
    bool is_coarse = false;      ///< true if the shortest allowed substep does not meet the tolerance
};

/// Returns true for the methods that support first-order motion. The other methods advance position and velocity
/// separately, but first-order motion has no velocity as a state.
[[nodiscard]] bool carries_along_flows(IntegratorKind kind);

/// Returns the path from `position` at `time` over `duration` seconds (> 0). Throws InputError for a method that does
/// not support first-order motion.
/// - forward_euler: a straight line with the flow's velocity at the start.
/// - midpoint and rk4: the cubic Hermite polynomial through both ends with the flow's velocities there. The error of
///   the polynomial is of fourth order in the duration.
/// - dormand_prince: the same cubic, over the first substep. The method tries `first` seconds, and no substep shorter
///   than `shortest` seconds (0: kShortestSubstep of the duration). It halves the substep until two errors are within
///   the position tolerance: the embedded estimate, and the distance between the cubic and the method's own interpolant
///   in the middle, where it is largest (L. F. Shampine, see dormand_prince.h).
[[nodiscard]] FlowPath flow_path(const Integrator& integrator, const FlowField& flow, const Vec3& position, double time,
                                 double duration, double first, double shortest = 0.0);

}  // namespace ricochet
