/// \file
/// Search for overlapping spheres with a binary tree. It shares no code with the search for impacts.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ricochet/core/vec3.h"

namespace ricochet {

/// Largest tolerated overlap of two spheres, divided by the smaller radius, if the run has contact islands. The
/// iterations of the contact solver end before full precision. While a pile of spheres grows, the resulting overlap can
/// grow to half of this value. With a smaller value, piles would be reported. With a larger value, errors of the
/// contact solver would not be found. Local: a tolerance of the audit, which does not affect the run.
inline constexpr double kMostPlannedOverlap = 0.01;

/// Largest tolerated overlap, divided by the smaller radius, if all impacts are resolved sequentially. The value allows
/// for rounding of times of impact, and of coordinates as large as a million radii. With a smaller value, rounding
/// would be reported. With a larger value, missed grazing impacts would not be found. Local: a tolerance of the audit,
/// which does not affect the run.
inline constexpr double kMostMetOverlap = 1e-9;

/// State of a sphere that collides with other spheres.
struct StandingSphere {
    std::uint64_t particle = 0;  ///< id
    Vec3 position;               ///< in m
    double radius = 0.0;         ///< in m, > 0
    bool is_new = false;         ///< true: the sphere was not present in the last call
};

/// Search for overlaps, with a memory of the overlaps of the last call.
class SphereOverlaps {
public:
    /// Two spheres that overlap by more than the tolerance.
    struct Found {
        std::uint64_t first = 0;  ///< lower id of the two spheres
        std::uint64_t second = 0;
        Vec3 position;       ///< centre of the first sphere, in m
        double depth = 0.0;  ///< in m
    };

    /// Returns the new overlaps above `most`, in ascending order of the ids. most: tolerance, relative to the smaller
    /// radius. Overlaps that were at least as large in the last call are not returned. Overlaps with a new sphere are
    /// not returned either.
    [[nodiscard]] std::vector<Found> check(std::span<const StandingSphere> spheres, double most);
    /// Returns the largest overlap of the last call, divided by the smaller radius of its two spheres; 0 if there was
    /// no overlap.
    [[nodiscard]] double largest() const { return largest_; }

private:
    std::vector<Found> before_;  // overlaps of the last call, in ascending order of the ids
    double largest_ = 0.0;
};

}  // namespace ricochet
