/// \file
/// Private to the simulation: the paths of spheres in a step as if each were alone, and the pairs that may meet.
///
/// Each sphere declares a box in which it stays if it meets no others. A sphere that flies freely, without touching a
/// wall, declares its exact path. A bound sphere touches walls, or pressed on something in the last step. It declares
/// how far it may come. The declarations decide which spheres contact islands plan together, and so they affect
/// results. They depend only on the state at the start of the step, never on the look-ahead, which only saves the
/// computation of a path.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/dynamics/neighbour_pairs.h"
#include "ricochet/response/event_island.h"
#include "ricochet/simulation/pair_parts.h"

namespace ricochet {

/// State from earlier steps, for each particle of a range.
struct PairTraces {
    std::vector<std::uint8_t> is_asleep;  ///< in a sleeping island: others meet only its position
    std::vector<std::uint8_t> presses;    ///< on others or walls, in a contact island of the last step
    std::uint64_t version = 0;            ///< of the sleeping islands; changes with them
};

class PairPlans {
public:
    explicit PairPlans(const PairParts& parts) : parts_(parts) {}

    /// Finds the declarations of the particles of a range for a step, and the pairs that may meet. traces must outlive
    /// the use of the plans. From here on, particles are given by their numbers in the range.
    void find(const ParticleRange& range, const TimeSpan& step, const PairTraces& traces);

    /// Returns the pairs whose boxes are near each other and of which at least one sphere moves. They include all pairs
    /// that may meet.
    [[nodiscard]] const std::vector<NeighbourPair>& pairs() const { return pairs_; }
    /// Returns true if the spheres of a pair, given by its number, may meet.
    [[nodiscard]] bool may_meet(std::size_t pair) const { return met_[pair] != 0; }
    /// Returns true if a sphere is bound, and may go farther than it declares.
    [[nodiscard]] bool may_roam(std::uint32_t k) const { return is_bound(k) && is_unbounded(k); }
    /// Returns true if a sphere takes part in the step, can be moved, and does not fly freely.
    [[nodiscard]] bool is_bound(std::uint32_t k) const { return !boxes_[k].empty() && moves(k) && !is_free(k); }

    /// Appends all spheres whose boxes are near a box.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const;
    /// Tests which of these spheres fly freely, unless that is known.
    void ask(std::vector<std::uint32_t> particles);
    /// Returns true if a sphere flies freely. It must have been tested by ask(), as the spheres of pairs() have.
    [[nodiscard]] bool is_free(std::uint32_t k) const { return freedom_[k] == Freedom::free; }
    [[nodiscard]] const Box3& box(std::uint32_t k) const { return boxes_[k]; }
    /// Returns true if a member's path leads onto a sphere of another island that keeps its declaration. The sphere
    /// must have been tested by ask().
    [[nodiscard]] bool comes_to(const IslandMember& member, std::uint32_t k) const;

    /// Returns all spheres that fly freely and rest on the base, or on others that do, if the base keeps its position.
    /// Each comes second in a pair with a sphere that it rests on.
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
    std::size_t first_ = 0;  // first particle of the range
    TimeSpan step_;
    bool is_bounded_ = true;  // except near moving colliders
    const PairTraces* traces_ = nullptr;
    std::vector<Freedom> freedom_;
    std::vector<Box3> boxes_;
    NeighbourPairs near_;                 // of boxes; spheres that have not been tested by ask() count as bound
    std::vector<std::uint32_t> changed_;  // boxes that have changed since then
    std::vector<NeighbourPair> pairs_;
    std::vector<std::uint8_t> met_;  // of the pairs
    NeighbourGrid sleeper_grid_;
    std::vector<Box3> sleeper_boxes_;
    Box3 sleepers_;                      // box around all sleepers
    std::vector<std::uint8_t> in_grid_;  // sleepers in the grid
    std::uint64_t grid_version_ = 0;     // version of the sleeping islands in it
};

}  // namespace ricochet
