/// \file
/// Private to the simulation: which members of a dense island are near each other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/dynamics/neighbour_pairs.h"
#include "ricochet/response/event_island.h"

namespace ricochet {

/// Pairs of members by their numbers, which change from step to step, since members stand in the order of their places.
/// Where an island is most of all particles pairs are kept by the particles' numbers, so that what NeighbourPairs keeps
/// from step to step is of use. The same pairs come out either way.
class MemberPairs {
public:
    /// boxes: of all members.
    void find(std::span<const IslandMember> members, std::span<const Box3> boxes);
    /// The same of boxes of which only those have changed, by their numbers, ascending, since the last call.
    void update(std::span<const Box3> boxes, std::span<const std::uint32_t> changed);

    /// Calls visit(a, b) for all, in any order.
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
    /// Ascending by (first, second). Valid until the next call.
    [[nodiscard]] std::span<const NeighbourPair> sorted();

private:
    void collect_numbers(std::span<const IslandMember> members);

    NeighbourPairs near_;
    bool is_by_particle_ = false;
    std::vector<std::uint32_t> slots_;      // of each member: its particle's number, from the lowest on
    std::vector<std::uint32_t> member_at_;  // of each slot
    std::vector<Box3> boxes_;               // of each slot
    std::vector<std::uint32_t> changed_;    // slots
    std::vector<NeighbourPair> by_second_;
    std::vector<NeighbourPair> sorted_;
    std::vector<std::uint32_t> first_ends_;   // of each member: where in sorted_ its pairs go
    std::vector<std::uint32_t> second_ends_;  // the same in by_second_
};

}  // namespace ricochet
