/// \file
/// Which spheres stand in one another, by a search that shares nothing with the one by which they meet: a tree of
/// halves.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Overlap of two spheres over the smaller radius that the verifier lets pass where spheres may be planned together.
/// Reason: sweeps over the contacts end before the last digit, and what they leave may grow to half of this while a
/// heap is filled. Smaller: heaps are reported. Larger: what is lost in the contact problem is not seen.
inline constexpr double kMostPlannedOverlap = 0.01;

/// The same where all impacts are worked off one after the other. Reason: roundings of times of impact, and those of
/// coordinates that are a million radii large. Smaller: rounding is reported. Larger: missed impacts that only graze
/// are not seen.
inline constexpr double kMostMetOverlap = 1e-9;

/// A sphere that meets others, as it stands.
struct StandingSphere {
    std::uint64_t particle = 0;  ///< id
    Vec3 position;               ///< m
    double radius = 0.0;         ///< m, > 0
    bool is_new = false;         ///< it was not there before
};

/// What is remembered from one step to the next: overlaps that were there.
class SphereOverlaps {
public:
    /// Two that overlap more than they may.
    struct Found {
        std::uint64_t first = 0;  ///< id, the lower one
        std::uint64_t second = 0;
        Vec3 position;       ///< m, of the first
        double depth = 0.0;  ///< m
    };

    /// most: overlap over the smaller radius that is let pass. Returns, ascending by their ids, those that overlap more
    /// and did not, or less, when it was called last; those of which one is new are taken as they are.
    [[nodiscard]] std::vector<Found> check(std::span<const StandingSphere> spheres, double most);
    /// Of the last call: the largest overlap over the smaller radius; 0 without any.
    [[nodiscard]] double largest() const { return largest_; }

private:
    struct Node {
        Box3 box;             // m, of whole spheres
        std::uint32_t begin;  // of its spheres in order_
        std::uint32_t end;
        std::uint32_t children;  // the first of two nodes; 0: none
    };

    void build(std::span<const StandingSphere> spheres);
    void split(std::uint32_t node, std::span<const StandingSphere> spheres);
    void find(std::span<const StandingSphere> spheres, std::uint32_t i, double most, std::vector<Found>& deep,
              std::vector<std::array<std::uint64_t, 2>>& born);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<Found> before_;  // ascending
    double largest_ = 0.0;
};

}  // namespace ricochet
