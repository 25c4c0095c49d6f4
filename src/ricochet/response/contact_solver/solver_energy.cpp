// Restitution and energy balance of connected impacts.
#include <algorithm>
#include <cmath>

#include "ricochet/core/disjoint_sets.h"
#include "ricochet/core/prefetch.h"
#include "ricochet/core/tolerances.h"
#include "ricochet/response/contact_solver/iterative_contact_solver.h"

namespace ricochet {
namespace {

/// Returns the restitution of each connected impact: the smallest of its approaching contacts with an impulse, or 1 if
/// there are none. A contact without restitution that only supports a body does not count. all_own: that of each row.
std::vector<double> restitutions(const ConnectedImpacts& impacts, std::span<const SolverState> before,
                                 std::span<const ContactConstraint> rows, std::span<const double> all_own) {
    std::vector<double> least(impacts.size(), 1.0);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const ContactConstraint& row = rows[i];
        if (row.impulse.normal == 0.0) continue;
        const double separation = separation_speed_of(row, before[row.a], before[row.b]);
        if (!(separation < 0.0)) continue;
        const double own = all_own[i];
        if (own == 0.0 &&
            row.impulse.normal * inverse_mass_of(before[row.a], before[row.b]) <= -kSupportImpulseRatio * separation)
            continue;
        double& e = least[impacts.of(row)];
        e = std::min(e, own);
    }
    return least;
}

}  // namespace

// The smallest number represents each set, so one pass in ascending order finds all roots.
void ConnectedImpacts::assign(std::span<const SolverState> states, std::span<const ContactConstraint> rows) {
    DisjointSets sets(states.size());
    fixed_.resize(states.size());
    for (std::size_t i = 0; i < states.size(); ++i) fixed_[i] = states[i].inverse_mass == 0.0 ? 1 : 0;
    for (const ContactConstraint& row : rows) {
        if (row.impulse.normal != 0.0 && fixed_[row.a] == 0 && fixed_[row.b] == 0) sets.join(row.a, row.b);
    }
    leaders_.resize(states.size());
    for (std::uint32_t i = 0; i < leaders_.size(); ++i) leaders_[i] = sets.find(i);
}

bool IterativeContactSolver::may_rebound() const {
    return std::ranges::any_of(restitutions_, [](double own) { return own > 0.0; });
}

/// Solves the network with rebounds. The solution without rebound determines the connected impacts. Impacts that gain
/// energy are solved again without their rebounds.
void IterativeContactSolver::rebound(std::span<const SolverContact> contacts, const SolverSettings& settings,
                                     SolverReport& report) {
    SolverSettings first = settings;
    first.tolerance = std::max(settings.tolerance, settings.connecting);
    iterate(first, report);
    const bool any = apply_restitution();
    if (any || first.tolerance > settings.tolerance) iterate(settings, report);
    if (!any) return;
    find_gains();
    bool gained = false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (rows_[i].bound >= -partings_[i] || !gains_[impacts_.of(rows_[i])].is_gain()) continue;
        rows_[i].bound = std::max(-partings_[i], contacts[coloring_.order()[i]].gap / settings.duration);
        gained = true;
    }
    if (!gained) return;
    gains_.clear();
    iterate(settings, report);
}

/// Sets the separation speeds of contacts that rebound. Returns false if none rebounds.
bool IterativeContactSolver::apply_restitution() {
    impacts_.assign(before_, rows_);
    const std::vector<double> least = restitutions(impacts_, before_, rows_, restitutions_);
    bool any = false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        ContactConstraint& row = rows_[i];
        if (restitutions_[i] == 0.0 || row.impulse.normal == 0.0) continue;
        const double separation = separation_speed_of(row, before_[row.a], before_[row.b]);
        const double e = least[impacts_.of(row)];
        if (!(separation < 0.0) || e == 0.0) continue;
        row.bound = std::min(row.bound, e * separation);
        any = true;
    }
    return any;
}

/// Finds the connected impacts again, and the energy change of each, without the work that separates overlaps.
void IterativeContactSolver::find_gains() {
    impacts_.assign(before_, rows_);
    gains_.assign(impacts_.size(), {});
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        const ContactConstraint& row = rows_[i];
        if (row.impulse.normal == 0.0) continue;
        double before = 0.0;
        double after = 0.0;
        add_work(row, 0.0, before_, before);
        add_work(row, 0.0, states_, after);
        Gain& gain = gains_[impacts_.of(row)];
        gain.against += before - row.impulse.normal * partings_[i];
        gain.curvature += after - before;
        gain.size += std::fabs(before) + std::fabs(after);
    }
}

bool IterativeContactSolver::Gain::is_gain() const { return against + 0.5 * curvature > kNetworkEnergyRounding * size; }

double IterativeContactSolver::Gain::factor() const {
    return is_gain() ? std::clamp(-2.0 * against / curvature, 0.0, 1.0) : 1.0;
}

/// Reduces the impulses of connected impacts that gain energy because the sweeps have ended before convergence.
void IterativeContactSolver::remove_energy_gains(SolverReport& report) {
    report.energy_change = 0.0;
    bool any = false;
    for (const Gain& gain : gains_) {
        const double factor = gain.factor();
        report.energy_change += factor * (gain.against + 0.5 * factor * gain.curvature);
        any = any || factor < 1.0;
    }
    if (!any) return;
    report.is_converged = false;
    for (ContactConstraint& row : rows_) {
        const double factor = gains_[impacts_.of(row)].factor();
        row.impulse.normal *= factor;
        row.impulse.tangential *= factor;
        if (row.rolling != ContactConstraint::kNone) rolling_[row.rolling].moment *= factor;
    }
    for (std::uint32_t i = 0; i < bodies_; ++i) {
        const double factor = gains_[impacts_.of_body(i)].factor();
        if (factor == 1.0) continue;
        states_[i].velocity = before_[i].velocity + factor * (states_[i].velocity - before_[i].velocity);
        states_[i].turning = before_[i].turning + factor * (states_[i].turning - before_[i].turning);
    }
}

void IterativeContactSolver::write_back(std::span<SolverBody> bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        bodies[i].velocity = states_[i].velocity;
        if (bodies[i].radius > 0.0) bodies[i].spin = states_[i].turning / bodies[i].radius;
    }
    const std::span<const std::uint32_t> order = coloring_.order();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
        if (i + kPrefetchDistance < rows_.size()) prefetch_whole(impulses_[order[i + kPrefetchDistance]]);
        const ContactConstraint& row = rows_[i];
        rebounds_[order[i]] = row.bound < -partings_[i] ? 1 : 0;
        const bool resists_rolling = row.rolling != ContactConstraint::kNone;
        impulses_[order[i]] = {row.impulse.normal, row.impulse.tangential,
                               resists_rolling ? rolling_[row.rolling].moment : Vec3{}};
    }
}

}  // namespace ricochet
