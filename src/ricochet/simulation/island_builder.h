/// \file
/// Private to the simulation: islands of spheres that meet each other in a step, and their solution.
///
/// Spheres form an island if they may meet within their declared bounds (PairPlans). Islands are solved in parallel:
/// impact by impact (EventIsland), or as one problem of all contacts (ContactIslands). If a member leaves its bounds,
/// it may have missed collisions with spheres outside. The island is then joined with those that it would have met, and
/// solved again from the start of the step, in rounds until no islands are joined.
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
        std::vector<IslandMember> members;     ///< ordered by position
        std::vector<PairImpactRecord> impacts;
        std::vector<PairMeeting> meetings;
        bool is_contact_island = false;
        ContactIslandTrace trace;
        std::size_t round = 0;  ///< round in which the island was solved
    };

    /// All arguments must outlive the object.
    IslandBuilder(const PairParts& parts, PairPlans& plans, const LastingContacts& contacts)
        : parts_(parts), plans_(plans), contacts_(contacts), contact_islands_(parts, contacts) {}

    /// Solves the islands among the particles of a range. The plans of these particles must have been found.
    void solve(const ParticleRange& range, const TimeSpan& step);
    /// Returns the islands of this step by their lowest particle numbers, without members that have met no other.
    [[nodiscard]] std::vector<Island>& all() { return islands_; }

private:
    /// Members that have left their declared bounds, and may have met spheres outside their island.
    struct OutOfBoundsMembers {
        std::vector<const IslandMember*> members;
        std::vector<Box3> swept;        ///< boxes of their paths
        std::size_t of_this_round = 0;  ///< number of members of this round, which come first
    };

    void find_islands(const ParticleRange& range);
    bool join(std::uint32_t a, std::uint32_t b);
    [[nodiscard]] std::vector<Island> islands_of(const std::vector<std::uint32_t>& involved);
    void run(const TimeSpan& step);
    void collect_members(Island& island, const TimeSpan& step);
    void solve(Island& island, EventIsland& worker, MoveScratch& scratch, const TimeSpan& step);
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
    std::size_t first_ = 0;  // first particle of the range; particle numbers are relative to it
    std::vector<Island> islands_;
    DisjointSets sets_;  // particles of the range; the lowest number of an island represents it
    std::vector<std::uint8_t> is_involved_;
    std::vector<std::size_t> island_of_;  // index of an island, by the particle that represents it
    std::size_t round_ = 0;               // number of the present round of joining islands
    std::vector<std::uint32_t> joined_;   // particles that the last round has joined
    NeighbourGrid out_of_bounds_grid_;
    NeighbourGrid first_off_plan_grid_;  // of the members out of bounds in the first round
    std::vector<const IslandMember*> first_out_of_bounds_;
    std::vector<std::uint32_t> first_numbers_;  // particle numbers of first_out_of_bounds_
    std::vector<std::uint8_t> has_run_anew_;    // by particle number: 1 if solved again in a later round
};

}  // namespace ricochet
