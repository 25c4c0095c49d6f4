#include "ricochet/simulation/coupled_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/core/error.h"
#include "ricochet/core/parallel.h"
#include "ricochet/core/tolerances.h"

namespace ricochet {
namespace {

/// Members per unit of parallel work.
constexpr std::size_t kWatchBlock = 256;

/// Returns an energy, in J, that can result from rounding: that of springs stretched by negligible parts.
double negligible_energy(const SpringNetwork& island) {
    double sum = 0.0;
    for (const Spring& spring : island.springs()) {
        const double stretch = kNegligibleStretch * spring.rest_length;
        sum += 0.5 * spring.stiffness * stretch * stretch;
    }
    return sum;
}

}  // namespace

double kinetic_energy(const ParticleSystem& system, std::span<const Vec3> velocities) {
    return ordered_sum(system.size(), kWatchBlock, [&](std::size_t begin, std::size_t end) {
        double sum = 0.0;
        for (std::size_t k = begin; k < end; ++k) sum += 0.5 * system.mass(k) * length_squared(velocities[k]);
        return sum;
    });
}

EnergyWatch::EnergyWatch(const ParticleSystem& system, const SpringNetwork& springs, bool knows_implicit)
    : system_(system), knows_implicit_(knows_implicit), least_(negligible_energy(springs)) {}

double EnergyWatch::of(const std::vector<Vec3>& positions, const std::vector<Vec3>& velocities) const {
    return kinetic_energy(system_, velocities) + system_.spring_energy(positions);
}

// The error of the trapezoid rule can be as large as the work of a step, so the work's magnitude counts as given.
void EnergyWatch::watch(const SystemStep& step) {
    const double before = of(system_.positions(), system_.velocities());
    const double after = of(step.positions, step.velocities);
    given_ += is_watching_ ? std::max(0.0, before - after_plan_) : before;
    const auto work_of = [&](std::size_t k) {
        if (system_.is_pinned(k)) return 0.0;
        const Vec3& v0 = system_.velocities()[k];
        const Vec3& v1 = step.velocities[k];
        Vec3 pull = system_.own_acceleration(k, system_.time(), system_.positions()[k], v0) +
                    system_.own_acceleration(k, system_.time() + step.duration, step.positions[k], v1);
        pull += 2.0 * system_.expected_reaction(k);
        if (!step.mutual_start.empty()) pull += step.mutual_start[k];
        if (!step.mutual_start.empty()) pull += (step.mutual_end.empty() ? step.mutual_start : step.mutual_end)[k];
        // Uses the displacement by the mean velocity. Along the path of forward Euler, which depends only on the
        // velocity at the start, forces on a particle at rest would do no work.
        return 0.25 * step.duration * system_.mass(k) * dot(pull, v0 + v1);
    };
    const auto sum = [&](auto&& term) {
        return ordered_sum(system_.size(), kWatchBlock, [&](std::size_t begin, std::size_t end) {
            double partial = 0.0;
            for (std::size_t k = begin; k < end; ++k) partial += term(work_of(k));
            return partial;
        });
    };
    gained_ += after - before - sum([](double work) { return work; });
    given_ += sum([](double work) { return std::fabs(work); });
    after_plan_ = after;
    is_watching_ = true;
    if (!(gained_ <= kDivergedGain * (given_ + least_))) report_divergence(step);
}

void EnergyWatch::report_divergence(const SystemStep& step) const {
    const auto speed_of = [&](std::size_t k) {
        const double speed = length(step.velocities[k]);
        return std::isfinite(speed) ? speed : INFINITY;
    };
    std::size_t fastest = 0;
    for (std::size_t k = 1; k < system_.size(); ++k) {
        if (speed_of(k) > speed_of(fastest)) fastest = k;
    }
    throw DivergedError(
        fmt::format("at t = {:.6g} s the motion has diverged: particle {} would reach {:.3g} m/s, and springs and "
                    "particles hold over {} times the energy that forces and walls have given them; use a shorter "
                    "time step, {}",
                    system_.time() + step.duration, system_.id(fastest), speed_of(fastest), kDivergedGain,
                    knows_implicit_ ? "more damping, or the integrator implicit_euler"
                                    : "more damping, or weaker springs and forces between particles"));
}

}  // namespace ricochet
