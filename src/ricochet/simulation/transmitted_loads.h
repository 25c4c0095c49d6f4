/// \file
/// Private to the simulation: the loads that sleeping islands transmit to the surfaces that support them.
///
/// A sleeper presses on surfaces with the force that it had when it fell asleep. Awake spheres beside the sleeper press
/// on it with a different force in every step. They treat the sleeper as a wall, so the difference would be lost. An
/// island at rest transmits its weight and all forces of other spheres. Their distribution inside the island does not
/// matter.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "ricochet/response/contact_solver/contact_island.h"
#include "ricochet/simulation/pair_parts.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/sleeping_islands.h"

namespace ricochet {

class TransmittedLoads {
public:
    explicit TransmittedLoads(const PairParts& parts) : parts_(parts) {}

    /// Records the impulses of a step that islands transmit to surfaces in addition to the weights of their sleepers.
    /// impulses: impulses of awake spheres on sleepers in the step, in the order of summation.
    void pass_on(const SleepingIslands& sleeping_islands, std::span<const SleeperImpulse> impulses,
                 const TimeSpan& step);

    /// Records the momentum that particles lose when they fall asleep at the end of a step. Their supports receive this
    /// momentum.
    void stop(const SleepingIslands& sleeping_islands, std::span<const SleeperImpulse> stopped, const TimeSpan& step);

private:
    /// Balance of forces on an island, without impulses of awake spheres.
    struct Balance {
        Vec3 weight;   ///< N
        Vec3 missing;  ///< N, weight plus forces of pinned spheres, minus the forces of the sleepers on surfaces
    };
    void find_balances(const SleepingIslands& sleeping_islands, const TimeSpan& step);
    void share_out_all(const SleepingIslands& sleeping_islands, const std::map<std::uint64_t, Vec3>& totals);
    void share_out(const SleepingIslands& sleeping_islands, const std::map<std::uint64_t, Vec3>& totals);
    void add_contacts(const SleepingIslands& sleeping_islands, const TimeSpan& step);

    PairParts parts_;
    std::uint64_t version_ = ~std::uint64_t{0};  // version of the islands in balances_
    std::map<std::uint64_t, Balance> balances_;  // by the number of the island
};

}  // namespace ricochet
