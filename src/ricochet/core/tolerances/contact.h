/// \file
/// Tolerances of contact phases: touching, sliding, rest and separation. See core/tolerances.h.
#pragma once

#include <cstdint>

namespace ricochet {

/// Distance from a surface's plane, in contact offsets, up to which a particle touches the surface. Sliding also
/// continues until the particle is this far beyond the triangle's edge. Lossless bounces that rise no higher also count
/// as contact. Slip that ends within this distance is ignored. Smaller: a slide consists of more and shorter segments,
/// and elastic bounces of the size of rounding use up the bounce budget. Larger: a particle slides this far beyond a
/// convex edge without support (about 1e-14 of its coordinates).
inline constexpr double kTouchingOffsets = 8.0;

/// Distance, in contact offsets, that a particle may slide beyond a triangle's edge before it leaves that triangle.
/// Reason: the particle moves one offset above one face of a blunt valley. It touches the other face only 1 / slope
/// offsets beyond the common edge, and then both faces must support it. Smaller: particles zigzag in blunt valleys
/// until their bounce budget is used up. Larger: particles slide this far beyond convex edges without support (about
/// 1e-12 of their coordinates).
inline constexpr double kEdgeOffsets = 256.0;

/// Largest number of times in one step that a particle behind surfaces is projected out of them. After that the
/// particle returns to its position before the move. Reason: in a corner of several colliders, the projection out of
/// one surface can end behind another. Smaller: corners stop particles more often. Larger: sharp wedges cost more
/// queries.
inline constexpr int kMaxProjections = 16;

/// Distance from a surface within which a particle touches it after the rollback to a collision. The unit is the
/// particle's path in one time tolerance. Reason: after the bisection the particle is up to one such path away. Smaller
/// than 1: a resting particle falls and lands in every step. Larger: particles rest at a larger distance from surfaces.
inline constexpr double kRollbackTouchPaths = 2.0;

/// Number of consecutive contacts after which a particle comes to rest for the step. The particle must be under load in
/// each of these contacts. It must also be slower than the resting speed, or no time may pass between the contacts.
/// Reason: in a pit of four or more faces, a sliding particle circles towards the lowest point in infinitely many, ever
/// shorter segments. Smaller: slow sliding over many tiny triangles is cut short. Larger: circling needs more contacts
/// per step.
inline constexpr int kMaxSlowContacts = 32;

/// One minus the cosine of the angle between normals below which two surfaces touched together count as one plane.
/// Smaller: coplanar triangles use up the three contact points of a manifold. Larger: a blunt corner counts as flat.
inline constexpr double kSameNormal = 1e-12;

/// Largest speed towards a plane that a velocity may keep after its projection onto the plane, relative to the
/// velocity's length. Reason: the projection rounds a few times. Smaller: a projection counts as infeasible, and the
/// next one, which gives a lower speed, replaces it. Larger: a particle creeps into a wall's contact offset.
inline constexpr double kProjectionRounding = 0x1p-48;

/// Speed that counts as zero after friction has stopped a particle, relative to the speed before. Reason: it covers
/// rounding perpendicular to the motion. Smaller: particles continue at 1e-16 of their speed instead of coming to rest.
/// Larger: sideways motion is lost.
inline constexpr double kStopRounding = 0x1p-40;

/// Fraction of the step for which a flow must point away from a wall before a stopped particle moves. Smaller: a flow
/// may point away from the wall at only one point. There a particle makes very short hops along the wall until its
/// bounce budget is used up. Larger: a stopped particle starts later, by less than this part of the step.
inline constexpr double kShortestRelease = 1.0 / 64.0;

/// Part of a step below which a path along a wall is skipped if its length is of the size of rounding. Smaller: the
/// remaining path before a rim or a release is divided by a very short time, and velocities overflow. Larger: a
/// particle leaves a wall earlier, by less than a quarter of a contact offset.
inline constexpr double kNoProgress = 0x1p-20;

/// Number of bounces among moving colliders after which the progress of a particle is checked. The second constant is
/// the part of the step that must have passed by then. If less time has passed, the particle is pinched between closing
/// surfaces and stops for this step. Reason: between closing walls each bounce takes only a part of the remaining time,
/// so further bounces do not reach the end of the step. Fewer bounces, or a larger part: particles stop in corners that
/// they could leave. More bounces, or a smaller part: pinched particles need more bounces.
inline constexpr std::uint32_t kBouncesUntilPinched = 16;
inline constexpr double kPinchedProgress = 1e-3;

/// Kinetic energy that a particle may gain in a contact interval or arc before the gain is limited. The unit is a
/// contact offset times the force. Reason: beside a rim or in a narrow wedge a particle may be this far from its
/// supports at both ends of the interval. Smaller: rounding of positions reduces motion in narrow wedges and the first
/// motion from rest. Larger: the error of the method can add more energy.
inline constexpr double kContactEnergyOffsets = kEdgeOffsets;

/// Limits above which a verified run reports a gain of energy, also for impacts. The first limit is in contact offsets
/// times the force. The second one is a fraction of the larger of the kinetic energies before and after. Reason: the
/// first limit is twice the gain that contact permits, and the second one is sixteen roundings of 2^-53. Smaller:
/// rounding is reported. Larger: small gains pass.
inline constexpr double kEnergyOffsets = 2.0 * kContactEnergyOffsets;
inline constexpr double kEnergyGain = 0x1p-49;

/// Acceleration, as a fraction of the applied acceleration, up to which a supported particle stays at rest. Reason: the
/// limit is about a hundred times the rounding of the solved equations. Smaller: particles at rest accelerate at 1e-16
/// of gravity. Larger: a particle stays at rest on a slope slightly steeper than the angle of friction.
inline constexpr double kSupportRounding = 0x1p-40;

/// Smallest length of a unit vector's component perpendicular to other vectors for which the vector counts as
/// independent of them. Reason: a smaller component consists of rounding. Its direction would remove a motion that no
/// surface blocks. Smaller: such vectors count as independent. Larger: particles move in narrow wedges that should
/// support them.
inline constexpr double kDependentDirection = 0x1p-36;

/// Speed along a surface's normal, as a fraction of the particle's speed, from which the particle leaves the surface.
/// Reason: the limit is about a hundred roundings. Smaller: rounding removes particles from their supports. Larger:
/// slow separations are suppressed.
inline constexpr double kLeavingRounding = 0x1p-46;

/// Like kLeavingRounding, for a particle beyond the edge of a face. At that edge the surface turns away from the
/// motion. Smaller: rolling over an edge begins with a fall and a landing. Larger: slow separations are suppressed.
inline constexpr double kTurningAway = 0x1p-24;

/// Speed in contact that counts as zero if the particle makes no progress. It is a fraction of the velocity change by
/// the forces in the remaining time. Reason: a particle of this speed covers only 1e-10 of the path due to the forces.
/// Smaller: beside a vertex at the origin, steps consist of moves whose duration is below the rounding of the time.
/// Larger: particles that begin to slide beside such a vertex are stopped.
inline constexpr double kNegligibleSpeed = 1e-10;

/// Rebound, as a fraction of the resting speed, below which the bounce cascade takes negligible time. Reason: a fall
/// through the contact offset ends at about 1e-7 m/s. Smaller: particles bounce within the contact offsets between
/// surfaces. Larger: cascades end too early.
inline constexpr double kNegligibleRebound = 1e-3;

/// Slip of a sphere that several surfaces support, relative to its speed, up to which the slip's direction is ignored.
/// The contact then sticks, or slips in the direction of its forces. Reason: the direction of a slip that is about to
/// end turns within nanoseconds, and contacts open and close with each turn. Smaller: contacts open and close with
/// these turns. Larger: slow slip ends too early. Slip that ends within an interval of its own never reaches this
/// limit.
inline constexpr double kSlowSlip = 0x1p-24;

/// Largest number of contact intervals after one impact, in one bounce cascade, or with one set of surfaces of several
/// frames. After that the particle is released. Reason: only sliding on curved surfaces needs more than a few
/// intervals. Smaller: long slides in round shapes consist of several contact phases. Larger: a particle that circles
/// in a round shape takes more time.
inline constexpr int kMostContactIntervals = 64;

/// Number of contact intervals in one step that do not count against the bounce budget, and number of further intervals
/// that count as one bounce. Reason: fast particles in narrow round shapes would otherwise use kMostContactIntervals
/// intervals after each impact. Smaller: slides in curved shapes end early. Larger: steps of such particles take
/// longer.
inline constexpr std::uint32_t kFreeIntervals = 64;
inline constexpr std::uint32_t kIntervalsOfBounce = 4;

/// Duration of a contact segment of the rollback response, as a fraction of the step, below which the segment counts as
/// no progress. The particle rests after kMaxSlowContacts such segments in a row. Smaller: particles in corners use up
/// their bounce budget. Larger: slow starts are stopped.
inline constexpr double kLeastProgress = 0x1p-20;

/// Largest number of seams that a particle in contact crosses in one step. At the next seam, the neighbouring triangle
/// is treated as an impact. Smaller: slides over fine meshes are interrupted. Larger: a particle that circles around a
/// vertex takes more time.
inline constexpr int kMostSeams = 64;

/// Number of consecutive contact intervals shorter than the rounding of the time, after which a slow particle stops for
/// the step. See kNegligibleSpeed. Reason: beside a vertex at the origin the sequence of such intervals does not end.
/// Smaller: particles that start to move beside such a vertex are stopped. Larger: each such step takes more time.
inline constexpr int kMostTimelessIntervals = 24;

/// Largest number of contacts with surfaces of several frames in one step. Each contact has up to kMostContactIntervals
/// intervals. After that the particle counts as jammed and stays. Reason: particles that can separate from the surfaces
/// need fewer contacts. Smaller: more particles between bodies jam. Larger: jammed particles take more time.
inline constexpr int kMostSharedContacts = 64;

/// Largest approach speed at which a particle lands on a body without an impact, after a velocity jump of the body has
/// ended their contact. The earlier contact then continues. The limit is a multiple of the speed at which the jump
/// released the particle. Reason: the end of a step only interrupts such a contact. Smaller: such landings bounce.
/// Larger: real impacts lose their rebound.
inline constexpr double kLandsAgain = 2.0;

/// Additional distance beyond the rim of a deforming triangle, in contact offsets, at which a point still moves along
/// the rim. Reason: the position of the point is rounded. Smaller: points leave a rim by rounding. Larger: points slide
/// further without support.
inline constexpr double kOverRim = 0.125;

/// Slip of a point on the rim of a deforming triangle, as a fraction of the resting speed, that counts as no slip.
/// Reason: after an impact, rounding leaves a small slip. Smaller: rounding decides on which side the point leaves the
/// rim. Larger: slow points stay on the rim.
inline constexpr double kStandingSlip = 1e-10;

/// Length of the path, in contact offsets, that decides whether a point on the rim of a deforming triangle moves off
/// the rim. Reason: over a shorter path, rounding would decide. Smaller: rounding makes points leave the rim. Larger:
/// the rim counts as straight over a longer path.
inline constexpr double kRimPathOffsets = 1024.0;

/// Duration by which a point continues its path after it has left a deforming triangle, as a fraction of the path's
/// duration. Reason: the point is then certainly beyond the rim. Smaller: the same triangle is found again. Larger: the
/// next surface is found later.
inline constexpr double kPastRim = 1e-9;

/// Time between two impacts of a particle along a flow, as a part of the step, up to which the impacts count as quick
/// succession. Reason: with a budget of 1000 impacts, an average impact has 1/1000 of the step, and the limit is half
/// of that. Smaller: the budget is used up in blunt valleys. Larger: slow sequences also widen the search for supports.
inline constexpr double kQuickContact = 0x1p-11;

/// Number of impacts in quick succession after which the search distance for supporting surfaces doubles, and the
/// largest factor. Reason: faces of valleys too blunt for this factor count as one plane, see kSameNormal. Fewer
/// impacts or a larger factor: surfaces further away support particles. More impacts or a smaller factor: the budget is
/// used up between two faces.
inline constexpr std::uint32_t kContactsToWiden = 8;
inline constexpr double kMostWidening = 4096.0;

}  // namespace ricochet
