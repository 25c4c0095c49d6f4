#include "simulation/book_bounds.h"

#include <cmath>
#include <numbers>

namespace ricochet::test {
namespace RICOCHET_FILE {

/// The bounds that theory gives for springs at a step h, with what a run has come to.
struct SpringTheory {
    double h;         ///< s
    double speed;     ///< m/s, more than which the energy does not allow
    double contacts;  ///< bounces; with penalty, steps of those

    /// Largest rate of an oscillation, 1/s: twice two springs over the mass (Gershgorin).
    [[nodiscard]] static double rate() { return std::sqrt(4.0 * kStiffness / kMass); }

    /// J, that a bounce makes: it leads off the plan by 2 v t at most in what is left of the step, which is
    /// k (2 v h)^2 / 6 for each of two springs, twice where it is the work on both ends.
    [[nodiscard]] double energy_of_bounces() const {
        return contacts * 2.0 * 2.0 * kStiffness * std::pow(2.0 * speed * h, 2) / 6.0;
    }
    /// J, by which a method's own energy moves off the true one, for an oscillation that has all of it: what the
    /// amplification |R| of a step makes of it in n steps, and for symplectic methods what their own Hamiltonian
    /// differs by (E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical Integration", IX.3).
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

/// J, by which penalties may miss: walls are springs of half a period of `contact_steps` sub-steps, whatever the step,
/// and a bounce is half an oscillation by the scene's method. Forward Euler's growth goes on from bounce to bounce.
double energy_of_penalties(const BookCase& c, double contacts) {
    if (c.response != ResponseKind::penalty) return 0.0;
    const double steps = PenaltySettings{}.contact_steps;
    const double z = std::numbers::pi / steps;
    const double of_each = contacts * kEnergy / kParticles;
    // A child that is born within a wall is pushed out as its parent would be, by as much energy as its mass has at 2
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

/// N s, that springs give the other end of what a wall has swallowed until they are lost at the end of the step, and
/// that nobody holds up: at most by two springs that hold all of the energy.
double pulls_of_swallowed(const BookCase& c, const BookedRun& run) {
    if (!c.has(Feature::springs)) return 0.0;
    const double pull = std::sqrt(2.0 * kEnergy * kStiffness);
    return 2.0 * pull * c.time_step * static_cast<double>(run.swallowed().count);
}

/// J, of springs that hang on what walls swallow, and of penalties: what is swallowed at the end of the sub-step in
/// which it has entered a wall has at most v h of the way in, and of its energy the part (omega h)^2, pi /
/// contact_steps, in the wall's spring.
double lost_with_swallowed(const BookCase& c, const BookedRun& run) {
    if (!c.has(Feature::absorbing)) return 0.0;
    if (c.has(Feature::springs)) return run.start().energy;
    if (c.response != ResponseKind::penalty) return 0.0;
    const double z = std::numbers::pi / PenaltySettings{}.contact_steps;
    return z * z * kEnergy / kParticles * static_cast<double>(run.swallowed().count);
}

}  // namespace RICOCHET_FILE

/// Without springs and penalties particles fly straight and bounce elastically. Springs give momentum to either end
/// alike, whatever it does, but to what a wall has swallowed.
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
