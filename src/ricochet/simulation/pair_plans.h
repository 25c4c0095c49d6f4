/// \file
/// Private to the simulation: the pairs of spheres that may meet in a step, by the motion of each alone.
///
/// Each sphere declares bounds, in which it stays if it meets no other sphere. A free sphere flies without touching a
/// wall, and declares its exact path. A bound sphere touches walls, or pressed on a wall or a sphere in the last step.
/// It declares a box that it does not leave. The declarations decide which spheres contact islands plan together, so
/// they affect results. They depend only on the state at the start of the step. The look-ahead only saves the
/// computation of paths and does not change the declarations.
#pragma once

#include <cstdint>
#include <vector>

#include "ricochet/core/box_tools.h"
#include "ricochet/dynamics/neighbour_grid.h"
#include "ricochet/dynamics/neighbour_pairs.h"
#include "ricochet/response/event_island.h"
#include "ricochet/simulation/lone_motion.h"
#include "ricochet/simulation/pair_parts.h"

namespace ricochet {

/// The boxes of sleeping spheres, by number in a range of particles. The grid is kept as long as the same ones sleep.
class SleeperGrid {
public:
    /// Computes the boxes again if the set of sleeping spheres has changed. first: first particle of the range.
    void update(const PairTraces& traces, const Particles& particles, std::size_t first);

    [[nodiscard]] bool empty() const { return bounds_.empty(); }
    /// Returns the box of a sleeping sphere.
    [[nodiscard]] const Box3& box(std::uint32_t k) const { return boxes_[k]; }
    /// Returns false if a box is far from all sleepers.
    [[nodiscard]] bool may_be_near(const Box3& box) const { return overlap(box, bounds_); }
    /// Appends all sleepers whose boxes are near a box.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const { grid_.find_near(box, found); }

private:
    NeighbourGrid grid_;
    std::vector<Box3> boxes_;
    Box3 bounds_;                          // box around all sleepers
    std::vector<std::uint8_t> is_asleep_;  // PairTraces::is_asleep of the boxes
    std::uint64_t version_ = 0;            // of the sleeping islands
};

/// The declarations of the spheres of a range, and the pairs of spheres that may meet. See the top of this file.
class PairPlans {
public:
    explicit PairPlans(const PairParts& parts) : parts_(parts), alone_(parts) {}

    /// Computes the declarations of the particles of a range for a step, and finds the pairs that may meet. traces must
    /// live as long as the plans are used. The other functions identify a particle by its number in the range.
    void find(const ParticleRange& range, const TimeSpan& step, const PairTraces& traces);

    /// Returns the pairs of spheres whose boxes are near each other, of which one moves: all that may meet, and more.
    [[nodiscard]] const std::vector<NeighbourPair>& pairs() const { return pairs_; }
    /// Returns true if the spheres of a pair, given by its number, may meet.
    [[nodiscard]] bool may_meet(std::size_t pair) const { return met_[pair] != 0; }
    /// Returns true if a sphere is bound and may leave its declared box.
    [[nodiscard]] bool may_leave_box(std::uint32_t k) const { return is_bound(k) && alone_.may_leave(boxes_[k]); }
    /// Returns true if a sphere takes part in the step, can be moved, and does not fly freely.
    [[nodiscard]] bool is_bound(std::uint32_t k) const { return !boxes_[k].empty() && alone_.moves(k) && !is_free(k); }

    /// Appends all spheres whose boxes are near a box.
    void find_near(const Box3& box, std::vector<std::uint32_t>& found) const;
    /// Tests which of these spheres fly freely. Skips spheres for which this is known.
    void test_free_flight(std::vector<std::uint32_t> particles);
    /// Returns true if a sphere flies freely. test_free_flight() must have tested it, as all spheres of pairs().
    [[nodiscard]] bool is_free(std::uint32_t k) const { return freedom_[k] == Freedom::free; }
    [[nodiscard]] const Box3& box(std::uint32_t k) const { return boxes_[k]; }
    /// Returns true if a member's path meets a tested sphere of another island that stays within its bounds.
    [[nodiscard]] bool comes_to(const IslandMember& member, std::uint32_t k) const;

    /// Returns all free spheres that rest on spheres of `base`, directly or through other spheres, if the base keeps
    /// its position. In each returned pair, the second sphere rests on the first sphere.
    [[nodiscard]] std::vector<NeighbourPair> stack_on(std::vector<std::uint32_t> base) const;

private:
    enum class Freedom : std::uint8_t { unknown, free, bound };

    [[nodiscard]] const Box3& occupied_box(std::uint32_t k) const {
        return alone_.is_asleep(k) ? sleepers_.box(k) : boxes_[k];
    }
    void declare();
    void collect_pairs();
    [[nodiscard]] bool expect_deflections();
    [[nodiscard]] bool is_resting_on(std::uint32_t above, std::uint32_t below) const;
    void add_pairs_with_sleepers();
    [[nodiscard]] bool do_meet(const NeighbourPair& pair) const;

    PairParts parts_;
    LoneMotion alone_;
    std::vector<Freedom> freedom_;
    std::vector<Box3> boxes_;
    NeighbourPairs near_;  // pairs of boxes; spheres that test_free_flight() has not tested count as bound
    std::vector<std::uint32_t> changed_;  // boxes that have changed since the last search in near_
    std::vector<NeighbourPair> pairs_;
    std::vector<std::uint8_t> met_;  // of the pairs
    SleeperGrid sleepers_;
};

}  // namespace ricochet
