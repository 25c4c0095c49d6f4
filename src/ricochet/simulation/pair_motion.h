/// \file
/// Private to the simulation: spheres that meet each other in a step.
///
/// Each sphere declares a box in which it stays if it meets none of the others. Those whose boxes overlap form islands,
/// but for two that fly freely and do not meet; PairIsland works them off, in parallel, and all others go the ordinary
/// way. A member that has met another, or has left its box, may have missed somebody: its island and those that it
/// would have met are joined and worked off again from the step's begin, until there are none.
///
/// Islands in which spheres press on each other, or in which impact would follow impact, are dense: their members are
/// planned together, by the problem of all their contacts (NetworkIsland).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/response/network/network_island.h"
#include "ricochet/response/pair_island.h"
#include "ricochet/simulation/active_mover.h"

namespace ricochet {

/// What spheres have done to each other in a step.
struct PairCounts {
    std::uint64_t impacts = 0;
    double largest_overlap = 0.0;  ///< of the spheres at the step's end, over the smaller radius
};

class PairMotion {
public:
    /// All must outlive it.
    PairMotion(ParticleStore& store, QuerySchedule& schedule, ActiveMover& mover, const Response& response,
               const PairContactSettings& settings)
        : store_(store), schedule_(schedule), mover_(mover), response_(response), settings_(settings) {}

    /// Works off the islands among the particles of the range; none of their members is moved by the ordinary way any
    /// more in this step.
    void work_off(const ParticleRange& range, const TimeSpan& step);
    /// After the others have moved: takes over where the members have gone.
    void take_over(const TimeSpan& step, std::vector<BlockRecord>& blocks);

    /// Of the last step's islands.
    [[nodiscard]] const PairCounts& counts() const { return counts_; }
    /// Impacts of the last step's islands, island by island.
    [[nodiscard]] const std::vector<PairImpactRecord>& impacts() const { return impacts_; }

    /// Islands that were dense and not solved to the tolerance, in all steps.
    [[nodiscard]] std::uint64_t unsolved() const { return unsolved_; }

    /// Saves or restores what steps have left behind; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        memory_.archive(a);
        a(unsolved_);
    }

private:
    struct Island {
        std::vector<std::uint32_t> particles;  ///< ascending
        std::vector<IslandMember> members;
        std::vector<PairImpactRecord> impacts;
        std::vector<NetworkMemory::Entry> pressed;  ///< where it is dense: what its contacts do
        bool is_unsolved = false;
    };

    [[nodiscard]] Box3 declared_box(std::size_t i, const TimeSpan& step) const;
    [[nodiscard]] double reach(std::size_t i, double duration) const;
    [[nodiscard]] bool is_bounded() const;
    void find_islands(const ParticleRange& range, const TimeSpan& step);
    [[nodiscard]] bool moves(std::uint32_t k) const;
    [[nodiscard]] bool is_free(std::uint32_t k) const { return schedule_.is_in_free_flight(first_ + k); }
    [[nodiscard]] FlownPiece way_of_free(std::uint32_t k, const TimeSpan& step) const;
    [[nodiscard]] bool may_meet(const NeighbourPair& pair, const TimeSpan& step) const;
    [[nodiscard]] bool comes_to(const IslandMember& member, std::uint32_t k, const TimeSpan& step) const;
    [[nodiscard]] std::vector<const IslandMember*> members_off_plan() const;
    [[nodiscard]] std::uint32_t root_of(std::uint32_t k);
    bool join(std::uint32_t a, std::uint32_t b);
    [[nodiscard]] std::vector<Island> islands_of(std::vector<std::uint32_t> involved);
    void run(std::vector<Island>& islands, const TimeSpan& step);
    [[nodiscard]] bool join_those_met(const TimeSpan& step);
    void take_members(Island& island, const TimeSpan& step);
    [[nodiscard]] bool may_be_dense() const;
    [[nodiscard]] bool begins_dense(const Island& island) const;
    void run_dense(Island& island, const TimeSpan& step);
    [[nodiscard]] std::vector<std::array<std::uint32_t, 2>> near_pairs(const Island& island) const;
    void rebuild(const TimeSpan& step);
    void measure_overlaps();

    ParticleStore& store_;
    QuerySchedule& schedule_;
    ActiveMover& mover_;
    const Response& response_;
    const PairContactSettings& settings_;
    std::size_t first_ = 0;  // of the range: the numbers below count from it
    NeighbourGrid grid_;
    NeighbourGrid off_plan_grid_;
    std::vector<Box3> boxes_;             // declared
    std::vector<NeighbourPair> pairs_;    // whose declared boxes overlap
    std::vector<std::uint32_t> parents_;  // of each particle of the range: union-find, the lowest number leads
    std::vector<Island> islands_;
    std::vector<PairImpactRecord> impacts_;
    PairCounts counts_;
    NetworkMemory memory_;  // of the contacts of dense islands
    std::uint64_t unsolved_ = 0;
};

}  // namespace ricochet
