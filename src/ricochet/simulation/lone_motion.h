/// \file
/// Private to the simulation: the motion of each sphere in a step, if it met no other spheres.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/simulation/pair_parts.h"

namespace ricochet {

/// State from earlier steps, for each particle of a range.
struct PairTraces {
    std::vector<std::uint8_t> is_asleep;  ///< in a sleeping island: others meet only its position
    std::vector<std::uint8_t> presses;    ///< on others or walls, in a contact island of the last step
    std::uint64_t version = 0;            ///< of the sleeping islands; changes with them
};

/// Computes the region that a sphere, given by its number in a range, can reach in a step if it meets no others.
class LoneMotion {
public:
    explicit LoneMotion(const PairParts& parts) : parts_(parts) {}

    /// traces must outlive the use of the object.
    void begin(const ParticleRange& range, const TimeSpan& step, const PairTraces& traces);

    [[nodiscard]] const Vec3& center(std::uint32_t k) const { return parts_.store.particles().position[first_ + k]; }
    [[nodiscard]] double radius(std::uint32_t k) const { return parts_.store.particles().radius[first_ + k]; }

    [[nodiscard]] bool is_asleep(std::uint32_t k) const { return traces_->is_asleep[k] != 0; }
    /// Returns false for a sphere that is pinned or asleep, or that rests on walls alone, away from moving colliders.
    [[nodiscard]] bool moves(std::uint32_t k) const;

    /// Returns the box of a sphere that may touch walls. It is empty if the sphere cannot meet others, and for
    /// sleepers, which are in a separate grid.
    [[nodiscard]] Box3 reachable_box(std::uint32_t k) const;
    /// Returns true for a sphere that may leave its box.
    [[nodiscard]] bool may_leave(const Box3& box) const;

    /// Returns the path of a sphere that flies freely, and the box of that path.
    [[nodiscard]] FlownPiece free_path(std::uint32_t k) const;
    [[nodiscard]] Box3 box_of_free(std::uint32_t k) const;
    /// Returns true if the look-ahead shows that a sphere flies freely. With contact islands, results depend on this
    /// decision, so the state of the sphere must also show it.
    [[nodiscard]] bool is_known_free(std::uint32_t k) const;
    /// Returns true if a sphere flies freely. Tests this by a trial move of the sphere alone.
    [[nodiscard]] bool flies_freely(std::uint32_t k, MoveScratch& scratch) const;

private:
    [[nodiscard]] bool lies(std::size_t i) const;
    [[nodiscard]] double reach(std::size_t i, double duration) const;
    [[nodiscard]] bool lives_through(std::size_t i) const;

    PairParts parts_;
    std::size_t first_ = 0;  // first particle of the range
    TimeSpan step_;
    bool is_bounded_ = true;  // except near moving colliders
    const PairTraces* traces_ = nullptr;
};

}  // namespace ricochet
