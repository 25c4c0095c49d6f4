/// \file
/// Private to the simulation: the loads that sleeping islands transmit to the surfaces that support them.
///
/// A sleeper presses on surfaces with the force that it had when it fell asleep. Spheres beside it that are awake press
/// on it with another force in every step. For them it is a wall, so the difference would be lost. An island at rest
/// transmits its weight and all forces of others, however these are distributed inside.
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

    /// Records, for a step, the impulses of islands on surfaces beyond the weights of their sleepers. impulses: by
    /// spheres that are awake in the step, in the order of summation.
    void pass_on(const SleepingIslands& sleeping_islands, std::span<const SleeperImpulse> impulses,
                 const TimeSpan& step);

    /// Records the momentum with which particles fall asleep at the end of a step, because their supports have taken
    /// it.
    void stop(const SleepingIslands& sleeping_islands, std::span<const SleeperImpulse> stopped, const TimeSpan& step);

private:
    /// Balance of an island without impulses by spheres that are awake.
    struct Balance {
        Vec3 weight;   ///< N
        Vec3 missing;  ///< N, weight and forces of pinned spheres, less the forces of its sleepers on surfaces
    };
    void find_balances(const SleepingIslands& sleeping_islands, const TimeSpan& step);
    void share_out_all(const SleepingIslands& sleeping_islands, const std::map<std::uint64_t, Vec3>& totals);
    void share_out(const SleepingIslands& sleeping_islands, const std::map<std::uint64_t, Vec3>& totals);
    void add_contacts(const SleepingIslands& sleeping_islands, const TimeSpan& step);

    PairParts parts_;
    std::uint64_t version_ = ~std::uint64_t{0};  // of the islands in balances_
    std::map<std::uint64_t, Balance> balances_;  // by the number of the island
};

}  // namespace ricochet
