/// \file
/// Integrators by name, with their settings.
#pragma once

#include <string_view>
#include <vector>

namespace ricochet {

/// Methods that a scene can name.
enum class IntegratorKind {
    forward_euler,     ///< order 1: straight lines, the velocity changes afterwards
    symplectic_euler,  ///< order 1: kick, then drift in straight lines; a bounce reflects the drift
    implicit_euler,    ///< order 1, stable for stiff forces: kick with the force at the end, then drift
    midpoint,          ///< order 2: explicit midpoint (Runge 1895)
    velocity_verlet,   ///< order 2, symplectic for forces of position: parabola, mean of the forces at both ends
    rk4,               ///< order 4: the classical Runge-Kutta method (Kutta 1901)
    dormand_prince,    ///< order 5(4), adaptive: each particle chooses its substeps by its own error
    ballistic,         ///< constant acceleration over the step: a parabola, exact for constant acceleration
};

/// Error tolerance of one adaptive substep.
struct ErrorTolerance {
    double position = 1e-6;  ///< in m, > 0; also for the path between a substep's ends
    double velocity = 1e-6;  ///< in m/s, > 0

    friend bool operator==(const ErrorTolerance&, const ErrorTolerance&) = default;
};

/// A method with its settings.
struct Integrator {
    IntegratorKind kind = IntegratorKind::ballistic;
    ErrorTolerance tolerance = {};  ///< of dormand_prince

    Integrator() = default;
    Integrator(IntegratorKind k) : kind(k) {}  // NOLINT(google-explicit-constructor): most methods have no settings
    Integrator(IntegratorKind k, const ErrorTolerance& t) : kind(k), tolerance(t) {}
    friend bool operator==(const Integrator&, const Integrator&) = default;
};

[[nodiscard]] std::string_view name_of(IntegratorKind kind);
/// Returns true for the methods that first add the whole step's force to the velocity and then drift in a straight
/// line.
[[nodiscard]] constexpr bool kicks_first(IntegratorKind kind) {
    return kind == IntegratorKind::symplectic_euler || kind == IntegratorKind::implicit_euler;
}
/// Returns all names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string_view> integrator_names();

}  // namespace ricochet
