/// \file
/// Private to the simulation: the loads that sleeping islands transmit to the surfaces that support them.
///
/// A sleeper presses on surfaces with the force that it had when it fell asleep. Awake spheres beside it press on it
/// with a different force in every step, and treat it as a wall, so the difference would be lost. An island at rest
/// transmits its weight and all forces of other spheres. Their distribution inside the island does not matter.
#pragma once

#include <cstdint>
#include <map>
#include <span>

#include "ricochet/response/contact_solver/contact_island.h"
#include "ricochet/simulation/pair_parts.h"
#include "ricochet/simulation/query_schedule.h"
#include "ricochet/simulation/sleeping_islands.h"

namespace ricochet {

class TransmittedLoads {
public:
    /// islands must outlive the object.
    TransmittedLoads(const PairParts& parts, const SleepingIslands& islands) : parts_(parts), islands_(islands) {}

    /// Records the impulses of a step that islands transmit to surfaces in addition to the weights of their sleepers.
    /// impulses: impulses of awake spheres on sleepers in the step, in the order of summation.
    void pass_on(std::span<const SleeperImpulse> impulses, const TimeSpan& step);
    /// Records the momentum that particles lose when they fall asleep at the end of a step. Their supports receive it.
    void stop(std::span<const SleeperImpulse> stopped, const TimeSpan& step);

private:
    /// Balance of forces on an island, without impulses of awake spheres.
    struct Balance {
        Vec3 weight;   ///< N
        Vec3 missing;  ///< N, weight plus forces of pinned spheres, minus the forces of the sleepers on surfaces
    };
    /// Loads in N s, by the number of the island.
    using Loads = std::map<std::uint64_t, Vec3>;

    void find_balances(const TimeSpan& step);
    void share_out_all(Loads totals, std::span<const SleeperImpulse> impulses);
    void share_out(const Loads& totals);
    void add_contacts(const TimeSpan& step);

    PairParts parts_;
    const SleepingIslands& islands_;
    std::uint64_t version_ = ~std::uint64_t{0};  // version of the islands in balances_
    std::map<std::uint64_t, Balance> balances_;  // by the number of the island
};

}  // namespace ricochet
