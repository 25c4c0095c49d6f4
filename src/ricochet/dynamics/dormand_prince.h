/// \file
/// Private to the integrators: one step of the embedded Runge-Kutta pair of order 5 and 4.
///
/// Source: J. R. Dormand, P. J. Prince, "A family of embedded Runge-Kutta formulae", Journal of Computational and
/// Applied Mathematics 6, 1980 (RK5(4)7M).
#pragma once

#include "ricochet/dynamics/flow_field.h"
#include "ricochet/dynamics/integrator.h"

namespace ricochet {

/// A step with what it may be wrong by.
struct EmbeddedStep {
    PhaseState end;               ///< of the fifth order
    Vec3 acceleration;            ///< at the start, m/s^2
    double position_error = 0.0;  ///< m, by the embedded fourth order
    double velocity_error = 0.0;  ///< m/s
    /// Estimated largest distance, m, between the trajectory and the cubic through its end states: h^4 / 384 times the
    /// fourth derivative of the position, from a divided difference of the stages' accelerations.
    double path_error = 0.0;
};

[[nodiscard]] EmbeddedStep dormand_prince_step(const ForceField& forces, const ForceInput& state, double h);

/// The same of first order, x' = g(x, t).
struct EmbeddedFlowStep {
    Vec3 end;             ///< m, of the fifth order
    Vec3 start_velocity;  ///< of the flow at both ends, m/s
    Vec3 end_velocity;
    double position_error = 0.0;  ///< m, by the embedded fourth order
    /// Distance, m, between the cubic through the ends and the method's interpolant of fourth order in the middle of
    /// the step (L. F. Shampine, "Some practical Runge-Kutta formulas", Mathematics of Computation 46, 1986).
    double path_error = 0.0;
};

[[nodiscard]] EmbeddedFlowStep dormand_prince_step(const FlowField& flow, const Vec3& position, double time, double h);

}  // namespace ricochet
