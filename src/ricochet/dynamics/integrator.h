/// \file
/// Integrators by name, with their settings.
#pragma once

#include <string_view>
#include <vector>

namespace ricochet {

/// Integration methods that a scene can select.
enum class IntegratorKind {
    forward_euler,     ///< order 1: straight path with the old velocity, then the velocity changes
    symplectic_euler,  ///< order 1: kick, then straight drift; a bounce reflects the drift
    implicit_euler,    ///< order 1, stable for stiff forces: kick with the force at the end of the step, then drift
    midpoint,          ///< order 2: explicit midpoint (Runge 1895)
    /// Order 2: parabolic path, velocity from the mean of the forces at both ends; symplectic for forces that depend
    /// only on position.
    velocity_verlet,
    rk4,             ///< order 4: the classical Runge-Kutta method (Kutta 1901)
    dormand_prince,  ///< order 5(4), adaptive: the error of each particle determines its substeps
    ballistic,       ///< constant acceleration over the step: a parabolic path, exact if the acceleration is constant
};

/// Error tolerance of one adaptive substep.
struct ErrorTolerance {
    /// Tolerance of the position, in m, > 0; also applies to the path between the ends of a substep.
    double position = 1e-6;
    double velocity = 1e-6;  ///< tolerance of the velocity, in m/s, > 0

    friend bool operator==(const ErrorTolerance&, const ErrorTolerance&) = default;
};

/// An integration method with its settings.
struct Integrator {
    IntegratorKind kind = IntegratorKind::ballistic;
    ErrorTolerance tolerance = {};  ///< used by dormand_prince

    Integrator() = default;
    Integrator(IntegratorKind k) : kind(k) {}  // NOLINT(google-explicit-constructor): most methods have no settings
    Integrator(IntegratorKind k, const ErrorTolerance& t) : kind(k), tolerance(t) {}
    friend bool operator==(const Integrator&, const Integrator&) = default;
};

[[nodiscard]] std::string_view name_of(IntegratorKind kind);
/// Returns true for the methods that first change the velocity by the force of the whole step, and then drift in a
/// straight line.
[[nodiscard]] constexpr bool kicks_first(IntegratorKind kind) {
    return kind == IntegratorKind::symplectic_euler || kind == IntegratorKind::implicit_euler;
}
/// Returns all names, in the order of the enumeration.
[[nodiscard]] std::vector<std::string_view> integrator_names();

}  // namespace ricochet
