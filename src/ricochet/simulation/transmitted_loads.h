/// \file
/// Private to the simulation: what sleeping piles pass on to the surfaces that they lie on.
///
/// A sleeper presses on surfaces with what it pressed with when it fell asleep. Spheres beside it that are awake press
/// on it otherwise in every step, and for them it is a wall: what changes so would be lost. A pile at rest passes on
/// its weight and all that others push it with, however that is shared out inside.
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

    /// Enters, for a step, what piles do to surfaces beyond the weights of their sleepers. pushes: of those that are
    /// awake in the step, in the order in which they are added up.
    void pass_on(const SleepingIslands& sleeping_islands, std::span<const SleeperImpulse> impulses,
                 const TimeSpan& step);

    /// Enters the momentum with which particles fall asleep at the end of a step: what holds them has taken it.
    void stop(const SleepingIslands& sleeping_islands, std::span<const SleeperImpulse> stopped, const TimeSpan& step);

private:
    /// Of a pile without pushes.
    struct Balance {
        Vec3 weight;   ///< N
        Vec3 missing;  ///< N, its weight, and what pinned spheres do to it, less what its sleepers press with
    };
    void find_balances(const SleepingIslands& sleeping_islands, const TimeSpan& step);
    void share_out_all(const SleepingIslands& sleeping_islands, const std::map<std::uint64_t, Vec3>& totals);
    void share_out(const SleepingIslands& sleeping_islands, const std::map<std::uint64_t, Vec3>& totals);
    void add_contacts(const SleepingIslands& sleeping_islands, const TimeSpan& step);

    PairParts parts_;
    std::uint64_t version_ = ~std::uint64_t{0};  // of the piles of which balances are
    std::map<std::uint64_t, Balance> balances_;  // by the number of the pile
};

}  // namespace ricochet
