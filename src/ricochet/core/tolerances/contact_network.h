/// \file
/// Tolerances of contact islands: the contact solvers, and the paths that they plan. See core/tolerances.h.
#pragma once

#include <cstddef>

namespace ricochet {

/// Energy that impulses of a contact network may seem to add, as a fraction of the sum of their works. Reason: rounding
/// of sums over a thousand contacts. Smaller: elastic impacts lose their rebound. Larger: energy may grow by as much.
inline constexpr double kNetworkEnergyRounding = 1e-12;

/// Fraction of an overlap of spheres in dense contact that one step removes. Reason: the remainder of the sweeps must
/// not add up from step to step. Half of it settles in a few steps without a jerk. Smaller: overlaps last. Larger: deep
/// overlaps, from hard impacts, eject spheres.
inline constexpr double kOverlapRelease = 0.5;

/// Over-relaxation factor of normal impulses in sweeps over contact networks. Reason: with a factor of 1.2, boxes of
/// 2000 spheres come to rest in two thirds of the sweeps. With 1.5, friction oscillates. Smaller: more sweeps. Larger:
/// sweeps diverge at 2.
inline constexpr double kNetworkOverRelaxation = 1.2;

/// Overlap, as a fraction of the smallest radius, that a step may leave when sweeps end early. It is the closing speed
/// of contacts times the step. Reason: half of the visible overlap allowed while grains are poured (5e-3): 10 000
/// poured grains show 2.8e-3. Smaller: more sweeps. Larger: hard impacts of many spheres overlap.
inline constexpr double kNetworkOverlap = 2.5e-3;

/// Speed by which the conditions of a contact network may be violated, as a fraction of the speed of its fastest
/// sphere. The solution thus becomes more exact as the network comes to rest. Smaller: more sweeps for networks in
/// motion. Larger: piles creep.
inline constexpr double kNetworkResidual = 1e-2;

/// Lower limit of that speed, in smallest radii per step. Reason: far below the largest allowed drift of a pile.
/// Smaller: sweeps without effect. Larger: piles creep.
inline constexpr double kNetworkStill = 1e-7;

/// Most sweeps over the contacts of an island: while the remaining error is small, and while it is large. Smaller:
/// dense islands overlap more. Larger: islands that do not converge cost more.
inline constexpr int kNetworkSweeps = 30;
inline constexpr int kMostNetworkSweeps = 300;

/// Error of the velocities that sweeps may leave, as a fraction of the speed of the fastest sphere. For a single
/// contact it is a fraction of the speeds of its own spheres. Smaller: more sweeps. Larger: slow spheres never come to
/// rest.
inline constexpr double kNetworkSpeedError = 0.02;

/// Smallest speed in kNetworkSpeedError, as a fraction of the velocity change by forces in a step. Reason: a network
/// solved to that error falls asleep. Smaller: networks that hardly move are swept to the end without effect. Larger:
/// piles creep.
inline constexpr double kNetworkRestingSpeed = 0.05;

/// Smallest speed of a contact's spheres in kNetworkSpeedError: in velocity changes by forces in a step, and as a part
/// of the fastest sphere's speed. Smaller: spheres that rest beside fast ones are stiller. That takes more sweeps, many
/// times more while all spheres fall. Larger: they are kept awake.
inline constexpr double kNetworkForceSpeed = 8.0;
inline constexpr double kNetworkFastestShare = 0.6;

/// Number of contacts up to which a network is solved nearly to rounding, if kNetworkSweeps suffice. Smaller: small
/// stacks are less exact. Larger: more sweeps for middling islands.
inline constexpr std::size_t kFewNetworkContacts = 64;

/// Overlap that such a network may leave, as a part of kNetworkOverlap. Smaller: more sweeps. Larger: small stacks
/// overlap.
inline constexpr double kFewContactsOverlap = 1.0 / 3.0;

/// Residual at which such a network is solved, as a fraction of the fastest speed. Reason: rounding of some thousand
/// operations. Smaller: sweeps without effect. Larger: small stacks are less exact.
inline constexpr double kFewContactsRounding = 1e-12;

/// Error at which the sweeps that find connected impacts may end, as a multiple of the error that suffices in the end.
/// Smaller: more sweeps. Larger: connected impacts may count as separate ones.
inline constexpr double kNetworkConnecting = 4.0;

/// Largest speed at which overlapping spheres are separated, as a part of sqrt(acceleration * radius). It is added to
/// their approach speed, which is the residual of the sweeps. Reason: spheres keep that speed, and its energy is two
/// hundredths of a fall by the smaller radius. Smaller: overlaps last. Larger: they gain energy.
inline constexpr double kPartingFall = 0.2;

/// Distance within which contacts are searched for even if nothing moves, as a part of the radius. Smaller: contact
/// islands find new contacts only in a second plan. Larger: more candidates.
inline constexpr double kNetworkReach = 0.05;

/// Largest distance by which a step separates an overlap, as a part of the smaller radius. Reason: four times the need
/// of poured spheres. Surfaces that press spheres together without room would throw them. Smaller: overlaps last.
/// Larger: pressed spheres are thrown.
inline constexpr double kMostParting = 0.01;

/// Ratio of the masses of two touching spheres from which a network is solved directly if sweeps fail; and from which
/// it is solved directly after only a few sweeps. Reason: the number of sweeps grows with the root of the ratio. Radii
/// from half to twice a value give mass ratios up to 64. Such networks stay below the limit, and sweeps solve them
/// faster. Smaller: the slower method is used more often. Larger: heavy spheres on light ones overlap.
inline constexpr double kUnlikeMasses = 100.0;
inline constexpr double kVeryUnlikeMasses = 1e4;

/// Tolerance of the direct solver, as a fraction of SolverSettings::enough. Sweeps remove the rest. Smaller: more
/// Newton steps. Larger: the sweeps do not reach their tolerance.
inline constexpr double kDirectShare = 0.25;

/// Impulse of a contact without restitution, up to which it only supports the body. It is a multiple of the impulse
/// that stops the body's own approach. Its restitution then does not lower that of connected impacts. Smaller: a floor
/// absorbs impacts between spheres that roll on it. Larger: energy may be kept that such a contact should absorb.
inline constexpr double kHoldsOnly = 1.5;

/// Most surfaces that a planned path may meet in one step. After that the particle stays at the position it has
/// reached. Smaller: particles in corners lose the rest of their step. Larger: they cost more.
inline constexpr int kMostDiversions = 8;

/// Distance by which a chord may come nearer to a surface between its ends, as a part of the radius. Smaller: chords
/// along curved surfaces are diverted without need. Larger: spheres overlap curved surfaces by as much.
inline constexpr double kChordSagitta = 1e-4;

/// Distance from a surface that was met, as a part of the radius, up to which it still counts as touched. Reason:
/// chords along another surface leave it by rounding, again and again. Smaller: such chords are diverted repeatedly.
/// Larger: the sphere follows a surface that it has left.
inline constexpr double kStillTouched = 1e-9;

}  // namespace ricochet
