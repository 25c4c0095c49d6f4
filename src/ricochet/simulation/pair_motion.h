/// \file
/// Private to the simulation: spheres that meet each other in a step.
///
/// Those that may meet, by what they declare (PairPlans), form islands; PairIsland works them off, in parallel, and all
/// others go the ordinary way. A member that has done something else than it has declared may have missed somebody: its
/// island and those that it would have met are joined and worked off again from the step's begin, until there are none.
///
/// Islands in which spheres press on each other, or in which impact would follow impact, are dense: their members are
/// planned together, by the problem of all their contacts (NetworkIsland). What has lain still there for a while sleeps
/// (SleepingPiles): nothing moves it, until it is hit, or pressed otherwise than when it fell asleep.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/response/network/network_island.h"
#include "ricochet/response/pair_island.h"
#include "ricochet/simulation/active_mover.h"
#include "ricochet/simulation/pair_plans.h"
#include "ricochet/simulation/sleeping_piles.h"

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
        : store_(store),
          schedule_(schedule),
          mover_(mover),
          response_(response),
          settings_(settings),
          plans_(store, schedule, mover, response, settings.method != PairMethod::events) {
        mover_.set_piles(&piles_);
    }

    /// Works off the islands among the particles of the range; none of their members is moved by the ordinary way any
    /// more in this step.
    void work_off(const ParticleRange& range, const TimeSpan& step);
    /// After the others have moved: takes over where the members have gone.
    void take_over(const TimeSpan& step, std::vector<BlockRecord>& blocks);

    /// Of the last step's islands.
    [[nodiscard]] const PairCounts& counts() const { return counts_; }
    /// Impacts of the last step's islands, island by island.
    [[nodiscard]] const std::vector<PairImpactRecord>& impacts() const { return impacts_; }
    /// The same for the verifier, where there is one.
    [[nodiscard]] const std::vector<PairMeeting>& meetings() const { return meetings_; }

    /// Islands that were dense and not solved to the tolerance, in all steps.
    [[nodiscard]] std::uint64_t unsolved() const { return unsolved_; }

    /// Wakes all spheres that sleep on others, at a time, s: what holds them may change.
    void wake_all(double time);

    /// Saves or restores what steps have left behind; a: an archive of core/binary_archive.h.
    template <class Archive>
    void archive(Archive& a) {
        memory_.archive(a);
        piles_.archive(a);
        a(unsolved_);
    }

private:
    struct Island {
        std::vector<std::uint32_t> particles;  ///< ascending
        std::vector<IslandMember> members;
        std::vector<PairImpactRecord> impacts;
        std::vector<PairMeeting> meetings;
        std::vector<NetworkMemory::Entry> pressed;  ///< where it is dense: what its contacts do
        bool is_dense = false;
        bool is_unsolved = false;
        std::vector<SleepingPiles::Still> still;  ///< where it is dense: those that have not moved
        std::vector<std::uint64_t> falling_asleep;
        std::vector<SleepingPiles::Weight> weights;  ///< of those
        std::size_t round = 0;                       ///< in which it has been worked off
    };
    /// Members that may have met others than those of their island.
    struct OffPlan {
        std::vector<const IslandMember*> members;
        std::vector<Box3> swept;        ///< by them
        std::size_t of_this_round = 0;  ///< so many come first
    };

    void find_islands(const ParticleRange& range);
    [[nodiscard]] bool is_off_plan(const Island& island, const IslandMember& member) const;
    [[nodiscard]] OffPlan members_off_plan() const;
    [[nodiscard]] std::vector<std::vector<std::uint32_t>> met_by(const OffPlan& off);
    [[nodiscard]] static bool may_have_met(const IslandMember& first, const IslandMember& second);
    [[nodiscard]] std::uint32_t root_of(std::uint32_t k);
    bool join(std::uint32_t a, std::uint32_t b);
    [[nodiscard]] std::vector<Island> islands_of(std::vector<std::uint32_t> involved);
    void run(std::vector<Island>& islands, const TimeSpan& step);
    [[nodiscard]] bool join_those_met();
    void take_members(Island& island, const TimeSpan& step);
    [[nodiscard]] bool may_be_dense() const;
    [[nodiscard]] bool begins_dense(const Island& island) const;
    void run_dense(Island& island, const TimeSpan& step);
    static void keep_way(IslandMember& member, const ForceInput& from, const std::vector<FlownPiece>& flown);
    /// What planning an island takes, kept for the next one.
    struct DenseWork {
        DenseWork(const ResponseRules& rules, const PairLaw& law) : network(rules, law) {}
        NetworkIsland network;
        NeighbourGrid grid;
        std::vector<Box3> boxes;
        std::vector<std::array<std::uint32_t, 2>> pairs;
        std::vector<NetworkMember> members;
    };
    [[nodiscard]] std::unique_ptr<DenseWork> take_work();
    [[nodiscard]] NetworkReport plan_dense(DenseWork& work, double duration) const;
    void rebuild(const TimeSpan& step);

    // Sleep, see pile_sleep.cpp.
    [[nodiscard]] bool is_asleep(std::uint32_t k) const { return traces_.is_asleep[k] != 0; }
    void find_sleepers(const ParticleRange& range, const TimeSpan& step);
    void find_traces(const ParticleRange& range);
    void wake_pile(std::uint64_t particle, double time);
    [[nodiscard]] std::optional<std::size_t> index_of(std::uint64_t particle) const;
    [[nodiscard]] bool hits_sleeper(const NeighbourPair& pair, const TimeSpan& step) const;
    [[nodiscard]] bool wake_those_hit(const TimeSpan& step);
    void let_lie(Island& island, std::vector<NetworkMember>& members, NetworkIsland& network, const TimeSpan& step);
    [[nodiscard]] bool may_lie(const NetworkMember& member, const TimeSpan& step) const;
    [[nodiscard]] bool is_at_rest(const NetworkMember& member, const NetworkBody& planned) const;
    [[nodiscard]] bool is_carried_by_material(const NetworkIsland& network, std::size_t index) const;
    void put_to_sleep(const TimeSpan& step);
    void check_sleepers(const TimeSpan& step, std::vector<BlockRecord>& blocks) const;
    void wake_those_loaded(const TimeSpan& step);
    [[nodiscard]] std::uint64_t sleeper_of(const NetworkKey& key) const;
    [[nodiscard]] bool is_at_edge_of_sleep(const NetworkKey& key) const;
    [[nodiscard]] bool is_pressed_more(const NetworkMemory::Entry& entry, const TimeSpan& step) const;
    [[nodiscard]] bool has_parted(const NetworkKey& key) const;
    void measure_overlaps();

    ParticleStore& store_;
    QuerySchedule& schedule_;
    ActiveMover& mover_;
    const Response& response_;
    const PairContactSettings& settings_;
    std::size_t first_ = 0;  // of the range: the numbers below count from it
    PairPlans plans_;
    PairTraces traces_;
    std::size_t round_ = 0;              // of joining islands
    std::vector<std::uint32_t> joined_;  // in the last round
    NeighbourGrid first_off_plan_grid_;  // of the members that were off their plans in the first round
    std::vector<const IslandMember*> first_off_plan_;
    std::vector<std::uint32_t> first_numbers_;  // of these
    std::vector<std::uint8_t> has_run_anew_;    // by number, in a later round
    NeighbourGrid off_plan_grid_;
    std::vector<std::uint32_t> parents_;  // of each particle of the range: union-find, the lowest number leads
    std::vector<Island> islands_;
    std::vector<PairImpactRecord> impacts_;
    std::vector<PairMeeting> meetings_;
    PairCounts counts_;
    NetworkMemory memory_;  // of the contacts of dense islands
    std::uint64_t unsolved_ = 0;
    std::mutex spare_mutex_;
    std::vector<std::unique_ptr<DenseWork>> spare_;
    SleepingPiles piles_;
};

}  // namespace ricochet
