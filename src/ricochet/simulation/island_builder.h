/// \file
/// Private to the simulation: islands of spheres that meet each other in a step, and what each of them does.
///
/// Those that may meet, by what they declare (PairPlans), form islands, which are worked off in parallel: impact by
/// impact (EventIsland), or by the problem of all contacts (ContactIslands). A member that has done something else than
/// it has declared may have missed somebody: its island and those that it would have met are joined and worked off
/// again from the step's begin, in rounds, until there are none.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/core/disjoint_sets.h"
#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/response/event_island.h"
#include "ricochet/simulation/contact_islands.h"
#include "ricochet/simulation/lasting_contacts.h"
#include "ricochet/simulation/pair_parts.h"
#include "ricochet/simulation/pair_plans.h"

namespace ricochet {

class IslandBuilder {
public:
    struct Island {
        std::vector<std::uint32_t> particles;  ///< numbers in the range, ascending
        std::vector<IslandMember> members;     ///< by place
        std::vector<PairImpactRecord> impacts;
        std::vector<PairMeeting> meetings;
        bool is_contact_island = false;
        ContactIslandTrace trace;
        std::size_t round = 0;  ///< in which it has been worked off
    };

    /// All must outlive it.
    IslandBuilder(const PairParts& parts, PairPlans& plans, const LastingContacts& contacts)
        : parts_(parts), plans_(plans), contacts_(contacts), contact_islands_(parts, contacts) {}

    /// Works off the islands among the particles of a range, whose plans have been found.
    void solve(const ParticleRange& range, const TimeSpan& step);
    /// Those of this step, in the order of their lowest particles, without members that have flown freely.
    [[nodiscard]] std::vector<Island>& all() { return islands_; }

private:
    /// Members that may have met others than those of their island.
    struct OutOfBoundsMembers {
        std::vector<const IslandMember*> members;
        std::vector<Box3> swept;        ///< by them
        std::size_t of_this_round = 0;  ///< so many come first
    };

    void find_islands(const ParticleRange& range);
    bool join(std::uint32_t a, std::uint32_t b);
    [[nodiscard]] std::vector<Island> islands_of(const std::vector<std::uint32_t>& involved);
    void run(const TimeSpan& step);
    void collect_members(Island& island, const TimeSpan& step);
    [[nodiscard]] bool is_out_of_bounds(const Island& island, const IslandMember& member) const;
    [[nodiscard]] OutOfBoundsMembers members_out_of_bounds() const;
    [[nodiscard]] static bool may_have_met(const IslandMember& first, const IslandMember& second);
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> met_by(const OutOfBoundsMembers& off);
    [[nodiscard]] bool join_those_met();
    [[nodiscard]] std::vector<std::uint32_t> members_joined();
    void rebuild(const TimeSpan& step);

    PairParts parts_;
    PairPlans& plans_;
    const LastingContacts& contacts_;
    ContactIslands contact_islands_;
    std::size_t first_ = 0;  // of the range: numbers count from it
    std::vector<Island> islands_;
    DisjointSets sets_;  // particles of the range; the lowest number of an island represents it
    std::vector<std::uint8_t> is_involved_;
    std::vector<std::size_t> island_of_;  // by the particle that leads it
    std::size_t round_ = 0;               // of joining islands
    std::vector<std::uint32_t> joined_;   // in the last round
    NeighbourGrid out_of_bounds_grid_;
    NeighbourGrid first_off_plan_grid_;  // of the members that were off their plans in the first round
    std::vector<const IslandMember*> first_out_of_bounds_;
    std::vector<std::uint32_t> first_numbers_;  // of these
    std::vector<std::uint8_t> has_run_anew_;    // by number, in a later round
};

}  // namespace ricochet
