/// \file
/// The iterative contact solver. See contact_network.h for the problem.
#pragma once

#include <span>
#include <vector>

#include "ricochet/response/contact_solver/constraint_sweep.h"
#include "ricochet/response/contact_solver/contact_coloring.h"
#include "ricochet/response/contact_solver/contact_constraints.h"
#include "ricochet/response/contact_solver/contact_network.h"
#include "ricochet/response/contact_solver/direct_contact_solver.h"

namespace ricochet {

/// Sets of bodies that contacts with an impulse join. Each set has one restitution and one energy balance.
class ConnectedImpacts {
public:
    /// Joins the bodies of every row with a normal impulse. states: bodies, then walls. Fixed ones join nothing.
    void assign(std::span<const SolverState> states, std::span<const ContactConstraint> rows);

    /// Returns the number of a row's impact, which is less than size().
    [[nodiscard]] std::uint32_t of(const ContactConstraint& row) const {
        return of_body(fixed_[row.a] != 0 ? row.b : row.a);
    }
    [[nodiscard]] std::uint32_t of_body(std::uint32_t body) const { return leaders_[body]; }
    [[nodiscard]] std::size_t size() const { return leaders_.size(); }

private:
    std::vector<std::uint32_t> leaders_;
    std::vector<std::uint8_t> fixed_;
};

/// Solves contact networks and reuses its memory. All threads solve a large network together. The result is
/// bit-identical for any number of threads. A different order of the contacts changes it only within the tolerance.
class IterativeContactSolver {
public:
    /// Updates the bodies' velocities and spins. Contacts refer to bodies by index.
    SolverReport solve(std::span<SolverBody> bodies, std::span<const SolverContact> contacts,
                       const SolverSettings& settings);
    /// Returns the impulses of the last network's contacts, in their order.
    [[nodiscard]] std::span<const SolverImpulse> impulses() const { return impulses_; }
    /// Returns one flag per contact: 1 if restitution separates it, otherwise 0.
    [[nodiscard]] std::span<const std::uint8_t> rebounds() const { return rebounds_; }

private:
    /// Number of contacts between the prefetch of a contact and its use.
    static constexpr std::size_t kPrefetchDistance = 8;

    /// Energy change by a fraction f of a connected impact's impulses: f (against + f curvature / 2), in J.
    struct Gain {
        double against = 0.0;
        double curvature = 0.0;
        double size = 0.0;  ///< sum of magnitudes, for the rounding error, in J

        [[nodiscard]] bool is_gain() const;
        /// Returns the largest fraction of the impulses that does not gain energy, at most 1.
        [[nodiscard]] double factor() const;
    };

    /// All data that a sweep modifies, so that they can be saved and restored.
    struct Impulses {
        std::vector<ContactConstraint> rows;
        std::vector<RollingConstraint> rolling;
        std::vector<SolverState> states;
    };

    void set_up(std::span<const SolverBody> bodies, std::span<const SolverContact> contacts, double duration);
    void add_row(const SolverContact& contact, std::span<const SolverBody> bodies, double duration);
    void set_row(ContactConstraint& row, const SolverContact& contact, std::span<const SolverBody> bodies,
                 double duration);
    void add_rolling(const SolverContact& contact, std::span<const SolverBody> bodies);
    void apply_start();
    void add_work(const ContactConstraint& row, double bound, std::span<const SolverState> states, double& sum) const;
    void iterate(const SolverSettings& settings, SolverReport& report);
    bool sweep_until(const SolverSettings& settings, int most, SolverReport& report);
    [[nodiscard]] SweepChange sweep(double factor);
    void go_on(double factor);
    [[nodiscard]] bool may_rebound() const;
    [[nodiscard]] bool apply_restitution();
    void rebound(std::span<const SolverContact> contacts, const SolverSettings& settings, SolverReport& report);
    void find_gains();
    void remove_energy_gains(SolverReport& report);
    void write_back(std::span<SolverBody> bodies);

    ContactColoring coloring_;
    std::vector<SolverState> before_;  // bodies, then walls, without contact impulses
    std::vector<SolverState> states_;
    std::size_t bodies_ = 0;
    std::vector<ContactConstraint> rows_;  // in the order of the colours
    std::vector<RollingConstraint> rolling_;
    std::vector<double> partings_;      // speed at which each row separates its overlap, in m/s, >= 0
    std::vector<double> restitutions_;  // own restitution of each row, not limited by its connected impact
    double against_start_ = 0.0;        // work of the start impulses at the velocities before contact, in J
    std::vector<SolverState> last_;     // bodies before the last momentum step
    std::vector<SweepChange> blocks_;
    DirectContactSolver direct_;
    double mass_ratio_ = 1.0;  // largest ratio of two masses in contact
    ConnectedImpacts impacts_;
    std::vector<Gain> gains_;  // one per connected impact; empty if impulses have changed since
    std::vector<SolverImpulse> impulses_;
    std::vector<std::uint8_t> rebounds_;
};

}  // namespace ricochet
