/// \file
/// Whether a recorded impact of spheres on each other adds up: that they touched, that impulses push and stay in the
/// cone of friction, that each sphere has what it was given and no other change, that momentum and angular momentum are
/// those before, that no energy was gained, and that none was lost where nothing takes any.
#pragma once

#include <cstddef>
#include <vector>

#include "ricochet/core/pair_meeting.h"

namespace ricochet::verify {

/// What the books of an impact of spheres may be off by, relative to the sums of the amounts of what they add up:
/// momentum, energy, and for angular momentum. Reason: roundings of impulses and, where many touch at once, of the
/// sweeps over them. Smaller: rounding is reported. Larger: wrong impulses are not seen.
inline constexpr double kPairBooks = 1e-12;
inline constexpr double kPairAngularBooks = 1e-10;

/// Part of its way along walls in the step, and of the smaller radius, that a sphere may be off when it meets another.
/// Reason: such a way is made of arcs, planned anew up to the time of impact. Arcs turn by kMaxArcAngle, so both plans
/// differ by up to the fourth power of it over 120, 8e-7 of the way; 3e-7 has been seen. On surfaces that turn they
/// differ by up to 2.5e-7 radii (at 3 rad/s and half a metre from the axis, in steps of 2 ms). Smaller: the error of
/// arcs is reported. Larger: impacts of spheres that do not touch are not seen.
inline constexpr double kBoundGap = 1e-6;

/// What spheres are said to do to each other.
struct PairBooks {
    double restitution = 1.0;
    double friction = 0.0;
    double rolling_friction = 0.0;
    double resting_speed = 0.0;  ///< m/s: with a restitution below 1 a slower rebound is none
    bool has_exact_paths =
        true;  ///< they are the parabolas of a uniform force: at the impact spheres touch to rounding
    /// What spheres of two materials do instead: `materials` lists of as many, by the numbers of both.
    struct Pair {
        double restitution = 1.0;
        double friction = 0.0;
        double rolling_friction = 0.0;
    };
    std::size_t materials = 0;  ///< 0: all are of one
    std::vector<Pair> by_materials = {};
};

/// True where something is wrong with it.
[[nodiscard]] bool is_wrong(const PairMeeting& meeting, const PairBooks& books);

}  // namespace ricochet::verify
