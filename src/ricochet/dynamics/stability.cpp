#include "ricochet/dynamics/stability.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/core/error.h"

namespace ricochet {
namespace {

constexpr double kAnyStep = std::numeric_limits<double>::infinity();

/// Radii of discs around 0 whose left halves lie in the regions of stability, along the imaginary axis almost.
constexpr double kReachOfMidpoint = 1.0;
constexpr double kReachOfRk4 = 2.6;

}  // namespace

double longest_stable_step(IntegratorKind kind, const OscillationRates& rates) {
    if (name_of(kind).empty()) throw InputError("longest stable step: there is no such integrator");
    const double gamma = rates.gamma;
    const double root = std::sqrt(gamma * gamma + 4.0 * rates.omega_squared);
    if (!(root > 0.0)) return kAnyStep;
    const double fastest = 0.5 * (gamma + root);  // no eigenvalue is larger
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

}  // namespace ricochet
