/// \file
/// Tolerances of contact phases: touching, sliding, rest and separation. See core/tolerances.h.
#pragma once

#include <cstdint>

namespace ricochet {

/// Distance from a surface's plane, in contact offsets, up to which a particle touches the surface. Sliding also
/// continues until the particle is this far beyond the triangle's edge. Lossless bounces that rise no higher are
/// contact too, and slip that ends within this distance is ignored. Smaller: sliding consists of more, shorter
/// segments, and elastic bounces of the size of rounding use up the bounce budget. Larger: a particle slides on air
/// beyond a convex edge by that distance (some 1e-14 of its coordinates).
inline constexpr double kTouchingOffsets = 8.0;

/// Distance, in contact offsets, that a particle may slide beyond a triangle's edge before it leaves that triangle.
/// Reason: the particle moves one offset above one face of a blunt valley. It reaches the other face only 1 / slope
/// offsets beyond the edge, and both faces must then support it. Smaller: particles zigzag in blunt valleys until their
/// budget is spent. Larger: they slide on air beyond convex edges by that distance (some 1e-12 of the coordinates).
inline constexpr double kEdgeOffsets = 256.0;

/// Largest number of projections of a particle out of the surfaces that it is behind, in one step. After that it
/// returns to its position before the move. Reason: in a corner of several colliders one projection leads behind the
/// next. Smaller: corners stop particles more often. Larger: sharp wedges cost more queries.
inline constexpr int kMaxProjections = 16;

/// Distance within which a particle that was rolled back to a collision touches the surface, relative to its path in
/// one time tolerance. Reason: bisection leaves it up to one such path away. Smaller than 1: a resting particle falls
/// and lands in every step. Larger: particles rest on air that much further away.
inline constexpr double kRollbackTouchPaths = 2.0;

/// Number of consecutive contacts after which a particle comes to rest for the step. In each of them the particle must
/// be under load. It must also be slower than the resting speed, or no time must pass between the contacts. Reason: in
/// a pit of four or more faces a sliding particle circles into the apex in infinitely many ever shorter segments.
/// Smaller: slow sliding over many tiny triangles is cut short. Larger: circling costs more contacts per step.
inline constexpr int kMaxSlowContacts = 32;

/// One minus the cosine of the angle between normals below which two surfaces touched together count as one plane.
/// Smaller: coplanar triangles use up the three contact points of a manifold. Larger: a blunt corner counts as flat.
inline constexpr double kSameNormal = 1e-12;

/// Approach speed towards a plane that a velocity may have after projection onto the plane, relative to the velocity's
/// length. Reason: a few roundings. Smaller: a projection counts as infeasible and the next best, slower one is used.
/// Larger: a particle creeps into a wall's contact offset.
inline constexpr double kProjectionRounding = 0x1p-48;

/// Speed after braking that counts as a stop, relative to the speed before. It covers rounding perpendicular to the
/// motion. Smaller: particles creep on at 1e-16 of their speed instead of coming to rest. Larger: sideways motion is
/// lost.
inline constexpr double kStopRounding = 0x1p-40;

/// Fraction of the step for which a flow must point away from a wall before a stopped particle moves. Smaller: if a
/// flow turns away only at that point, a particle creeps along the wall in ever more hops until its budget is spent.
/// Larger: it starts later, by less than this part of the step.
inline constexpr double kShortestRelease = 1.0 / 64.0;

/// Part of a step below which a path along a wall is skipped if it moves the particle only by rounding. Smaller: the
/// remaining path before a rim or a release is divided by so short a time that velocities overflow. Larger: a particle
/// leaves a wall earlier, by a path of less than a quarter of a contact offset.
inline constexpr double kNoProgress = 0x1p-20;

/// Number of bounces among moving colliders after which the progress of a particle is checked. The second constant is
/// the part of the step that must have passed by then. Otherwise the particle is pinched between closing surfaces and
/// stops for this step. Reason: between closing walls each bounce takes a part of the remaining time, and more bounces
/// would not help. Fewer bounces, or a larger part: particles stop in corners that they could leave. More bounces, or a
/// smaller part: pinched particles cost more bounces.
inline constexpr std::uint32_t kBouncesUntilPinched = 16;
inline constexpr double kPinchedProgress = 1e-3;

/// Kinetic energy that an interval or arc of contact may gain before it is limited, in contact offsets times the force.
/// Reason: beside a rim or in a narrow wedge a particle may have this distance from its supports, at both ends.
/// Smaller: rounding of positions reduces motion in narrow wedges and the first motion from rest. Larger: the error of
/// the method adds as much energy.
inline constexpr double kContactEnergyOffsets = kEdgeOffsets;

/// Limits above which a verified run reports a gain of energy, also for impacts: in contact offsets times the force,
/// and as a fraction of the larger of the kinetic energies before and after. Reason: twice the gain that contact
/// permits; sixteen roundings of 2^-53. Smaller: rounding is reported. Larger: small gains pass.
inline constexpr double kEnergyOffsets = 2.0 * kContactEnergyOffsets;
inline constexpr double kEnergyGain = 0x1p-49;

/// Acceleration, as a fraction of the applied acceleration, up to which a supported particle stays at rest. Reason:
/// some hundred times the rounding of the solved equations. Smaller: particles at rest creep at 1e-16 of gravity.
/// Larger: a particle that begins to slide on a slope at the angle of friction is stopped.
inline constexpr double kHoldRounding = 0x1p-40;

/// Part of a direction of motion that must be perpendicular to others for it to be independent. Reason: a direction
/// made of rounding would remove a motion that nothing opposes. Smaller: such directions count. Larger: particles move
/// in narrow wedges that should support them.
inline constexpr double kDependentDirection = 0x1p-36;

/// Speed along a surface's normal, as a fraction of the speed, from which the particle leaves it. Reason: some hundred
/// roundings. Smaller: rounding removes particles from their supports. Larger: slow separations are suppressed.
inline constexpr double kLeavingRounding = 0x1p-46;

/// The same fraction for a particle beyond the end of a face, where the surface turns away from the motion. Smaller:
/// rolling over an edge begins with a fall and a landing. Larger: slow separations are suppressed.
inline constexpr double kTurningAway = 0x1p-24;

/// Speed in contact that counts as zero if the particle makes no progress. It is a fraction of the velocity change by
/// the forces in the remaining time. Reason: a particle of this speed covers only a ten-billionth of the path due to
/// the forces. Smaller: beside a vertex at the origin steps are spent on moves below the resolution of the clock.
/// Larger: particles that begin to slide there are stopped.
inline constexpr double kNegligibleSpeed = 1e-10;

/// Rebound, as a fraction of the resting speed, below which the bounce cascade takes negligible time. Reason: a fall
/// through the contact offset ends at some 1e-7 m/s. Smaller: particles rattle between surfaces by their offsets.
/// Larger: cascades end too early.
inline constexpr double kNegligibleRebound = 1e-3;

/// Slip of a sphere that several surfaces support, relative to its speed, up to which its direction is ignored. The
/// surface then sticks, or slips in the direction of its forces. Reason: the direction of a slip that is about to end
/// turns within nanoseconds, and contacts open and close with it. Smaller: contacts open and close in this way. Larger:
/// slow slip ends too early, though slip that ends within an interval of its own never comes into this range.
inline constexpr double kSlowSlip = 0x1p-24;

/// Most contact intervals after one impact, in one bounce cascade, or with one set of surfaces of several frames. After
/// that the particle is released. Reason: only sliding on curved surfaces needs more than a few. Smaller: long slides
/// in round shapes are cut into several contacts. Larger: a particle that circles costs more.
inline constexpr int kMostContactIntervals = 64;

/// Number of contact intervals in one step that do not count against the bounce budget, and number of further intervals
/// that count as one bounce. Reason: fast particles in narrow round shapes would otherwise use as many intervals after
/// each impact. Fewer: slides in curved shapes end early. More: such steps take longer.
inline constexpr std::uint32_t kFreeIntervals = 64;
inline constexpr std::uint32_t kIntervalsOfBounce = 4;

/// Duration of a contact segment of the rollback response, as a fraction of the step, below which it counts as no
/// progress. After kMaxSlowContacts such segments in a row the particle rests. Smaller: particles in corners use up
/// their budget. Larger: slow starts are stopped.
inline constexpr double kLeastProgress = 0x1p-20;

/// Most seams that a particle in contact crosses in one step before the continuation of a surface is treated as an
/// impact. Smaller: slides over fine meshes are interrupted. Larger: circling over a vertex costs more.
inline constexpr int kMostSeams = 64;

/// Number of consecutive contact intervals shorter than the resolution of the clock after which a slow particle stops
/// for the step, see kNegligibleSpeed. Reason: beside a vertex at the origin such intervals have no end. Smaller:
/// starts of motion there are cut off. Larger: each such step costs more.
inline constexpr int kMostTimelessIntervals = 24;

/// Most contacts with surfaces of several frames in one step, each of up to kMostContactIntervals. After that the
/// particle counts as jammed and stays. Reason: no particle that comes free needs as many. Smaller: particles between
/// bodies jam. Larger: jammed particles cost more.
inline constexpr int kMostSharedContacts = 64;

/// Approach speed of a landing after a velocity jump of the body, up to which the contact continues. It is a multiple
/// of the speed at which the jump released the particle. Reason: the end of a step only interrupts it. Smaller: such
/// landings bounce. Larger: real impacts lose their rebound.
inline constexpr double kLandsAgain = 2.0;

/// Additional distance beyond the rim of a deforming triangle, in contact offsets, at which a point still moves along
/// the rim. Reason: rounding of its position. Smaller: points fall off a rim by rounding. Larger: they slide on air by
/// as much.
inline constexpr double kOverRim = 0.125;

/// Slip of a point on the rim of a deforming triangle, as a fraction of the resting speed, that counts as no slip.
/// Reason: an impact leaves rounding. Smaller: rounding decides on which side the point leaves the rim. Larger: slow
/// points stay on the rim.
inline constexpr double kStandingSlip = 1e-10;

/// Length of the path, in contact offsets, that decides whether a point on the rim of a deforming triangle moves off
/// it. Reason: over shorter paths rounding decides. Smaller: rounding makes points leave the rim. Larger: the rim
/// counts as straight over that length.
inline constexpr double kRimLookOffsets = 1024.0;

/// Duration by which a point continues after it has left a deforming triangle, as a fraction of its path. Reason: it
/// must then be beyond the rim for certain. Smaller: the same triangle is found again. Larger: the next surface is
/// found later by as much.
inline constexpr double kPastRim = 1e-9;

/// Time between impacts of a particle along a flow, as a part of the step, up to which they follow in quick succession.
/// Reason: half the share of one impact in a budget of 1000. Smaller: the budget is spent in blunt valleys. Larger:
/// slow sequences widen the reach for supports.
inline constexpr double kQuickContact = 0x1p-11;

/// Number of impacts in quick succession after which the reach for supporting surfaces doubles, and the largest factor.
/// Reason: faces of even blunter valleys count as one plane, see kSameNormal. Fewer impacts or a larger factor:
/// particles are supported by surfaces further away. More impacts or a smaller factor: the budget is spent between two
/// faces.
inline constexpr std::uint32_t kContactsToWiden = 8;
inline constexpr double kMostWidening = 4096.0;

}  // namespace ricochet
