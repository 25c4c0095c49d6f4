/// \file
/// Every tolerance of the library, with its unit, its reason, and what breaks if it changes.
/// None of them decides whether a particle crosses a surface: that is left to exact predicates.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "ricochet/core/vec3.h"

namespace ricochet {

// Safe positions

/// Contact offset: distance between a safe position and the surface that was hit, in ulp of the contact point's largest
/// coordinate. Reason: rounding cannot put the safe position on the surface, and the offset stays invisible. Smaller:
/// certificates fail more often. Larger: each impact adds g * offset to an elastic ball's energy per mass.
inline constexpr double kContactOffsetUlps = 16.0;

/// Smallest contact offset, m; matters at the very origin only. Must stay above kSmallestExactCoordinate.
inline constexpr double kSmallestContactOffset = 0x1p-240;

/// How often a contact offset whose certificate fails is widened, and the factor.
inline constexpr int kSafePositionAttempts = 4;
inline constexpr double kContactOffsetWidening = 4.0;

/// Largest distance between a contact point and a safe position that is tried, in ulp of the point's largest
/// coordinate: 2^-40 of it, inside kCandidateSlack, so that the candidates already gathered cover every position.
/// Smaller: sharp wedges, whose bisector leaves both walls slowly, hold fewer safe positions.
inline constexpr double kLargestContactOffsetUlps = 4096.0;

/// Fraction by which a sphere's distance at a contact may fall short of its radius and still be corrected by
/// safe_position; beyond it the sphere started in overlap and stays where it is. Smaller: grazing contacts are not
/// corrected. Larger: a sphere born in a slight overlap is pushed out.
inline constexpr double kContactMismatch = 1e-9;

/// Depth to which a path is halved while its chords are certified. 2^-52 of the path is below the rounding of its
/// points; a chord that still intersects a triangle there is taken as an impact at that position.
inline constexpr int kCertificateDepth = 52;

/// Smallest part of its radius as which a sphere in overlap collides; below it the sphere collides as a point. Reason:
/// its spin counts at the surface of what collides, and would be that much faster there. Smaller: rounding of the
/// contact offset is felt as curvature. Larger: spheres that are nearly half behind a surface lose friction's torque.
inline constexpr double kSmallestCore = 0x1p-20;

/// Part of a distance by which a triangle's rim may be farther than its face and count as as near. Reason: some ten
/// roundings. Smaller: the rim counts within 1e-8 of the distance inside. Larger: nothing, the exact test decides.
inline constexpr double kRimTie = 0x1p-48;

// Contact phases

/// A surface counts as touched while the particle is within this many contact offsets of its plane, and sliding goes on
/// until the particle is as far beyond the triangle's edge. Bounces without losses that rise no higher are contact too,
/// and slip that ends sooner is none. Smaller: sliding is cut into more, shorter segments, and elastic bounces of
/// rounding's size spend the bounce budget. Larger: a particle slides on air beyond a convex edge by that distance
/// (some 1e-14 of its coordinates).
inline constexpr double kTouchingOffsets = 8.0;

/// Contact offsets by which a particle may slide beyond a triangle's edge before it leaves that triangle. Reason: at an
/// offset above one face of a blunt valley the other face is reached only 1 / slope offsets beyond the edge, and both
/// must then support. Smaller: particles zigzag in blunt valleys until their budget is spent. Larger: they slide on air
/// beyond convex edges by that distance (some 1e-12 of the coordinates).
inline constexpr double kEdgeOffsets = 256.0;

/// Passes of projecting a particle out of what it is behind in one step; after that it returns to where it came from.
/// Reason: in a corner of several colliders one projection leads behind the next. Smaller: corners stop particles more
/// often. Larger: sharp wedges cost more queries.
inline constexpr int kMaxProjections = 16;

/// Smallest restitution of a spring and damper: less would need damping without bound, which no step can follow.
/// Smaller: the stability bound of dead surfaces shrinks with its root. Larger: they bounce more.
inline constexpr double kMinPenaltyRestitution = 0.01;

/// Distances travelled in one time tolerance within which a particle that was rolled back to a collision counts as
/// touching the surface. Reason: bisection leaves it up to one such distance off. Smaller than 1: resting contact falls
/// and lands in every step. Larger: particles rest on air that much further off.
inline constexpr double kTouchBrackets = 2.0;

/// Contacts in a row, pressed on and all slower than the resting speed or without time between them, after which a
/// particle comes to rest for the step. Reason: in a pit of four or more faces a sliding particle circles into the apex
/// in infinitely many ever shorter segments. Smaller: slow sliding over many tiny triangles is cut short. Larger:
/// circling costs more contacts a step.
inline constexpr int kMaxSlowContacts = 32;

/// One minus the cosine of the angle between normals below which two surfaces touched together count as one plane.
/// Smaller: coplanar triangles use up the three contact points of a manifold. Larger: a blunt corner counts as flat.
inline constexpr double kSameNormal = 1e-12;

/// What a velocity that was projected onto a plane may still approach it by, relative to its length: a few roundings.
/// Smaller: a projection is taken for infeasible and the next best, slower one is used. Larger: a particle creeps into
/// a wall's contact offset.
inline constexpr double kProjectionRounding = 0x1p-48;

/// Speed left by braking to a stop, relative to the speed before, that still is a stop: rounding across the heading.
/// Smaller: particles creep on at 1e-16 of their speed instead of coming to rest. Larger: sideways motion is lost.
inline constexpr double kStopRounding = 0x1p-40;

/// Angle, rad, by which the direction of sliding or of slip may turn in one contact interval: friction keeps the
/// direction of its middle. Smaller: more segments (each costs a query). Larger: where a slide ends depends on the time
/// step by the angle's square.
inline constexpr double kMaxHeadingTurn = 0.05;

/// The same where the direction of slip turns within a small part of the step, since there is hardly any. Smaller: more
/// segments for each reversal of a slip. Larger: a slip that begins depends on the time step.
inline constexpr double kMostHeadingTurn = 0.5;

/// Part of a slip that turns by which it may change in one arc. Reason: as kMaxArcAngle. Smaller: more arcs at the end
/// of every slip. Larger: where a slide ends depends on the time step.
inline constexpr double kMaxSlipChange = 0.1;

/// Angle, rad, up to which friction turns in an interval of constant acceleration; beyond, and up to kMaxHeadingTurn,
/// the motion is integrated as an arc is. Reason: the midpoint rule's error is the angle's square by 24. Smaller: more
/// cost. Larger: where a slide ends depends on the time step.
inline constexpr double kMostStraightTurn = 1e-3;

/// Sine of the angle between friction's directions at the start and in the middle of a contact interval below which
/// they are one. Smaller: rounding has the contact problem solved twice. Larger: slow turns add up.
inline constexpr double kStraightHeading = 0x1p-44;

/// Angle, rad, by which a particle turns around an edge or a curved surface in one straight segment of sliding or
/// rolling with the rollback response, and along flows. Smaller: more segments (each costs a query). Larger: it leaves
/// the surface by more (angle^2 / 2 of the radius of curvature) before it falls back.
inline constexpr double kMaxChordAngle = 0.01;

/// Part of a step for which a flow has to lead a particle away from a wall that has stopped it before it goes. Smaller:
/// where a flow turns away only on the spot, a particle creeps along the wall in ever more hops, until its budget is
/// spent. Larger: it starts later, by less than this part of the step.
inline constexpr double kShortestRelease = 1.0 / 64.0;

/// Part of a step below which a path along a wall that moves the particle by rounding only is not made. Smaller: what
/// is left before a rim or a release is divided by times so short that velocities leave the range of the arithmetic.
/// Larger: a particle lets go of a wall earlier, by less than a quarter of a contact offset of its way.
inline constexpr double kNoProgress = 0x1p-20;

// Broad phase and look-ahead

/// Distance, relative to the largest coordinate involved, that is left beside a path in free flight for many steps.
/// Reason: it covers kCandidateSlack and the rounding of kMaxLookAheadSteps steps, each of some 2^-52 for the position
/// and as much again, times the number of steps, for the velocity. Smaller than some 2^-38: a particle could be taken
/// past a surface that a query would have found. Larger: particles near surfaces need more queries.
inline constexpr double kLookAheadSlack = 0x1p-36;

/// Steps of free flight without a new query, on straight paths and on parabolas. Larger: kLookAheadSlack must grow with
/// the first; with the second it is charged for a longer path than the boxes' margin lets one query cover.
inline constexpr int kMaxLookAheadSteps = 4096;
inline constexpr int kMaxLookAheadStepsCurved = 256;

/// By how much paths may leave the chords that the broad phase is queried with, in parts of the mean triangle's box: as
/// a rule, and where particles look ahead along parabolas, for which it limits how far. Smaller: more chords for a path
/// next to surfaces, more queries along it. Larger: boxes overlap more (measured: 1/16 and 1/8 are alike in hail, 1/16
/// is a tenth faster where debris slides, 1/4 slower in both; 1/8 costs gas 10 %). No result depends on them.
inline constexpr double kChordMargin = 1.0 / 32;
inline constexpr double kLookAheadMargin = 1.0 / 16;

/// Least of that, in parts of the box of all triangles and of a sphere's radius, where triangles are tiny or points.
/// Smaller: paths next to tiny triangles are cut into chords without number. Larger: boxes overlap more where
/// triangles are much smaller than the scene. No result depends on it.
inline constexpr double kLeastChordMargin = 0x1p-26;

/// Rounding of positions in a distance field, in cells. Reason: positions are rounded to some 2^-50 of the largest
/// coordinate, of which a cell is kSmallestDistanceCell at least, and to as much of the grid's thousand cells. Smaller
/// than some 2^-18: a triangle could be nearer than the lower bound. Larger: bounds are that much smaller.
inline constexpr double kDistanceFieldRounding = 0x1p-10;

/// Smallest edge of a distance field's cell, relative to the largest coordinate. Smaller than some 2^-36: see
/// kDistanceFieldRounding. Larger: small meshes far from the origin get no field, and curved paths near them are
/// queried piece by piece.
inline constexpr double kSmallestDistanceCell = 0x1p-30;

/// Distance, relative to the largest coordinate involved, by which a candidate triangle, its box or its plane must
/// clear the path before the triangle is culled; also the sine of the angle at which a path leads away from one.
/// Reason: covers the displacement of safe positions (2^-40) and the rounding of points on the path. Smaller: a
/// certificate could miss a triangle near a safe position. Larger: more triangles reach the narrow phase.
inline constexpr double kCandidateSlack = 0x1p-39;

/// Rounding of a point on a path, relative to the largest coordinate that the path's terms reach: some ten roundings of
/// 2^-53. Where that exceeds the boxes' margin, all triangles are candidates; steps of free flight that lead a sphere
/// away from a triangle by less than that may lead it back. Smaller: a sphere could be taken through such a triangle.
inline constexpr double kPathRounding = 0x1p-48;

/// Boxes handed to Embree grow by this many units of 2^-24 times the scene's largest centred coordinate. Reason: covers
/// rounding of the ray's origin, direction and of t * direction in single precision on each axis. Smaller than about 8:
/// a touched triangle might not be proposed, and particles could leak.
inline constexpr double kBoxPaddingUnits = 16.0;

/// Boxes grow further, by this part of the half extent and kCandidateSlack of the largest world coordinate: safe
/// positions and rounded points of a path lie beside the segments of a query. Smaller: paths that reach far beyond the
/// mesh need every triangle as a candidate sooner (at kBoxSlack / kPathRounding half extents, 2^28).
inline constexpr double kBoxSlack = 0x1p-20;

/// By how much a body that moves may see a path beside where it is, as a part of the larger of the radius and the
/// distance from the frame's origin; the cubics that it sees are as short as that takes. Reason: one cubic for a turn
/// of a degree. Times of impact are found again on the true way and do not depend on it. Smaller: more cubics. Larger:
/// a graze that is nearer than that to a miss is taken for one sooner, and safe positions are searched from further
/// off.
inline constexpr double kMovingPathTolerance = 1e-9;

/// Most such cubics for one path between two keys. Reason: kMovingPathTolerance asks for some 250 a turn; more than 16
/// turns in a step are no motion that a step can follow. Smaller: fast bodies see paths less closely than that
/// tolerance says. Larger: a step beside a body that turns still faster takes longer.
inline constexpr double kMostMovingPieces = 4096.0;

/// Most keys of a body's curves that are looked at one by one in a step: paths are cut there, boxes of the motion
/// joined. What follows them, as in a curve that repeats much faster than the step, is one stretch. Smaller: an impact
/// beside a later key is found where a cubic across the jump says, and boxes are wider. Larger: steps of such bodies
/// take longer.
inline constexpr int kMostKeysInStep = 256;

/// By how much a body's box grows over a step for the rounding of poses and sums, as a part of its largest coordinate.
/// Reason: some thousand roundings of 2^-53. Smaller than some 2^-49: a body may come out of its box, and through
/// particles that it should have met. Larger: particles nearby look at the body for nothing.
inline constexpr double kSweptBoxRounding = 0x1p-40;

/// Difference of a body's velocities on both sides of a key, as a part of both, above which they jump there. Reason:
/// the rounding of derivatives of curves. Smaller: what rides is let go, and lands again, at keys where nothing jumps.
/// Larger: what rides is carried through jumps of that size.
inline constexpr double kSameVelocity = 1e-12;

// Narrow phase

/// Times closer than this many ulp count as simultaneous: all surfaces hit then answer together (corners).
inline constexpr double kSimultaneousUlps = 4.0;

/// One minus the cosine of the angle between the normals of a face and of an edge or vertex that a sphere hits at the
/// same time, below which the edge is the face's own seam and does not answer. Reason: contacts tie while the closest
/// point is within sqrt(2 * rounding * radius) of the edge, an angle of 1e-6 for coordinates of a thousand radii.
/// Smaller: a grazing sphere is nudged by flat inner edges. Larger: blunt real edges answer as faces.
inline constexpr double kSeamTurn = 1e-11;

/// Distance by which a sphere may overlap a surface before its segment is refused, relative to radius plus coordinates.
/// Reason: distances and safe positions are rounded to a few 1e-16 of the coordinates, and a sphere at a safe position
/// must pass. Smaller (below some 1e-15): safe positions fail their own certificate. Larger: spheres may sink in by
/// that much. It never lets a centre through: that is decided by the exact certificate of the centre's segment.
inline constexpr double kSphereTolerance = 1e-12;

/// Lateral distance, relative to the largest coordinate involved, up to which a sphere that touches an edge or a vertex
/// counts as touching the face beside it. Reason: over the seam of a flat plate the closest point is on either side by
/// rounding, and the sphere should bounce as off one plate. Smaller than some 2^-50: seams of flat plates deflect by
/// rounding errors. Larger: on a convex edge the normal is wrong by up to this length over the radius.
inline constexpr double kSeamSlack = 0x1p-48;

/// A sphere that already overlaps a surface counts as approaching only when the distance shrinks faster than this
/// fraction of its speed. Reason: a velocity along the surface has a normal component of rounding errors, which must
/// not be stopped again and again. Larger: a sphere that overlaps at birth can sink in by that fraction of its path.
inline constexpr double kMinApproach = 0x1p-48;

/// Rounding of a pseudonormal, relative to the sum of the weights of the normals it is the mean of, and of its scalar
/// product with a unit vector: a few roundings of 2^-50 and one of 2^-53 for each of some hundred triangles around a
/// vertex. Below it normals count as cancelled and sides as undecided. Smaller: rounding tells sides apart at knife
/// edges. Larger: edges sharper than that (rad) have no sides.
inline constexpr double kPseudonormalRounding = 0x1p-44;

/// Points at which one segment crosses neighbouring triangles are one crossing when they are nearer to each other than
/// this part of their largest coordinate. Reason: through an edge a segment crosses two triangles at points that differ
/// by rounding only. Smaller: such a crossing counts twice, and an open surface that was crossed looks as if it was
/// not. Larger: the two faces of a thinner plate count as one.
inline constexpr double kSameCrossing = 1e-9;

// Dynamics

/// Correction of a velocity, relative to the largest speed in the system, with which Newton's method for the implicit
/// step has converged. Reason: convergence is quadratic near the solution, so the remaining error is far below, and
/// rounding of the forces (some 1e-16 times the stiffness number) must not keep it going. Smaller: stiff systems never
/// report convergence. Larger: the step's end solves its equation less closely; stability is not affected.
inline constexpr double kNewtonTolerance = 1e-10;

/// Energy created by the integrator at which the run stops as diverged, in parts of all that forces and walls have
/// given. Reason: errors of stable methods stay below what was given, explosions pass any bound within a few steps.
/// Smaller: coarse but stable runs are stopped. Larger: more nonsense is written before the stop.
inline constexpr double kDivergedGain = 100.0;

/// Strain of springs whose energy counts as rounding where nothing else moves. Smaller than some 1e-8: a network at
/// rest counts as diverged by its own rounding. Larger: explosions from perfect rest are detected later.
inline constexpr double kNegligibleStretch = 1e-6;

/// Distance below which particles stand at one place and have no direction between them, m: forces between them are
/// zero. Reason: its third power is the smallest that is still a normal number with margin. Smaller (from 1e-102 on):
/// the inverse cube overflows. Larger: nothing that is simulated.
inline constexpr double kSamePlace = 1e-100;

/// Speed that forces may not exceed, m/s: that of light (exact by the definition of the metre). Forces that do so are
/// wrong or the step is too long for them; the run stops. Particles that start faster are left alone.
inline constexpr double kMaxSpeed = 299792458.0;

/// Largest coordinate a mesh or plane may have, m, and largest state a particle may reach before it is frozen.
/// Reason: the predicates multiply three coordinates and must not overflow; far inside kLargestExactCoordinate.
inline constexpr double kLargestCoordinate = 1e75;

/// Smallest size of a surface, m: of a mesh from end to end, of a shape's diameter and height. Reason: coordinates
/// below kSmallestExactCoordinate count as zero, which is far below the rounding of such a surface's own; products of
/// four lengths, with their errors in double-double, stay normal numbers; and the smallest contact offset is less than
/// 1e-12 of it. Smaller (from 1e-70 on): triangles lose their areas to underflow, and particles and rays miss them.
/// Larger: nothing that is simulated.
inline constexpr double kSmallestSize = 1e-60;

/// Largest coefficient of a path, m/s^k, that is followed. Reason: a cubic between two places that are left in next to
/// no time has ones of their distance over the cube of that; sums of their squares must not overflow in the narrow
/// phase. Larger: a sphere's way has no roots among numbers that are none, and is left to the certificate alone.
/// Smaller (from 1e40 on): short arcs that can be followed are not.
inline constexpr double kLargestPathCoefficient = 1e120;

/// Least mass of a particle, kg, fragments included. Reason: inertia (0.4 m r^2), momentum and kinetic energy of what
/// is slow and small have to stay normal numbers, and a share of a mass is a whole multiple of its last bit, which must
/// not be 0. Smaller (from 1e-308 on): masses of fragments become 0 or not a number. Larger: nothing that weighs
/// anything.
inline constexpr double kSmallestMass = 1e-300;

/// Part of a rope's length by which it must exceed the distance of its ends to be laid out as a catenary, not straight.
/// Smaller (below some 1e-14): the catenary's parameter is rounding. Larger: nearly taut ropes start shortened.
inline constexpr double kTautRope = 1e-9;

/// Sideways distance of a rope's ends, relative to its length, below which it hangs straight down and comes back.
/// Smaller than some 1e-300: exponentials overflow. Larger: narrow catenaries lose their curvature.
inline constexpr double kFoldedRope = 1e-9;

/// Parts of an impact's change of a particle's velocity by which all impacts of a part of a step before it may change
/// the velocity of the body that it hits, and of the energy that they take off by which their being answered at once
/// may change it. Larger: light bodies are hit as if they had not been moved yet, from 1 on energy grows. Smaller: more
/// parts of steps.
inline constexpr double kMostBodyChange = 0.1;

/// Mass of what lies on a body, over that with which the body yields to it, above which the part of a step is planned
/// again until its load fits. Larger: from 1 on energy grows. Smaller: more work for what converges by itself from step
/// to step.
inline constexpr double kHeavyLoad = 0.5;

/// Parts of the change of velocity that a part of a step may have by what lies on a body, by which the load of its plan
/// may differ from that which comes. Larger: energy comes in, or is lost. Smaller: the part is planned more often.
inline constexpr double kLoadFits = 1e-3;

/// How often a part of a step is planned for one length of it. Smaller: parts get shorter where loads begin and end
/// within them. Larger: these cost more before they do.
inline constexpr int kMostLoadRounds = 8;
/// As many where it cannot be shorter.
inline constexpr int kFewLoadRounds = 3;

/// Parts of the time to the next impact, or to the step's end, after which a part of a step ends: bodies take impulses
/// there; its square or cube where impacts take little energy off. Larger: bodies go on longer as if nothing had hit
/// them. Much smaller: grains that settle on a body make many parts.
inline constexpr double kPartAfterImpact = 1e-3;

/// Parts of the time step that a part of a step lasts at least. Smaller: bodies between many impacts take longer.
/// Larger: more impacts are answered as if they came at once, and may put energy in.
inline constexpr double kShortestPart = 1e-4;

/// Relative to the energies that are exchanged: more than the rounding of their sums. Smaller: parts of steps end at
/// every impact. Larger: bodies gain energy.
inline constexpr double kImpactEnergyRounding = 1e-14;

/// Unit of the per-triangle impulse totals, N s: 128-bit integers in this unit, so that sums do not depend on the
/// order. The largest total is 2^27 N s = 1.3e8 N s (beyond it the total wraps).
inline constexpr double kImpulseUnit = 0x1p-100;

/// Distance from x, which is finite, to the next larger double magnitude.
[[nodiscard]] inline double ulp(double x) {
    const double magnitude = std::fabs(x);
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(magnitude) + 1) - magnitude;
}

/// The contact offset at a contact point, m: depends on the point's own coordinates only, so that a wall of two or two
/// million triangles gives the same bits.
[[nodiscard]] inline double contact_offset(const Vec3& contact) {
    return std::max(kContactOffsetUlps * ulp(max_abs(contact)), kSmallestContactOffset);
}

/// The overlap that a certified segment of a sphere may show, m: radius and the largest coordinate involved in m.
[[nodiscard]] inline double sphere_tolerance(double radius, double largest_coordinate) {
    return kSphereTolerance * (radius + largest_coordinate);
}

/// Smallest tolerance, m and m/s, of the integrator that chooses its own steps. Reason: what it asks for is kept by
/// ever shorter sub-steps, whose number grows with its fifth root. Smaller: a step that never ends. Larger: systems of
/// 1e-15 m and less could not be followed closely.
inline constexpr double kSmallestTolerance = 1e-30;

/// Shortest sub-step of an adaptive method, as a part of the step that it cuts. One that is still wrong by more than
/// the tolerance is taken as it is, and its particle-step is counted (coarse_steps). Reason: a particle passes a jump
/// of a force with an error of 2^-48 of what the jump gives it in a step, and no sub-step near a point of infinite
/// force is short enough. Smaller: the clock, which rounds to 2^-53 of the time, does not move. Larger: close passages
/// of point masses lose their accuracy earlier.
inline constexpr double kShortestSubstep = 0x1p-48;

/// Most sub-steps of an adaptive method in one step of a particle. The rest of the step is not simulated, and counted
/// (budget_exhausted). Reason: some tenths of a second of work. Smaller: particles bound close to a point mass, which
/// need some 50 sub-steps an orbit, stand still for a part of each step. Larger: a step takes longer before it ends.
inline constexpr std::uint32_t kMostSubsteps = 100000;

/// Error of an adaptive sub-step, relative to the largest component of the state, that is as good as none: a quarter of
/// its rounding. Smaller: sub-steps shorten without end where the tolerance asks for more than doubles hold. Larger:
/// tolerances that could be kept are not.
inline constexpr double kStateRounding = 0x1p-54;

/// Largest defect of the equations of contact with friction, as a part of the largest rate (forces per mass and rates
/// have the same unit), up to which they count as solved. Reason: some ten times what rounding leaves. Smaller:
/// problems that are solved count as unsolved. Larger: energy may grow by as much.
inline constexpr double kCoulombResidual = 0x1p-40;

/// The same up to which an answer is taken before less friction is tried. Reason: where surfaces press against each
/// other and nothing decides by how much, rounding leaves 1e-7 and more; the next smaller friction would be wrong by
/// 1e-3. Smaller: what rolls between two surfaces slips for a moment. Larger: worse answers, of which the energy is
/// limited.
inline constexpr double kNearlySolved = 1e-4;

/// The defect at which they are not improved any more. Reason: rounding of six products. Smaller: steps that change
/// nothing. Larger: worse answers.
inline constexpr double kCoulombRounding = 0x1p-50;

/// Compliance, relative to the inertia of the particle, of contacts that count as stiff. Reason: normals that differ by
/// its square root, 1e-5, still tell apart which of two contacts holds; where normals are closer than that, proximal
/// steps do. Smaller: the equations cannot be solved in doubles. Larger: more proximal steps.
inline constexpr double kStiffCompliance = 1e-10;

/// By how much compliance falls at a time on the way from soft contacts to stiff ones, at first, and where no answer is
/// found, at last. Reason: two digits at a time lose the answer in one case of a thousand. Smaller: it is lost more
/// often. Larger: longer ways.
inline constexpr double kStiffening = 1e-2;
inline constexpr double kShortestStiffening = 0.9;

/// Energy that impulses of a contact network may seem to add, as a part of the sum of their works. Reason: rounding of
/// sums over a thousand contacts. Smaller: elastic impacts lose their rebound. Larger: energy may grow by as much.
inline constexpr double kNetworkEnergyRounding = 1e-12;

/// Part of an overlap of spheres in dense contact that one step undoes. Reason: what sweeps leave over must not add up
/// from step to step; half of it settles in a few steps without a jerk. Smaller: overlaps last. Larger: deep ones, of
/// hard impacts, throw spheres out.
inline constexpr double kNetworkPushOut = 0.5;

/// By how much sweeps over contact networks overdo each normal impulse. Reason: with 1.2 boxes of 2000 spheres come to
/// rest with two thirds of the sweeps, 1.5 makes friction waver. Smaller: more sweeps. Larger: they diverge at 2.
inline constexpr double kNetworkOverRelaxation = 1.2;

/// Overlap, as a part of the smallest radius, that a step may leave when sweeps end early (the speed by which contacts
/// still close, times the step). Reason: half of what may show while grains are poured (5e-3): 10 000 that are poured
/// show 2.8e-3. Smaller: more sweeps. Larger: hard impacts of many spheres overlap.
inline constexpr double kNetworkOverlap = 2.5e-3;

/// Speed by which the conditions of a contact network may be violated, as a part of its fastest sphere's, so that what
/// comes to rest is solved ever more closely. Smaller: more sweeps for what moves anyway. Larger: piles creep.
inline constexpr double kNetworkResidual = 1e-2;

/// The same as a part of the smallest radius a step, where that is more. Reason: far below the largest drift that a
/// pile may have. Smaller: sweeps that change nothing. Larger: piles creep.
inline constexpr double kNetworkStill = 1e-7;

/// Turn, rad, of surfaces of different frames, or of what bends under a particle that they hold together, in one
/// interval of contact. Reason: within an interval they count as the planes that they are at its start, and its square
/// is the error. Smaller: more intervals (each costs a query), and a step's limit of them is reached sooner. Larger:
/// contact with several frames at once is less exact.
inline constexpr double kMostSharedTurn = 0.02;

/// Bounces among colliders that move after which a particle's progress is looked at, and the part of the step that has
/// to have passed by then; otherwise surfaces close on it, and it stays for this step. Reason: between walls that close
/// each bounce takes a part of the time that is left, and more of them would not help. Fewer bounces, or a larger part:
/// particles in corners are left behind that would come out. More, or smaller: particles that are being squeezed cost
/// more bounces.
inline constexpr std::uint32_t kBouncesToClose = 16;
inline constexpr double kLeastWayOut = 1e-3;

/// Length of the difference of unit normals up to which surfaces count as one in an impact or a contact. Reason: what
/// two such surfaces do apart differs by as much, far below what a path's parabolas are exact to; the facets of a flat
/// surface, and seams, differ by rounding. Smaller: nearly redundant contacts, whose forces are ill-conditioned.
/// Larger: a wedge of that angle holds less than it should.
inline constexpr double kSameDirection = 1e-9;

/// By how much rounding may raise twice the energy over the mass in an impact, as a part of the squares of the velocity
/// and of the velocity changes by all surfaces, before that counts as a gain. It is scaled away. Reason: some ten times
/// the rounding of the solved equations. Smaller: restitution is lowered where only rounding is seen. Larger: a gain by
/// friction is scaled away instead of lowering the restitution.
inline constexpr double kEnergyRounding = 0x1p-44;

/// Kinetic energy that an interval or arc of contact may gain, in contact offsets times the force, before its energy is
/// limited. Reason: beside a rim or in a narrow wedge a particle may stand off what holds it by as much, at both ends.
/// Smaller: motion in narrow wedges, and the first motion from rest, lose what is rounding of positions. Larger: the
/// error of the method gives as much.
inline constexpr double kContactEnergyOffsets = kEdgeOffsets;

/// The same before a verified run says so, also for impacts, and in parts of the larger of the kinetic energies before
/// and after. Reason: twice what contact lets pass; sixteen roundings of 2^-53. Smaller: rounding is reported. Larger:
/// small gains pass.
inline constexpr double kEnergyOffsets = 2.0 * kContactEnergyOffsets;
inline constexpr double kEnergyGain = 0x1p-49;

/// Acceleration, as a part of what presses on, up to which what surfaces hold stays where it is. Reason: some hundred
/// times the rounding of the solved equations. Smaller: particles at rest creep at 1e-16 of gravity. Larger: what
/// begins to slide on a slope at the angle of friction is held.
inline constexpr double kHoldRounding = 0x1p-40;

/// Part of a direction of motion that must be at right angles to others for it to be one of its own. Reason: a
/// direction made of rounding would take a motion away that nothing opposes. Smaller: that. Larger: narrow wedges let
/// move what they hold.
inline constexpr double kDependentDirection = 0x1p-36;

/// Speed along a surface's normal, as a part of the speed, from which the particle leaves it. Reason: some hundred
/// roundings. Smaller: rounding lets particles lose what holds them. Larger: slow departures are held back.
inline constexpr double kLeavingRounding = 0x1p-46;

/// The same where a face has ended and its edge turns away from the motion by as much as the particle is beyond it.
/// Smaller: rolling over an edge begins with a fall and a landing. Larger: slow departures are held back.
inline constexpr double kTurningAway = 0x1p-24;

/// Angle, rad, by which a particle turns around an edge or along a curved surface in one arc. Reason: the fifth power
/// of it is the error of an arc. Smaller: more arcs (each costs a query). Larger: paths of swings and rolls are less
/// exact.
inline constexpr double kMaxArcAngle = 0.1;

/// Turn, rad, of a curved surface under a sphere in one arc, from which on the arc is searched for a jump of the
/// nearest point. Reason: planned arcs turn by kMaxArcAngle. Smaller: whole arcs are searched and cut. Larger: a sphere
/// wider than a shape goes on through the side that it has jumped to.
inline constexpr double kMostTurn = 2.0 * kMaxArcAngle;

/// Turn, rad, between two times 2^-40 of an arc apart, or way in radii (also where an arc begins), that is a jump: the
/// surface is narrower than the sphere, which jams. Smaller: what turns fast jams. Larger: small jumps are passed.
inline constexpr double kJump = 1e-3;

/// Largest part by which an arc's end is corrected to have its energy. Reason: the method's own error is far below it;
/// more would hide another mistake. Smaller: slow turning points are left uncorrected. Larger: that.
inline constexpr double kMostEnergyCorrection = 1e-2;

/// Speed in contact, as a part of what the forces would give in the time that is left, that is none where it does not
/// lead on. Reason: it leads a ten-billionth of the way that the forces would. Smaller: beside a vertex at the origin
/// steps are spent on moves that no clock can tell. Larger: what begins to slide there is stopped.
inline constexpr double kNegligibleSpeed = 1e-10;

/// Rebound, as a part of the resting speed, of which the bounce cascade takes no time worth counting. Reason: falling
/// through the contact offset ends at some 1e-7 m/s. Smaller: particles rattle between surfaces by their offsets.
/// Larger: cascades end too early.
inline constexpr double kNegligibleRebound = 1e-3;

/// Slip of a sphere that several surfaces hold, relative to its speed, up to which its direction does not count: the
/// surface sticks, or slips in the direction that its forces give it. Reason: the direction of a slip that is about to
/// end turns within nanoseconds, and contacts open and close with it. Smaller: that. Larger: slow slip ends too early,
/// though slip that ends within an interval of its own never comes into this range.
inline constexpr double kSlowSlip = 0x1p-24;

// Particles that meet each other

/// Cell of the neighbour search, relative to the box that it holds. Reason: a box must not be longer than its cell
/// after rounding, of which 2^19 cells along an axis leave 2^-33. Smaller: neighbours may be missed. Larger: more
/// candidates.
inline constexpr double kCellSlack = 1.0 + 0x1p-20;

/// Approach of two spheres that touch, relative to their speeds, that is none. Reason: some roundings of an impact that
/// has stopped them. Smaller: such pairs meet again and again at one time. Larger: they sink in by it.
inline constexpr double kPairApproachRounding = 0x1p-48;

/// Overlap of two spheres, over the smaller radius, from which on they press on each other where it has grown in a step
/// in which they were not planned together: a force drives them together that no impact answers. Reason: far above what
/// roundings of impacts leave, far below what is seen. Smaller: rounding makes plans. Larger: spheres sink in by it.
inline constexpr double kPressedOverlap = 1e-7;

/// Impacts so many ulp of the time apart are at the same time. Reason: roundings of the times of symmetric pairs.
/// Smaller: symmetric pairs are answered one after the other. Larger: impacts after each other are answered together.
inline constexpr double kSameImpactUlps = 16.0;

/// Approaches that differ by this part are the same: they are answered as one problem. Reason: as above, after some
/// rounds. Smaller and larger: as above.
inline constexpr double kSameApproach = 1e-9;

/// Box in which a sphere declares to stay, relative to what it needs. Reason: roundings of its path, and of contact
/// that lasts. Smaller: spheres leave their boxes by rounding, and are worked off twice. Larger: more candidates.
inline constexpr double kPairBoxSlack = 1.0 + 0x1p-20;

// Clouds that go with their parents

/// Angle, rad, by which places of a cloud turn, or what is pulled back to them swings, in one piece of a path. Reason:
/// the cubic of a piece is within angle^4 / 384 of the arc, 1e-5 of its radius, and ends on it. Smaller: more pieces.
/// Larger: walls are met beside the arc.
inline constexpr double kMostCloudTurn = 0.25;

/// The same in one step of the run, beyond which a scene is refused. Reason: 64 pieces. Larger: steps without end.
inline constexpr double kMostCloudTurnOfStep = 16.0;

}  // namespace ricochet
