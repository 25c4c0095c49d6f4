/// \file
/// Private to the simulation: pairs of members of a contact island that are near each other.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/dynamics/neighbour_pairs.h"
#include "ricochet/response/event_island.h"

namespace ricochet {

/// Pairs of members, given by member numbers. Members are ordered by position, so their numbers change from step to
/// step. In an island with most of the particles, pairs are stored by particle numbers instead. NeighbourPairs can then
/// reuse its data in the next step. Both methods give the same pairs.
class MemberPairs {
public:
    /// Finds the pairs of members whose boxes overlap. boxes: one per member.
    void find(std::span<const IslandMember> members, std::span<const Box3> boxes);
    /// Updates the pairs. changed: numbers of the boxes that have changed since the last call, ascending.
    void update(std::span<const Box3> boxes, std::span<const std::uint32_t> changed);

    /// Calls visit(a, b) for all pairs, in any order.
    template <class Visit>
    void for_each(const Visit& visit) const {
        for (const auto& [first, second] : near_.all()) {
            if (is_by_particle_) {
                visit(member_at_[first], member_at_[second]);
            } else {
                visit(first, second);
            }
        }
    }
    /// Returns the pairs, ascending by (first, second). The result is valid until the next call.
    [[nodiscard]] std::span<const NeighbourPair> sorted();

private:
    void collect_numbers(std::span<const IslandMember> members);

    NeighbourPairs near_;
    bool is_by_particle_ = false;
    std::vector<std::uint32_t> slots_;      // per member: its particle number minus the lowest particle number
    std::vector<std::uint32_t> member_at_;  // per slot: its member
    std::vector<Box3> boxes_;               // of each slot
    std::vector<std::uint32_t> changed_;    // slots
    std::vector<NeighbourPair> by_second_;
    std::vector<NeighbourPair> sorted_;
    std::vector<std::uint32_t> first_ends_;   // per member: end of its pairs in sorted_
    std::vector<std::uint32_t> second_ends_;  // per member: end of its pairs in by_second_
};

}  // namespace ricochet
