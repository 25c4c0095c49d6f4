/// \file
/// Tolerances of contact islands: the contact solvers, and the paths that they plan. See core/tolerances.h.
#pragma once

#include <cstddef>

namespace ricochet {

/// Energy that rounding may add to a contact network, as a fraction of the sum of the works of all impulses. Reason:
/// this is the rounding of sums over a thousand contacts. Smaller: elastic impacts lose their rebound. Larger: energy
/// may grow by a larger fraction.
inline constexpr double kNetworkEnergyRounding = 1e-12;

/// Fraction of the overlap of two spheres in a contact island that one step removes. Reason: the errors of the sweeps
/// must not add up from step to step. Half of an overlap per step disappears in a few steps without a jerk. Smaller:
/// overlaps last longer. Larger: deep overlaps, from hard impacts, eject spheres.
inline constexpr double kOverlapRelease = 0.5;

/// Over-relaxation factor of normal impulses in sweeps over contact networks. Reason: with a factor of 1.2, boxes of
/// 2000 spheres come to rest after two thirds of the sweeps that a factor of 1 needs. With 1.5, friction oscillates.
/// Smaller: more sweeps. Larger: sweeps converge worse, and diverge at 2.
inline constexpr double kNetworkOverRelaxation = 1.2;

/// Overlap, as a fraction of the smallest radius, that a step may leave when sweeps end early. It is the closing speed
/// of contacts times the step. Reason: this is half of the overlap allowed while grains are poured (5e-3). 10 000
/// poured grains then overlap by 2.8e-3. Smaller: more sweeps. Larger: hard impacts of many spheres cause overlaps.
inline constexpr double kNetworkOverlap = 2.5e-3;

/// Speed by which the conditions of a contact network may be violated, as a fraction of the speed of its fastest
/// sphere. The solution thus becomes more exact as the network comes to rest. Smaller: networks in motion need more
/// sweeps. Larger: piles creep.
inline constexpr double kNetworkResidual = 1e-2;

/// Lower limit of the speed of the fastest sphere in kNetworkResidual, in smallest radii per step. Reason: the limit is
/// far below the largest allowed drift of a pile. Smaller: more sweeps without effect. Larger: piles creep.
inline constexpr double kNetworkStill = 1e-7;

/// Largest number of sweeps over the contacts of an island. The first constant applies while the remaining error is
/// small, and the second one while it is large. Smaller: spheres in contact islands overlap more. Larger: islands that
/// do not converge take more time.
inline constexpr int kNetworkSweeps = 30;
inline constexpr int kMostNetworkSweeps = 300;

/// Error of the velocities that sweeps may leave, as a fraction of the speed of the fastest sphere. At each single
/// contact, the same fraction of the speeds of its own spheres applies. Smaller: more sweeps. Larger: slow spheres
/// never come to rest.
inline constexpr double kNetworkSpeedError = 0.02;

/// Lower limit of the fastest sphere's speed in kNetworkSpeedError, as a fraction of the velocity change by forces in a
/// step. Reason: the resulting error is so small that the spheres can fall asleep. Smaller: networks that hardly move
/// use all sweeps without effect. Larger: piles creep.
inline constexpr double kNetworkRestingSpeed = 0.05;

/// Lower limits of the speed to which kNetworkSpeedError refers at a single contact. The first constant is a multiple
/// of the velocity change of a sphere by forces in a step. The second one is a fraction of the fastest sphere's speed.
/// Smaller: spheres that rest beside fast spheres move less, but more sweeps are needed. While all spheres fall, the
/// number of sweeps grows many times. Larger: spheres that rest beside fast spheres stay awake.
inline constexpr double kNetworkForceSpeed = 8.0;
inline constexpr double kNetworkFastestShare = 0.6;

/// Number of contacts up to which a network is solved nearly to rounding, if kNetworkSweeps suffice. Smaller: small
/// stacks are less exact. Larger: islands of medium size need more sweeps.
inline constexpr std::size_t kFewNetworkContacts = 64;

/// Overlap that a network of up to kFewNetworkContacts may leave, as a part of kNetworkOverlap. Smaller: more sweeps.
/// Larger: small stacks overlap.
inline constexpr double kFewContactsOverlap = 1.0 / 3.0;

/// Residual at which a network of up to kFewNetworkContacts counts as solved, as a fraction of the fastest speed.
/// Reason: this is the rounding of about a thousand operations. Smaller: more sweeps without effect. Larger: small
/// stacks are less exact.
inline constexpr double kFewContactsRounding = 1e-12;

/// Error at which the sweeps that find connected impacts may end, as a multiple of the final tolerance. Smaller: more
/// sweeps. Larger: connected impacts may count as separate ones.
inline constexpr double kNetworkConnecting = 4.0;

/// Largest speed at which overlapping spheres are separated, as a part of sqrt(acceleration * radius). It is added to
/// their approach speed, which is the residual of the sweeps. Reason: spheres keep that speed, and its energy is 2 % of
/// the energy of a fall by the smaller radius. Smaller: overlaps last longer. Larger: the spheres gain energy.
inline constexpr double kPartingFall = 0.2;

/// Distance within which contacts are searched for even if nothing moves, as a part of the radius. Smaller: contact
/// islands find new contacts only in a second plan. Larger: more candidates.
inline constexpr double kNetworkReach = 0.05;

/// Largest distance by which a step separates an overlap, as a part of the smaller radius. Reason: this is four times
/// the distance that poured spheres need. A larger separation would eject spheres that surfaces press together without
/// room. Smaller: overlaps last longer. Larger: pressed spheres are ejected.
inline constexpr double kMostParting = 0.01;

/// Ratios of the masses of two touching spheres. From the first ratio on, the direct contact solver is used if sweeps
/// fail. From the second ratio on, it is used after only a few sweeps. Reason: the number of sweeps grows with the root
/// of the ratio. Radii from half to twice a value give mass ratios up to 64, below the first limit, and sweeps solve
/// such networks faster. Smaller: the slower direct solver is used more often. Larger: heavy spheres on light spheres
/// overlap.
inline constexpr double kUnlikeMasses = 100.0;
inline constexpr double kVeryUnlikeMasses = 1e4;

/// Tolerance of the direct solver, as a fraction of SolverSettings::enough. Sweeps then remove the remaining error.
/// Smaller: more Newton steps. Larger: these sweeps do not reach their tolerance.
inline constexpr double kDirectShare = 0.25;

/// Largest impulse with which a contact of restitution 0 counts as a support instead of an impact. It is a multiple of
/// the impulse that would stop the approach at this contact alone. The restitution 0 of a support does not lower the
/// restitution of connected impacts. Smaller: a floor absorbs impacts between spheres that roll on it. Larger: impacts
/// keep energy that such a contact should absorb.
inline constexpr double kSupportImpulseRatio = 1.5;

/// Largest number of surfaces that a planned path may hit in one step. After that the particle stays at the position
/// that it has reached. Smaller: particles in corners lose the rest of their step. Larger: particles in corners take
/// more time.
inline constexpr int kMostDiversions = 8;

/// Distance by which the middle of a chord may be nearer to a surface than its ends, as a part of the radius. Smaller:
/// chords along curved surfaces are diverted without need. Larger: spheres overlap curved surfaces more.
inline constexpr double kChordSagitta = 1e-4;

/// Distance from a surface that a path has hit, as a part of the radius, up to which the surface still counts as
/// touched. Reason: chords along another surface repeatedly leave the first one by rounding. Smaller: such chords are
/// diverted repeatedly. Larger: the sphere follows a surface that it has left.
inline constexpr double kStillTouched = 1e-9;

}  // namespace ricochet
