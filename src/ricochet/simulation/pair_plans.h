/// \file
/// Private to the simulation: where spheres would go in a step if each were alone, and so which of them may meet.
///
/// Each sphere declares a box in which it stays if it meets none of the others. One that flies freely, without touching
/// a wall, declares its exact way; one that is bound, since it touches walls or pressed on something in the last step,
/// declares how far it may come. Who is planned together in dense islands depends on it, and so do results: what
/// is declared depends on the state at the step's begin alone, never on what has been looked at ahead, which only saves
/// going a way.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/dynamics/neighbour_pairs.h"
#include "ricochet/response/event_island.h"
#include "ricochet/simulation/pair_parts.h"

namespace ricochet {

/// What steps have left behind, of each particle of a range.
struct PairTraces {
    std::vector<std::uint8_t> is_asleep;  ///< in a pile: its place is all that others meet
    std::vector<std::uint8_t> presses;    ///< on others or walls, where they were planned together in the last step
    std::uint64_t version = 0;            ///< of the piles that sleep: changes with them
};

class PairPlans {
public:
    explicit PairPlans(const PairParts& parts) : parts_(parts) {}

    /// What those of a range declare for a step, and which of them may meet. traces must live as long as the plans are
    /// asked. Particles are called by their numbers in the range from here on.
    void find(const ParticleRange& range, const TimeSpan& step, const PairTraces& traces);

    /// Those whose boxes are near each other, of which at least one moves; more than those that may meet.
    [[nodiscard]] const std::vector<NeighbourPair>& pairs() const { return pairs_; }
    /// Whether the two of a pair may meet, by its number.
    [[nodiscard]] bool may_meet(std::size_t pair) const { return met_[pair] != 0; }
    /// It is bound, and may go farther than it declares.
    [[nodiscard]] bool may_roam(std::uint32_t k) const { return is_bound(k) && is_unbounded(k); }
    /// It is there, something may move it, and it does not fly freely.
    [[nodiscard]] bool is_bound(std::uint32_t k) const { return !boxes_[k].empty() && moves(k) && !is_free(k); }

    /// Appends all whose boxes are near another one.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const;
    /// Lets those that have not said it yet say whether they fly freely.
    void ask(std::vector<std::uint32_t> particles);
    /// Of those that have been asked, as those of pairs() have.
    [[nodiscard]] bool is_free(std::uint32_t k) const { return freedom_[k] == Freedom::free; }
    [[nodiscard]] const Box3& box(std::uint32_t k) const { return boxes_[k]; }
    /// Whether a member's way leads it onto a sphere of another island that does what it declares, and has been asked.
    [[nodiscard]] bool comes_to(const IslandMember& member, std::uint32_t k) const;

    /// All that fly freely and lie on one of the base, if that stays where it is, or on others that do: each with one
    /// that it lies on, which comes first.
    [[nodiscard]] std::vector<NeighbourPair> stack_on(std::vector<std::uint32_t> base) const;

private:
    enum class Freedom : std::uint8_t { unknown, free, bound };

    [[nodiscard]] bool is_asleep(std::uint32_t k) const { return traces_->is_asleep[k] != 0; }
    [[nodiscard]] bool lies(std::size_t i) const;
    [[nodiscard]] bool moves(std::uint32_t k) const;
    [[nodiscard]] bool is_bounded() const;
    [[nodiscard]] bool is_unbounded(std::uint32_t k) const;
    [[nodiscard]] double reach(std::size_t i, double duration) const;
    [[nodiscard]] Box3 reachable_box(std::uint32_t k) const;
    [[nodiscard]] Box3 box_of_free(std::uint32_t k) const;
    [[nodiscard]] FlownPiece free_path(std::uint32_t k) const;
    [[nodiscard]] bool is_known_free(std::uint32_t k) const;
    [[nodiscard]] bool lives_through(std::size_t i) const;
    [[nodiscard]] bool flies_freely(std::uint32_t k, MoveScratch& scratch) const;
    [[nodiscard]] const Box3& place_of(std::uint32_t k) const { return is_asleep(k) ? sleeper_boxes_[k] : boxes_[k]; }
    void declare();
    void collect_pairs();
    [[nodiscard]] bool expect_deflections();
    [[nodiscard]] bool lies_on(std::uint32_t above, std::uint32_t below) const;
    void add_pairs_with_sleepers();
    [[nodiscard]] bool do_meet(const NeighbourPair& pair) const;

    PairParts parts_;
    std::size_t first_ = 0;  // of the range
    TimeSpan step_;
    bool is_bounded_ = true;  // but for what comes to colliders that move
    const PairTraces* traces_ = nullptr;
    std::vector<Freedom> freedom_;
    std::vector<Box3> boxes_;
    NeighbourPairs near_;                 // of boxes, those of bound ones where somebody has not been asked
    std::vector<std::uint32_t> changed_;  // boxes, since
    std::vector<NeighbourPair> pairs_;
    std::vector<std::uint8_t> met_;  // of the pairs
    NeighbourGrid sleeper_grid_;
    std::vector<Box3> sleeper_boxes_;
    Box3 sleepers_;                      // around all of those
    std::vector<std::uint8_t> in_grid_;  // who sleeps, as that grid has it
    std::uint64_t grid_version_ = 0;     // of the piles in it
};

}  // namespace ricochet
