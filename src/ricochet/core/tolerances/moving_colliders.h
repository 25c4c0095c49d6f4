/// \file
/// Tolerances of paths relative to moving bodies, and of the keys of their motions. See core/tolerances.h.
#pragma once

namespace ricochet {

/// Largest deviation of a path in the frame of a moving body, as a fraction of a length. The length is the larger of
/// the radius and the distance from the frame's origin. The path consists of cubics that are short enough for it.
/// Reason: one cubic for a turn of about one degree. Times of impact are found again on the true path and do not depend
/// on it. Smaller: more cubics. Larger: more near misses count as grazing contacts, and the search for safe positions
/// starts farther from the surface.
inline constexpr double kMovingPathTolerance = 1e-9;

/// Largest number of these cubics for one path between two keys. Reason: kMovingPathTolerance needs some 250 per turn,
/// and no step can follow more than 16 turns. Smaller: paths relative to fast bodies are less exact than that
/// tolerance. Larger: a step beside a body that turns still faster takes longer.
inline constexpr double kMostMovingPieces = 4096.0;

/// Largest number of keys of a body's curves that one step handles individually: paths are split there, and boxes of
/// the motion are united. Later keys, as in a curve that repeats much faster than the step, form one interval. Smaller:
/// an impact beside a later key is found on a cubic across the jump, and boxes are wider. Larger: steps of such bodies
/// take longer.
inline constexpr int kMostKeysInStep = 256;

/// Growth of a body's box over a step for the rounding of poses and sums, as a fraction of its largest coordinate.
/// Reason: some thousand roundings of 2^-53. Smaller than some 2^-49: a body may leave its box and pass through
/// particles without contact. Larger: more particles nearby query the body without need.
inline constexpr double kSweptBoxRounding = 0x1p-40;

/// Relative difference of a body's velocities on both sides of a key above which the velocity jumps there. Reason: the
/// rounding of derivatives of curves. Smaller: attached particles are released, and land again, at keys without a jump.
/// Larger: attached particles are carried through jumps of that size.
inline constexpr double kSameVelocity = 1e-12;

/// Difference between a time and a key of a motion, in ulp of the time, up to which the key counts as reached. Reason:
/// roundings of the sum of step times. Smaller: a particle at a key has the velocity of the interval before. Larger:
/// the velocity changes earlier by as much.
inline constexpr double kKeyUlps = 16.0;

/// Distance from a sleeping particle, as a fraction of its coordinates, within which a moving collider wakes it. It
/// must exceed kCandidateSlack, the distance within which the particle would look for the collider. Smaller: a sleeping
/// particle could be passed through. Larger: particles wake without need.
inline constexpr double kWakingReach = 0x1p-36;

/// Rounding of a velocity in the frame of a body, as a fraction of the speeds in the world. Reason: it is the rotated
/// difference of two such velocities. Smaller: an attached particle lands on its body again and again, or never rests
/// there. Larger: slow creep stops.
inline constexpr double kFrameRounding = 0x1p-47;

}  // namespace ricochet
