#include "ricochet/dynamics/stability.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

constexpr double kAnyStep = std::numeric_limits<double>::infinity();

/// Radii of discs around 0. The left half of each disc lies in the region of stability of the method. Close to the
/// imaginary axis this is only approximately true. The values are mathematical constants of the methods.
constexpr double kReachOfMidpoint = 1.0;
constexpr double kReachOfRk4 = 2.6;

/// Increment of the velocity in finite differences, relative to the larger of the speed and kSlow. It is large, so that
/// the jump of 0.4 % in Schiller and Naumann's coefficient does not cause a steep slope. For linear and quadratic
/// drags, any increment is exact. Local: increments of numerical derivatives, which are used only for warnings.
constexpr double kDifference = 1e-2;
constexpr double kSlow = 1e-3;  ///< in m/s

/// Returns the stability polynomial of a method. Source: E. Hairer, G. Wanner, "Solving Ordinary Differential Equations
/// II", section IV.2.
std::complex<double> stability_polynomial(IntegratorKind kind, const std::complex<double>& z) {
    switch (kind) {
        case IntegratorKind::forward_euler:
            return 1.0 + z;
        case IntegratorKind::midpoint:
            return 1.0 + z + z * z / 2.0;
        case IntegratorKind::rk4:
            return 1.0 + z + z * z / 2.0 + z * z * z / 6.0 + z * z * z * z / 24.0;
        default:
            return 1.0;
    }
}

}  // namespace

double longest_stable_step(IntegratorKind kind, const OscillationRates& rates) {
    if (name_of(kind).empty()) throw InputError("longest stable step: there is no such integrator");
    const double gamma = rates.gamma;
    const double root = std::sqrt(gamma * gamma + 4.0 * rates.omega_squared);
    if (!(root > 0.0)) return kAnyStep;
    const double fastest = 0.5 * (gamma + root);  // upper bound of the magnitudes of all eigenvalues
    switch (kind) {
        case IntegratorKind::implicit_euler:
        case IntegratorKind::dormand_prince:
            return kAnyStep;
        case IntegratorKind::forward_euler:
            return std::min(rates.least_damper, 1.0 / fastest);
        case IntegratorKind::midpoint:
            return kReachOfMidpoint / fastest;
        case IntegratorKind::rk4:
            return kReachOfRk4 / fastest;
        default:
            return 4.0 / (gamma + root);
    }
}

double energy_factor(IntegratorKind kind, double omega_squared, double gamma, double h) {
    // The result is for the eigenvalue with the larger amplification. The two eigenvalues are conjugate, or real and
    // negative.
    const std::complex<double> root = std::sqrt(std::complex<double>(0.25 * gamma * gamma - omega_squared));
    double most = 0.0;
    for (const double sign : {1.0, -1.0}) {
        const std::complex<double> z = h * (-0.5 * gamma + sign * root);
        most = std::max(most, std::norm(stability_polynomial(kind, z)));
    }
    return most;
}

double damping_rate(const Force& drag, const ForceInput& input) {
    const Vec3 pull = drag.acceleration(input);
    const double size = length(pull);
    const Vec3 along = size > 0.0 ? pull / size : Vec3{1, 0, 0};
    const double step = kDifference * std::max(length(input.velocity), kSlow);
    ForceInput ahead = input;
    ForceInput behind = input;
    ahead.velocity += step * along;
    behind.velocity -= step * along;
    return dot(drag.acceleration(behind) - drag.acceleration(ahead), along) / (2.0 * step);
}

}  // namespace ricochet
