/// \file
/// One step of the embedded Runge-Kutta pair of orders 5 and 4. Private to the integrators.
///
/// Source: J. R. Dormand, P. J. Prince, "A family of embedded Runge-Kutta formulae", Journal of Computational and
/// Applied Mathematics 6, 1980 (RK5(4)7M).
#pragma once

#include <array>
#include <cstddef>

#include "ricochet/dynamics/flight.h"
#include "ricochet/dynamics/flows.h"

namespace ricochet {

inline constexpr std::size_t kDormandPrinceStages = 7;

/// Error, relative to the tolerance, below which a step of twice the length is expected to succeed. It multiplies the
/// error of the fifth-order method by 32 and the path error by 16. Local, because only the cost depends on this value.
inline constexpr double kErrorToDouble = 1.0 / 64.0;

/// Return entries of the published tableau: the weight of stage j's derivative in stage i, and the time of stage i as a
/// fraction of the step. The last stage is evaluated at the end state of fifth order.
[[nodiscard]] double dormand_prince_weight(std::size_t i, std::size_t j);
[[nodiscard]] double dormand_prince_node(std::size_t i);

/// Error estimates of a step.
struct StepErrors {
    double position = 0.0;  ///< estimate in m, from the embedded fourth-order method
    double velocity = 0.0;  ///< in m/s
    /// Estimated largest distance, in m, between the trajectory and the cubic through its end states: h^4 / 384 times
    /// the fourth derivative of the position, from a divided difference of the stages' accelerations.
    double path = 0.0;
};
/// Estimates the errors from the velocities and accelerations of all stages of one particle.
[[nodiscard]] StepErrors estimated_errors(const std::array<Vec3, kDormandPrinceStages>& v,
                                          const std::array<Vec3, kDormandPrinceStages>& a, double h);
/// Returns the larger of the tolerance and the rounding of the state, below which no method can meet a tolerance.
[[nodiscard]] ErrorTolerance attainable(const ErrorTolerance& tolerance, const Vec3& position, const Vec3& velocity);

/// Returns the largest of the errors, each relative to its tolerance.
[[nodiscard]] double relative_error(const StepErrors& errors, const ErrorTolerance& tolerance);

/// Result of a step, with error estimates.
struct EmbeddedStep {
    PhaseState end;     ///< end state of fifth order
    Vec3 acceleration;  ///< acceleration at the start, in m/s^2
    StepErrors errors;
};

[[nodiscard]] EmbeddedStep dormand_prince_step(const ForceField& forces, const ForceInput& state, double h);

/// Result of a step of first-order motion, x' = g(x, t), with error estimates.
struct EmbeddedFlowStep {
    Vec3 end;             ///< end position of fifth order, in m
    Vec3 start_velocity;  ///< velocity of the flow at the start, in m/s
    Vec3 end_velocity;
    double position_error = 0.0;  ///< estimate in m, from the embedded fourth-order method
    /// Distance, in m, in the middle of the step between the cubic through the ends and the method's fourth-order
    /// interpolant (L. F. Shampine, "Some practical Runge-Kutta formulas", Mathematics of Computation 46, 1986).
    double path_error = 0.0;
};

[[nodiscard]] EmbeddedFlowStep dormand_prince_step(const FlowField& flow, const Vec3& position, double time, double h);

}  // namespace ricochet
