/// \file
/// Finds overlapping spheres with a binary tree. The search shares no code with the one that finds impacts.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/box3.h"
#include "ricochet/core/vec3.h"

namespace ricochet {

/// Largest tolerated overlap of two spheres, over the smaller radius, if spheres may be time-stepped together. Reason:
/// the sweeps over contacts stop before full precision. The residual may grow to half of this while a heap is filled.
/// Smaller: heaps are reported. Larger: errors of the contact problem are not found. Local: a tolerance of the audit,
/// which does not affect the run.
inline constexpr double kMostPlannedOverlap = 0.01;

/// Largest tolerated overlap if all impacts are resolved sequentially. Reason: rounding of times of impact, and of
/// coordinates of a million radii. Smaller: rounding is reported. Larger: missed grazing impacts are not found. Local:
/// a tolerance of the audit, which does not affect the run.
inline constexpr double kMostMetOverlap = 1e-9;

/// State of a sphere that collides with other spheres.
struct StandingSphere {
    std::uint64_t particle = 0;  ///< id
    Vec3 position;               ///< in m
    double radius = 0.0;         ///< in m, > 0
    bool is_new = false;         ///< true: not present in the last call
};

/// Search for overlaps. Remembers the overlaps of the last call.
class SphereOverlaps {
public:
    /// Two spheres that overlap more than they may.
    struct Found {
        std::uint64_t first = 0;  ///< the lower id
        std::uint64_t second = 0;
        Vec3 position;       ///< centre of the first, in m
        double depth = 0.0;  ///< in m
    };

    /// Returns the new overlaps above `most`, which is relative to the smaller radius, in ascending order of the ids.
    /// Overlaps that were as large in the last call are left out, and so are those with a new sphere.
    [[nodiscard]] std::vector<Found> check(std::span<const StandingSphere> spheres, double most);
    /// Returns the largest overlap over the smaller radius in the last call; 0 without any.
    [[nodiscard]] double largest() const { return largest_; }

private:
    struct Node {
        Box3 box;             // box of whole spheres, in m
        std::uint32_t begin;  // range of its spheres in order_
        std::uint32_t end;
        std::uint32_t children;  // the first of two nodes; 0: none
    };

    void build(std::span<const StandingSphere> spheres);
    void split(std::uint32_t node, std::span<const StandingSphere> spheres);
    void find(std::span<const StandingSphere> spheres, std::uint32_t i, double most, std::vector<Found>& deep,
              std::vector<std::array<std::uint64_t, 2>>& born);

    std::vector<Node> nodes_;
    std::vector<std::uint32_t> order_;
    std::vector<Found> before_;  // in ascending order
    double largest_ = 0.0;
};

}  // namespace ricochet
