/// \file
/// Tolerances of sleep: when spheres rest, and when they wake. See core/tolerances.h.
#pragma once

#include <cstdint>

namespace ricochet {

/// Smallest number of steps for which a sphere, and every sphere that presses on it, must be at rest before the sphere
/// sleeps. Reason: within these steps, a sphere that begins to move on a slope exceeds the limits below. Smaller: such
/// spheres fall asleep. Larger: piles take more time before they sleep.
inline constexpr std::uint32_t kStepsToSleep = 50;

/// Largest path of a sphere at rest in one step, as a part of its radius. The second constant applies to islands beside
/// moving colliders, which may carry the sphere slowly. Smaller: piles do not fall asleep. Larger: creeping spheres
/// fall asleep.
inline constexpr double kRestingPath = 4e-5;
inline constexpr double kRestingPathBesideMovers = 1e-5;

/// Largest speed of a sphere at rest, as a part of sqrt(acceleration * radius). The second constant is the time for
/// which the sphere must not exceed this speed, as a part of sqrt(radius / acceleration). Reason: a sphere with a
/// hundredth of the applied acceleration exceeds the speed within this time, for any time step. Smaller speed, or
/// longer time: piles do not fall asleep. Larger speed, or shorter time: spheres that begin to move fall asleep.
inline constexpr double kRestingSpeed = 1e-3;
inline constexpr double kRestingTime = 0.1;

/// Height of a free fall, in radii of the impactor, from which its impact wakes the spheres that it hits. It is also
/// the distance, in radii, beyond which two spheres count as separate, and within which a sphere counts as beside a
/// moving collider. Smaller: falling dust wakes piles. Larger: spheres that an impact should move stay asleep.
inline constexpr double kWakingFall = 0.01;

/// A contact wakes a sleeping sphere if its impulse exceeds kMorePressed times a limit. The limit is the largest load
/// at the time when the sphere fell asleep, plus kWakingWeights times the sphere's weight. Reason: forces in a pile
/// fluctuate, and a larger load supports a sphere more firmly. Smaller: fluctuations wake piles. Larger: spheres under
/// new loads do not move.
inline constexpr double kMorePressed = 4.0;
inline constexpr double kWakingWeights = 2.0;

/// Value that replaces kWakingWeights for a contact that pushes the sphere aside instead of onto its supports. Smaller:
/// fluctuations wake piles. Larger: spheres that are pushed aside do not move.
inline constexpr double kWakingWeightsAside = 0.5;

/// Cosine of the angle between an impulse and the applied acceleration, from which the impulse counts as directed onto
/// the supports. Smaller: oblique impulses wake fewer spheres. Larger: oblique impulses wake more spheres.
inline constexpr double kOntoSupports = 0.5;

/// Cosine of the angle between the normal of a smooth surface and the direction opposite to the applied acceleration.
/// The surface supports a sphere if the cosine is larger. Reason: a smooth vertical wall does not support a sphere.
/// Smaller: spheres fall asleep on nearly vertical walls. Larger: spheres in steep funnels stay awake.
inline constexpr double kSupportingCosine = 0.01;

/// Overlap with a sleeping sphere, as a part of the smaller radius, that wakes it. Reason: if the sleeping sphere
/// cannot move because of a wall, every impulse would increase the overlap. Smaller: hard impacts wake more spheres
/// than they move. Larger: such overlaps last longer.
inline constexpr double kWakingOverlap = 0.002;

/// Number of times that a step wakes only the direct neighbours of the spheres that were hit or pushed. Afterwards the
/// distance, in contacts, is doubled each time, and the second constant limits these doublings. Reason: each time, all
/// spheres that are awake are planned again; a distance of 2^16 contacts reaches through a pile. Smaller: impacts wake
/// more spheres than they move. Larger: large avalanches need more plans.
inline constexpr int kWakingsAlone = 3;
inline constexpr int kMostWakingDoublings = 16;

/// Largest distance, in contacts, within which a large impactor wakes spheres at once. Reason: after
/// kMostWakingDoublings doublings, the distance is still in the range of int. Smaller: impacts of large spheres need
/// more plans. Larger: no effect on real scenes, and possible up to twice the value.
inline constexpr double kMostWokenContacts = 1e4;

}  // namespace ricochet
