#include "simulation/book_bounds.h"

#include <cmath>
#include <numbers>

namespace ricochet::test {
namespace {

/// Theoretical error bounds for springs at a step h, from the results of a run.
struct SpringTheory {
    double h;         ///< s
    double speed;     ///< m/s, an upper bound from the energy
    double contacts;  ///< number of bounces; with penalty, number of steps in contact

    /// Returns the largest angular frequency, in 1/s: twice two springs over the mass (Gershgorin).
    [[nodiscard]] static double rate() { return std::sqrt(4.0 * kStiffness / kMass); }

    /// Returns the energy, in J, that bounces may add. A bounce deviates from the plan by at most 2 v t in the rest of
    /// the step. This changes each of two springs by k (2 v h)^2 / 6, and by twice that if both ends do work.
    [[nodiscard]] double energy_of_bounces() const {
        return contacts * 2.0 * 2.0 * kStiffness * std::pow(2.0 * speed * h, 2) / 6.0;
    }
    /// Returns the energy error of a method, in J, for an oscillation that has all of the energy. It follows from the
    /// amplification |R| of a step over n steps. For symplectic methods it is the difference of their own Hamiltonian
    /// (E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", IX.3).
    [[nodiscard]] double energy_of(IntegratorKind kind) const {
        const double z = rate() * h;
        const double steps = kDuration / h;
        switch (kind) {
            case IntegratorKind::forward_euler:
                return kEnergy * std::expm1(steps * z * z);
            case IntegratorKind::symplectic_euler:
                return 0.5 * z * kEnergy;
            case IntegratorKind::midpoint:
                return kEnergy * std::expm1(steps * z * z * z * z / 4.0);
            case IntegratorKind::rk4:
                return kEnergy * steps * std::pow(z, 6) / 72.0;
            case IntegratorKind::implicit_euler:
                return kEnergy * steps * z * z;
            case IntegratorKind::dormand_prince:
                return kEnergy * steps * 1e-6;  // its tolerance
            default:
                return 0.25 * z * z * kEnergy;  // velocity Verlet
        }
    }
};

/// Returns the energy error, in J, of penalties. Walls are springs with half a period of `contact_steps` substeps for
/// any step, and a bounce is half an oscillation of the scene's method. The growth of forward Euler continues from
/// bounce to bounce.
double energy_of_penalties(const BookCase& c, double contacts) {
    if (c.response != ResponseKind::penalty) return 0.0;
    const double steps = PenaltySettings{}.contact_steps;
    const double z = std::numbers::pi / steps;
    const double of_each = contacts * kEnergy / kParticles;
    // A child that is born inside a wall is pushed out like its parent. This adds at most the energy of its mass at 2
    // m/s.
    const double born = c.has(Feature::children) ? contacts * 0.5 * kChildMass * 4.0 : 0.0;
    switch (c.integrator) {
        case IntegratorKind::forward_euler:
            return kEnergy * std::expm1(4.0 * steps * z * z) + born;
        case IntegratorKind::symplectic_euler:
            return 0.5 * z * of_each + born;
        case IntegratorKind::midpoint:
            return of_each * std::expm1(steps * std::pow(z, 4) / 4.0) + born;
        case IntegratorKind::rk4:
            return of_each * steps * std::pow(z, 6) / 72.0 + born;
        default:
            return 0.25 * z * z * of_each + born;
    }
}

/// Returns the momentum, in N s, that springs give to the other end of an absorbed particle until they are removed at
/// the end of the step. Nothing balances it. The bound is two springs that have all of the energy.
double pulls_of_swallowed(const BookCase& c, const BookedRun& run) {
    if (!c.has(Feature::springs)) return 0.0;
    const double pull = std::sqrt(2.0 * kEnergy * kStiffness);
    return 2.0 * pull * c.time_step * static_cast<double>(run.swallowed().count);
}

/// Returns the energy, in J, lost with springs of absorbed particles and in penalties. A particle is absorbed at the
/// end of the substep in which it enters a wall. It is then at most v h deep, so the wall's spring has the fraction
/// (omega h)^2 of its energy, with omega h = pi / contact_steps.
double lost_with_swallowed(const BookCase& c, const BookedRun& run) {
    if (!c.has(Feature::absorbing)) return 0.0;
    if (c.has(Feature::springs)) return run.start().energy;
    if (c.response != ResponseKind::penalty) return 0.0;
    const double z = std::numbers::pi / PenaltySettings{}.contact_steps;
    return z * z * kEnergy / kParticles * static_cast<double>(run.swallowed().count);
}

}  // namespace

/// Returns the bounds of one run. Without springs and penalties, particles fly straight and bounce elastically. Springs
/// give opposite momentum to their two ends, except to absorbed particles.
BookBounds bounds_of(const BookCase& c, const BookedRun& run) {
    const SimulationStatistics& statistics = run.simulation().statistics();
    const double speed = std::sqrt(2.0 * run.start().energy / kMass);
    const auto contacts = static_cast<double>(statistics.contacts);
    const SpringTheory theory{c.time_step, speed, contacts};
    BookBounds bounds;
    bounds.momentum = 1e-12 + pulls_of_swallowed(c, run);
    bounds.energy = 1e-11 + energy_of_penalties(c, contacts);
    if (c.has(Feature::springs)) bounds.energy += theory.energy_of(c.integrator) + theory.energy_of_bounces();
    bounds.launched = 0.5 * kMass * static_cast<double>(statistics.shattered) * kLaunch * kLaunch;
    bounds.lost = lost_with_swallowed(c, run);
    return bounds;
}

}  // namespace ricochet::test
