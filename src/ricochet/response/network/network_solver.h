/// \file
/// Private to the responses: the iterative contact solver. See contact_network.h for the problem.
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

/// Solves contact networks and reuses its memory. All threads solve a large network together. The result has the same
/// bits for any number of threads. Another order of the contacts changes it only within the tolerance.
class NetworkSolver {
public:
    /// Updates the bodies' velocities and spins. Contacts name bodies by their index.
    NetworkReport solve(std::span<NetworkBody> bodies, std::span<const NetworkContact> contacts,
                        const NetworkSettings& settings);
    /// Returns the impulses of the last network's contacts, in their order.
    [[nodiscard]] std::span<const NetworkImpulse> impulses() const { return impulses_; }
    /// Returns 1 for each of these contacts that restitution separates, otherwise 0.
    [[nodiscard]] std::span<const std::uint8_t> rebounds() const { return rebounds_; }

private:
    /// Number of contacts between the prefetch of a contact and its use. Contacts of one colour are scattered in
    /// memory.
    static constexpr std::size_t kPrefetchDistance = 8;

    /// Energy change of a connected impact. The fraction f of its impulses changes the energy by f (against + f
    /// curvature / 2), in J.
    struct Gain {
        double against = 0.0;
        double curvature = 0.0;
        double size = 0.0;  ///< sum of magnitudes, for the rounding error, in J

        [[nodiscard]] bool is_gain() const;
        /// Returns the largest fraction of the impulses that does not gain energy.
        [[nodiscard]] double factor() const;
    };

    /// All data that sweeps change.
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
    std::vector<NetworkState> before_;  // bodies, then walls, without contact impulses
    std::vector<NetworkState> states_;
    std::size_t bodies_ = 0;
    std::vector<NetworkRow> rows_;  // in the order of the colours
    std::vector<RollingRow> rolling_;
    std::vector<double> partings_;      // speed of each row that separates its overlap, in m/s, >= 0
    std::vector<double> restitutions_;  // own restitution of each row, not limited by its connected impact
    double against_start_ = 0.0;        // work of the start impulses at the velocities before contact, in J
    std::vector<NetworkState> last_;    // bodies before the last momentum step
    std::vector<SweepChange> blocks_;
    DirectNetwork direct_;
    double mass_ratio_ = 1.0;  // largest ratio of two masses in contact
    ConnectedImpacts impacts_;
    std::vector<Gain> gains_;  // one per connected impact; empty if impulses have changed since
    std::vector<NetworkImpulse> impulses_;
    std::vector<std::uint8_t> rebounds_;
};

}  // namespace ricochet
