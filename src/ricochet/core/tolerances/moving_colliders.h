/// \file
/// Tolerances of paths relative to moving bodies, and of the keys of their motions. See core/tolerances.h.
#pragma once

namespace ricochet {

/// Largest deviation of a path in the frame of a moving body, as a fraction of a length. The length is the larger of
/// the radius and the distance from the frame's origin. The path is approximated by cubics that are short enough for
/// this tolerance. Reason: one cubic then covers a turn of about one degree. Times of impact are computed again on the
/// true path and do not depend on this value. Smaller: more cubics. Larger: more near misses count as grazing contacts,
/// and the search for safe positions starts farther from the surface.
inline constexpr double kMovingPathTolerance = 1e-9;

/// Largest number of these cubics for one path between two keys. Reason: kMovingPathTolerance needs about 250 cubics
/// per turn, and no step can follow more than 16 turns. Smaller: paths relative to fast bodies do not meet
/// kMovingPathTolerance. Larger: a step beside a body that turns more than 16 times in it takes longer.
inline constexpr double kMostMovingPieces = 4096.0;

/// Largest number of keys of a body's curves that one step handles individually. Paths are split at these keys, and the
/// box of the motion is the union of the boxes between them. Later keys of the step form one interval, for example if a
/// curve repeats much faster than the step. Smaller: impacts near a later key are searched on a cubic that crosses the
/// key's jump, and boxes are wider. Larger: steps of such bodies take longer.
inline constexpr int kMostKeysInStep = 256;

/// Growth of a body's box over a step for the rounding of poses and sums, as a fraction of its largest coordinate.
/// Reason: the growth covers several thousand roundings of 2^-53. Smaller than about 2^-49: a body may leave its box
/// and pass through particles without contact. Larger: more particles near the box query the body without need.
inline constexpr double kSweptBoxRounding = 0x1p-40;

/// Relative difference of a body's velocities on both sides of a key above which the velocity jumps there. Reason: the
/// limit covers the rounding of derivatives of curves. Smaller: attached particles are released, and land again, at
/// keys without a jump. Larger: particles stay attached through jumps of that size.
inline constexpr double kSameVelocity = 1e-12;

/// Difference between a time and a key of a motion, in ulp of the time, up to which the key counts as reached. Reason:
/// the sum of the time steps is rounded. Smaller: a particle at a key has the velocity of the interval before the key.
/// Larger: the velocity changes earlier.
inline constexpr double kKeyUlps = 16.0;

/// Distance from a sleeping particle, as a fraction of its coordinates, within which a moving collider wakes it. It
/// must exceed kCandidateSlack, the distance within which an active particle tests the collider. Smaller: a collider
/// could pass through a sleeping particle. Larger: particles wake without need.
inline constexpr double kWakingReach = 0x1p-36;

/// Rounding of a velocity in the frame of a body, as a fraction of the speeds in the world. Reason: the velocity in the
/// frame is the rotated difference of two velocities in the world. Smaller: an attached particle lands on its body
/// repeatedly, or never comes to rest on it. Larger: slow creep stops.
inline constexpr double kFrameRounding = 0x1p-47;

}  // namespace ricochet
