/// \file
/// Private to the responses: solves a contact network, see contact_network.h.
#pragma once

#include <span>
#include <vector>

#include "ricochet/response/network/connected_impacts.h"
#include "ricochet/response/network/contact_coloring.h"
#include "ricochet/response/network/contact_network.h"
#include "ricochet/response/network/direct_network.h"
#include "ricochet/response/network/network_rows.h"
#include "ricochet/response/network/network_sweep.h"

namespace ricochet {

/// Keeps its memory from one network to the next. Large networks are worked on by all threads; the result has the same
/// bits for any number of them. It depends on the order of the contacts within the tolerance only.
class NetworkSolver {
public:
    /// Updates the bodies' velocities and spins. Contacts name bodies by their index.
    NetworkReport solve(std::span<NetworkBody> bodies, std::span<const NetworkContact> contacts,
                        const NetworkSettings& settings);
    /// Of the contacts of the last network, in their order.
    [[nodiscard]] std::span<const NetworkImpulse> impulses() const { return impulses_; }
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
        std::vector<NetworkRow> rows;
        std::vector<RollingRow> rolling;
        std::vector<NetworkState> states;
    };

    void set_up(std::span<const NetworkBody> bodies, std::span<const NetworkContact> contacts, double duration);
    void add_row(const NetworkContact& contact, std::span<const NetworkBody> bodies, double duration);
    void set_row(NetworkRow& row, const NetworkContact& contact, std::span<const NetworkBody> bodies, double duration);
    void add_rolling(const NetworkContact& contact, std::span<const NetworkBody> bodies);
    void apply_start();
    void add_gain(const NetworkRow& row, std::span<const NetworkState> states, double& sum) const;
    void iterate(const NetworkSettings& settings, NetworkReport& report);
    bool sweep_until(const NetworkSettings& settings, int most, NetworkReport& report);
    [[nodiscard]] SweepChange sweep(double factor);
    [[nodiscard]] SweepChange sweep_rows(double factor, std::size_t begin, std::size_t end, SweepWay way);
    void go_on(double factor);
    [[nodiscard]] bool may_rebound() const;
    [[nodiscard]] bool let_rebound();
    void rebound(std::span<const NetworkContact> contacts, const NetworkSettings& settings, NetworkReport& report);
    void find_gains();
    void take_back_gains(NetworkReport& report);
    void hand_over(std::span<NetworkBody> bodies);

    ContactColoring coloring_;
    std::vector<NetworkState> before_;  // of bodies, then walls
    std::vector<NetworkState> states_;
    std::size_t bodies_ = 0;
    std::vector<NetworkRow> rows_;  // in the order of the colours
    std::vector<RollingRow> rolling_;
    std::vector<double> partings_;      // m/s, >= 0, of the rows: with which what overlaps is parted
    std::vector<double> restitutions_;  // of the rows, without those that others of the same impact may take away
    double against_start_ = 0.0;        // J, of the impulses to begin with times what they act against before them
    std::vector<NetworkState> last_;    // of the bodies, after the sweep before the last
    std::vector<SweepChange> blocks_;
    DirectNetwork direct_;
    double mass_ratio_ = 1.0;  // largest of two that touch
    ConnectedImpacts impacts_;
    std::vector<Gain> gains_;  // of the impacts, by their numbers; empty where impulses have changed since
    std::vector<NetworkImpulse> impulses_;
    std::vector<std::uint8_t> rebounds_;
};

}  // namespace ricochet
