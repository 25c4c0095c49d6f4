// Stiffness and damping of the penalty response from what a scene says.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "ricochet/core/tolerances.h"
#include "ricochet/response/penalty.h"

namespace ricochet {
namespace {

/// Halvings of the bracket of a damping ratio: below the rounding of a double.
constexpr int kHalvings = 64;

/// A damping ratio beyond that of every restitution that is asked for.
constexpr double kLargestRatio = 16.0;

}  // namespace

// With zeta = sin(phi) the published formula's cases, below and above critical damping, are one analytic function:
// ln e = -2 zeta arccos(zeta) / sqrt(1 - zeta^2).
double restitution_of_damping(double ratio) {
    const double gap = 1.0 - ratio * ratio;
    double quotient = 1.0;
    if (gap > 0.0) quotient = std::acos(ratio) / std::sqrt(gap);
    if (gap < 0.0) quotient = std::acosh(ratio) / std::sqrt(-gap);
    return std::exp(-2.0 * ratio * quotient);
}

double damping_ratio(double restitution) {
    if (restitution >= 1.0) return 0.0;
    const double wanted = std::max(restitution, kMinPenaltyRestitution);
    double low = 0.0;
    double high = kLargestRatio;
    for (int k = 0; k < kHalvings; ++k) {
        const double middle = 0.5 * (low + high);
        (restitution_of_damping(middle) > wanted ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double contact_stiffness(const ResponseSettings& settings, double mass) {
    const PenaltySettings& penalty = settings.penalty;
    const double substep = settings.time_step / penalty.substeps;
    const double frequency = std::numbers::pi / (penalty.contact_steps * substep);
    return penalty.stiffness.value_or(mass * frequency * frequency);
}

ContactSpring contact_spring(const ResponseSettings& settings, double mass, double restitution) {
    const double stiffness = contact_stiffness(settings, mass);
    return {stiffness, 2.0 * damping_ratio(restitution) * std::sqrt(stiffness * mass)};
}

double longest_stable_step(const ContactSpring& spring, double mass) {
    const double frequency = std::sqrt(spring.stiffness / mass);
    const double ratio = spring.damping / (2.0 * std::sqrt(spring.stiffness * mass));
    return 2.0 / frequency * (std::sqrt(1.0 + ratio * ratio) - ratio);
}

}  // namespace ricochet
