/// \file
/// Private to the integrators: one step of the embedded Runge-Kutta pair of order 5 and 4.
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

/// An error, relative to the tolerance, after which twice the step will do: the fifth order makes it 32 times as large,
/// the path's fourth 16 times.
inline constexpr double kErrorToDouble = 1.0 / 64.0;

/// The published tableau: weight of stage j's derivative in stage i, and the stages' times as parts of the step. The
/// last stage stands at the end of the fifth order.
[[nodiscard]] double dormand_prince_weight(std::size_t i, std::size_t j);
[[nodiscard]] double dormand_prince_node(std::size_t i);

/// What a step may be wrong by.
struct StepErrors {
    double position = 0.0;  ///< m, by the embedded fourth order
    double velocity = 0.0;  ///< m/s
    /// Estimated largest distance, m, between the trajectory and the cubic through its end states: h^4 / 384 times the
    /// fourth derivative of the position, from a divided difference of the stages' accelerations.
    double path = 0.0;
};
/// From the velocities and accelerations of all stages of one particle.
[[nodiscard]] StepErrors estimated_errors(const std::array<Vec3, kDormandPrinceStages>& v,
                                          const std::array<Vec3, kDormandPrinceStages>& a, double h);
/// The tolerance, but no less than the rounding of the state: what is added to it below that is lost.
[[nodiscard]] ErrorTolerance attainable(const ErrorTolerance& tolerance, const Vec3& position, const Vec3& velocity);

/// The largest of them, each as a part of its tolerance.
[[nodiscard]] double relative_error(const StepErrors& errors, const ErrorTolerance& tolerance);

/// A step with what it may be wrong by.
struct EmbeddedStep {
    PhaseState end;     ///< of the fifth order
    Vec3 acceleration;  ///< at the start, m/s^2
    StepErrors errors;
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
