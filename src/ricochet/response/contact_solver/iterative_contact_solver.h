/// \file
/// Private to the responses: solves a contact network, see contact_network.h.
#pragma once

#include <span>
#include <vector>

#include "ricochet/response/contact_solver/connected_impacts.h"
#include "ricochet/response/contact_solver/constraint_sweep.h"
#include "ricochet/response/contact_solver/contact_coloring.h"
#include "ricochet/response/contact_solver/contact_constraints.h"
#include "ricochet/response/contact_solver/contact_network.h"
#include "ricochet/response/contact_solver/direct_contact_solver.h"

namespace ricochet {

/// Keeps its memory from one network to the next. Large networks are worked on by all threads; the result has the same
/// bits for any number of them. It depends on the order of the contacts within the tolerance only.
class IterativeContactSolver {
public:
    /// Updates the bodies' velocities and spins. Contacts name bodies by their index.
    SolverReport solve(std::span<SolverBody> bodies, std::span<const SolverContact> contacts,
                       const SolverSettings& settings);
    /// Of the contacts of the last network, in their order.
    [[nodiscard]] std::span<const SolverImpulse> impulses() const { return impulses_; }
    /// Of the same, in their order: 1 where its restitution parts the two.
    [[nodiscard]] std::span<const std::uint8_t> rebounds() const { return rebounds_; }

private:
    /// Contacts from the prefetch of one to its use: those of a colour lie anywhere among all.
    static constexpr std::size_t kPrefetchDistance = 8;

    /// Of a connected impact: with the part f of its impulses energy changes by f (against + f curvature / 2), J.
    struct Gain {
        double against = 0.0;
        double curvature = 0.0;
        double size = 0.0;  ///< J, of which rounding is a part

        [[nodiscard]] bool is_gain() const;
        /// The largest part of the impulses that gains nothing.
        [[nodiscard]] double factor() const;
    };

    /// All that sweeps change.
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
    void add_gain(const ContactConstraint& row, std::span<const SolverState> states, double& sum) const;
    void iterate(const SolverSettings& settings, SolverReport& report);
    bool sweep_until(const SolverSettings& settings, int most, SolverReport& report);
    [[nodiscard]] SweepChange sweep(double factor);
    [[nodiscard]] SweepChange sweep_rows(double factor, std::size_t begin, std::size_t end, SweepVariant variant);
    void go_on(double factor);
    [[nodiscard]] bool may_rebound() const;
    [[nodiscard]] bool apply_restitution();
    void rebound(std::span<const SolverContact> contacts, const SolverSettings& settings, SolverReport& report);
    void find_gains();
    void remove_energy_gains(SolverReport& report);
    void hand_over(std::span<SolverBody> bodies);

    ContactColoring coloring_;
    std::vector<SolverState> before_;  // of bodies, then walls
    std::vector<SolverState> states_;
    std::size_t bodies_ = 0;
    std::vector<ContactConstraint> rows_;  // in the order of the colours
    std::vector<RollingConstraint> rolling_;
    std::vector<double> partings_;      // m/s, >= 0, of the rows: with which what overlaps is parted
    std::vector<double> restitutions_;  // of the rows, without those that others of the same impact may take away
    double against_start_ = 0.0;        // J, of the impulses to begin with times what they act against before them
    std::vector<SolverState> last_;     // of the bodies, after the sweep before the last
    std::vector<SweepChange> blocks_;
    DirectContactSolver direct_;
    double mass_ratio_ = 1.0;  // largest of two that touch
    ConnectedImpacts impacts_;
    std::vector<Gain> gains_;  // of the impacts, by their numbers; empty where impulses have changed since
    std::vector<SolverImpulse> impulses_;
    std::vector<std::uint8_t> rebounds_;
};

}  // namespace ricochet
