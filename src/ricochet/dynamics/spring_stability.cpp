#include "ricochet/dynamics/spring_stability.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {
namespace {

constexpr double kAnyStep = std::numeric_limits<double>::infinity();

/// Radii of discs around 0 whose left halves lie in the regions of stability, along the imaginary axis almost.
constexpr double kReachOfMidpoint = 1.0;
constexpr double kReachOfRk4 = 2.6;

/// Largest sums of stiffness and damping over mass of one particle.
struct Rates {
    double stiffness = 0.0;  // 1/s^2
    double damping = 0.0;    // 1/s
};

Rates largest_rates(std::span<const Spring> springs, const std::vector<Particle>& particles) {
    std::vector<Rates> sums(particles.size());
    for (const Spring& spring : springs) {
        for (const std::uint64_t end : {spring.first, spring.second}) {
            if (end >= particles.size() || particles[end].pinned) continue;
            sums[end].stiffness += spring.stiffness / particles[end].mass;
            sums[end].damping += spring.damping / particles[end].mass;
        }
    }
    Rates largest;
    for (const Rates& sum : sums) {
        largest.stiffness = std::max(largest.stiffness, sum.stiffness);
        largest.damping = std::max(largest.damping, sum.damping);
    }
    return largest;
}

/// forward_euler: every spring's own damper has to take out what its step puts in.
double damper_bound(std::span<const Spring> springs) {
    double bound = kAnyStep;
    for (const Spring& spring : springs) {
        if (spring.stiffness > 0.0) bound = std::min(bound, spring.damping / spring.stiffness);
    }
    return bound;
}

}  // namespace

double longest_stable_step(IntegratorKind kind, std::span<const Spring> springs,
                           const std::vector<Particle>& particles) {
    const Rates rates = largest_rates(springs, particles);
    const double omega_squared = 2.0 * rates.stiffness;
    const double gamma = 2.0 * rates.damping;
    const double root = std::sqrt(gamma * gamma + 4.0 * omega_squared);
    if (!(root > 0.0)) return kAnyStep;
    const double fastest = 0.5 * (gamma + root);  // no eigenvalue is larger
    switch (kind) {
        case IntegratorKind::implicit_euler:
        case IntegratorKind::dormand_prince:
            return kAnyStep;
        case IntegratorKind::forward_euler:
            return std::min(damper_bound(springs), 1.0 / fastest);
        case IntegratorKind::midpoint:
            return kReachOfMidpoint / fastest;
        case IntegratorKind::rk4:
            return kReachOfRk4 / fastest;
        default:
            return 4.0 / (gamma + root);
    }
}

}  // namespace ricochet
