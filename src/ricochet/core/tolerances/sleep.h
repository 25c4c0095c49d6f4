/// \file
/// Tolerances of sleep: when spheres rest, and when they wake. See core/tolerances.h.
#pragma once

#include <cstdint>

namespace ricochet {

/// Smallest number of steps for which a sphere, and every sphere that presses on it, must be at rest before it sleeps.
/// Reason: a sphere that begins to move on a slope has exceeded the limits below by then. Smaller: such spheres fall
/// asleep. Larger: piles cost more before they sleep.
inline constexpr std::uint32_t kStepsToSleep = 50;

/// Largest path of a sphere at rest in one step, as a part of its radius: in general, and in islands beside moving
/// colliders, which may carry it slowly. Smaller: piles do not fall asleep. Larger: creeping spheres do.
inline constexpr double kRestingPath = 4e-5;
inline constexpr double kRestingPathBesideMovers = 1e-5;

/// Largest speed of a sphere at rest, as a part of sqrt(acceleration * radius). The second constant is the time for
/// which it must hold, as a part of sqrt(radius / acceleration). Reason: a sphere accelerated by a hundredth of the
/// acceleration is faster by then, however short the steps are. Smaller speed, or longer time: piles do not fall
/// asleep. Larger speed, or shorter time: starting spheres do.
inline constexpr double kRestingSpeed = 1e-3;
inline constexpr double kRestingTime = 0.1;

/// Height of a free fall, in radii of the impactor, from which its impact wakes the spheres that it hits. It is also
/// the distance, in radii, at which spheres count as apart, or as beside a moving collider. Smaller: falling dust wakes
/// piles. Larger: spheres that should be moved sleep on.
inline constexpr double kWakingFall = 0.01;

/// A contact wakes a sleeping sphere if its impulse exceeds kMorePressed times a limit. The limit is the largest load
/// at the time of falling asleep, plus kWakingWeights weights of the sphere. Reason: forces in a pile fluctuate, and a
/// sphere that carries much is held firmly. Smaller: fluctuations wake piles. Larger: pressed spheres do not give way.
inline constexpr double kMorePressed = 4.0;
inline constexpr double kWakingWeights = 2.0;

/// The same number of weights for a contact that pushes the sphere aside, not onto its supports. Smaller and larger: as
/// before.
inline constexpr double kWakingWeightsAside = 0.5;

/// Cosine of the angle between a push and the applied acceleration from which the push is directed onto the supports.
/// Smaller: oblique pushes wake fewer spheres. Larger: they wake more.
inline constexpr double kOntoSupports = 0.5;

/// Cosine of the angle between the push of a smooth surface and the direction against the applied acceleration, above
/// which the surface supports a sphere. Reason: a smooth wall beside a sphere does not. Smaller: spheres fall asleep on
/// nearly vertical walls. Larger: spheres in steep funnels stay awake.
inline constexpr double kSupportingCosine = 0.01;

/// Overlap with a sleeping sphere, as a part of the smaller radius, that wakes it. Reason: without room between the
/// sleeper and a wall, all pushes would drive a sphere in ever deeper. Smaller: hard impacts wake more spheres than
/// they move. Larger: such overlaps last.
inline constexpr double kWakingOverlap = 0.002;

/// Number of times that a step wakes only the neighbours of the spheres that were hit or pushed, and most doublings of
/// that distance afterwards. Reason: each time costs everything that is awake again; 2^16 contacts reach through a
/// pile. Fewer: impacts wake more than they move. More: large avalanches cost more plans.
inline constexpr int kWakingsAlone = 3;
inline constexpr int kMostWakingDoublings = 16;

/// Largest distance, in contacts, that a large impactor wakes at once. Reason: doubled kMostWakingDoublings times, it
/// remains in the range of int. Smaller: large spheres need more plans. Larger: up to twice the value without effect on
/// real scenes.
inline constexpr double kMostWokenContacts = 1e4;

}  // namespace ricochet
