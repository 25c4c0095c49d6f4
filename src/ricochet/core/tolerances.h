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

/// Gap between a parked particle and the surface it has just hit, in ulp of the contact point's largest coordinate.
/// Reason: large enough that rounding of the parked point cannot put it on the surface, small enough to be invisible.
/// Smaller: safe_position fails more often and falls back to the path. Larger: each impact adds g * gap to an elastic
/// ball's energy per mass.
inline constexpr double kContactOffsetUlps = 16.0;

/// Smallest safe_position gap, m; only matters for contacts at the very origin. Must stay above
/// kSmallestExactCoordinate.
inline constexpr double kSmallestContactOffset = 0x1p-240;

/// How often a safe_position gap that fails its certificate is widened, and the factor.
inline constexpr int kSafePositionAttempts = 4;
inline constexpr double kContactOffsetWidening = 4.0;

/// Longest way from a contact point to a safe_position place that is tried, in ulp of the point's largest coordinate:
/// 2^-40 of it at most, inside kCandidateSlack, so that the candidates already gathered cover every place. Smaller:
/// sharp wedges, where the way out of two walls is longer than the gap, are parked in less often.
inline constexpr double kLargestContactOffsetUlps = 4096.0;

/// A surface counts as touched while the particle is within this many safe_position gaps of its plane, and sliding goes
/// on until the particle is as far beyond the triangle's rim. Smaller: sliding is cut into more, shorter stretches.
/// Larger: a particle slides on air beyond a convex edge by that distance (some 1e-14 of its coordinates).
inline constexpr double kTouchingOffsets = 8.0;

/// Times that a particle is projected out of what it is behind in one step; after that it goes back to where it came
/// from. Reason: in a corner of several colliders one projection leads behind the next. Smaller: corners stop particles
/// more often. Larger: sharp wedges cost more queries.
inline constexpr int kMaxProjections = 16;

/// Restitution that a spring and damper can do at least: less would need damping without bound, which no step can
/// follow. Smaller: the stability bound of dead surfaces shrinks with its root. Larger: they bounce more.
inline constexpr double kMinPenaltyRestitution = 0.01;

/// Ways of one time tolerance within which a particle that has gone back to a collision counts as touching the surface.
/// Reason: bisection leaves it up to one such way off. Smaller than 1: resting contact falls and lands in every step.
/// Larger: particles rest on air that much further off.
inline constexpr double kTouchBrackets = 2.0;

/// Contacts in a row, pressed on and all slower than the resting speed or without time between them, after which a
/// particle comes to rest for the step. Reason: in a pit of four or more faces a sliding particle circles into the apex
/// in infinitely many ever shorter stretches. Smaller: slow sliding over many tiny triangles is cut short. Larger:
/// circling costs more contacts a step.
inline constexpr int kMaxSlowContacts = 32;

/// One minus the cosine of the angle between normals below which two surfaces touched together count as one plane.
/// Smaller: coplanar triangles take up the three places for touched surfaces. Larger: a blunt corner counts as flat.
inline constexpr double kSameNormal = 1e-12;

/// What a velocity that was projected onto a plane may still approach it by, relative to its length: a few roundings.
/// Smaller: a projection is taken for infeasible and the next best, slower one is used. Larger: a particle creeps into
/// a wall's gap.
inline constexpr double kProjectionRounding = 0x1p-48;

/// Slip of a sphere, relative to the speeds whose difference it is, below which it is rounding and the sphere rolls.
/// Smaller: rolling is chopped into stretches of sliding. Larger: slow slip ends too early.
inline constexpr double kSlipRounding = 0x1p-40;

/// Speed that a brake to a stop may leave, relative to the speed it began with, and still is a stop: rounding across
/// the heading. Smaller: particles creep on at 1e-16 of their speed instead of coming to rest. Larger: real sideways
/// motion is lost.
inline constexpr double kStopRounding = 0x1p-40;

/// Fraction by which a sphere's distance at a contact may fall short of its radius and still be put right by
/// safe_position; beyond it the sphere started in overlap and stays where it is. Smaller: grazing contacts are not put
/// right. Larger: a sphere born in a slight overlap is pushed out.
inline constexpr double kContactMismatch = 1e-9;

/// Angle, rad, by which the direction of sliding or of slip may turn in one stretch: friction keeps its direction
/// over a stretch. Smaller: more stretches (each costs a query). Larger: where a slide ends depends on the time step.
inline constexpr double kMaxHeadingTurn = 0.05;

/// Angle, rad, by which a particle turns around a rim or a curved surface in one straight stretch of sliding or
/// rolling. Smaller: more stretches (each costs a query). Larger: it leaves the surface by more (angle^2 / 2 of the
/// bend's radius) before it falls back.
inline constexpr double kMaxChordAngle = 0.01;

/// Distance, relative to the largest coordinate involved, that is left beside a way that is foreseen for many steps.
/// Reason: it covers kCandidateSlack and the rounding of kMaxLookAheadSteps steps, each of some 2^-52 for the place
/// and as much again, times the number of steps, for the velocity. Smaller than some 2^-38: a particle could be taken
/// past a surface that the search would have found. Larger: particles near surfaces are searched for more often.
inline constexpr double kLookAheadSlack = 0x1p-36;

/// Steps that a particle may go on without a new search, straight on and along a parabola. Larger: kLookAheadSlack must
/// grow with the first; with the second the slack is taken of a longer way than boxes let one look along.
inline constexpr int kMaxLookAheadSteps = 4096;
inline constexpr int kMaxLookAheadStepsCurved = 256;

/// By how much paths may leave the chords that the broad phase is asked about, in parts of the mean triangle's box: as
/// a rule, and where particles look ahead along parabolas, for which it decides how far. Smaller: more chords for a
/// path next to surfaces, more queries along a way. Larger: boxes overlap more (measured: 1/16 and 1/8 are alike in
/// hail, 1/16 is a tenth faster where debris slides, 1/4 slower in both; 1/8 costs gas 10 %). No result depends on
/// them.
inline constexpr double kChordMargin = 1.0 / 32;
inline constexpr double kLookAheadMargin = 1.0 / 16;

/// What rounding may do to places in a clearance grid, in cells. Reason: places are rounded to some 2^-50 of the
/// largest coordinate, of which a cell is kSmallestDistanceCell at least, and to as much of the grid's thousand cells.
/// Smaller than some 2^-18: a triangle could be nearer than the grid says. Larger: clearances are that much smaller.
inline constexpr double kDistanceFieldRounding = 0x1p-10;

/// Smallest edge of a clearance grid's cell, relative to the largest coordinate. Smaller than some 2^-36: see
/// kDistanceFieldRounding. Larger: small meshes far from the origin get no grid, and bent paths near them are searched
/// piece by piece.
inline constexpr double kSmallestDistanceCell = 0x1p-30;

/// Distance, relative to the largest coordinate involved, by which a candidate triangle, its box or its plane must
/// clear the path before the triangle is dropped; also the sine of the angle at which a path leads away from one.
/// Reason: covers the safe_position displacement (2^-40) and the rounding of points on the path. Smaller: a certificate
/// could miss a triangle near the parked point. Larger: more triangles reach the exact tests.
inline constexpr double kCandidateSlack = 0x1p-39;

/// Rounding of a point on a path, relative to the largest coordinate that the path's terms reach: some ten roundings of
/// 2^-53. Where that exceeds what the boxes allow for, all triangles are candidates; foreseen steps that lead a sphere
/// away from a triangle by less than that may lead it back. Smaller: a sphere could be taken through such a triangle.
inline constexpr double kPathRounding = 0x1p-48;

/// Boxes handed to the ray library grow by this many units of 2^-24 times the scene's largest centred coordinate.
/// Reason: covers rounding of the ray's origin, direction and of t * direction in single precision on each axis.
/// Smaller than about 8: a touched triangle might not be presented, and particles could leak.
inline constexpr double kBoxPaddingUnits = 16.0;

/// Boxes grow further, by this part of the half extent and kCandidateSlack of the largest world coordinate:
/// safe_position places and rounded points of a path lie beside the segments that are asked about. Smaller: paths that
/// reach far beyond the mesh need every triangle as a candidate sooner (at kBoxSlack / kPathRounding half extents,
/// 2^28).
inline constexpr double kBoxSlack = 0x1p-20;

/// Times closer than this many ulp count as simultaneous: all surfaces hit then answer together (corners).
inline constexpr double kSimultaneousUlps = 4.0;

/// One minus the cosine of the angle between the normals of a face and of an edge or vertex that a sphere meets at the
/// same time, below which the edge is the face's own seam and does not answer. Reason: contacts tie while the foot is
/// within sqrt(2 * rounding * radius) of the edge, an angle of 1e-6 for coordinates of a thousand radii. Smaller: a
/// grazing sphere is nudged by flat inner edges. Larger: blunt real edges answer as faces.
inline constexpr double kSeamTurn = 1e-11;

/// Distance by which a sphere may overlap a surface before its segment is refused, relative to radius plus coordinates.
/// Reason: distances and parked centres are rounded to a few 1e-16 of the coordinates, and a parked sphere must pass.
/// Smaller (below some 1e-15): parked spheres fail their own certificate. Larger: spheres may sink in by that much. It
/// never lets a centre through: that is decided by the exact certificate of the centre's segment.
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

/// Depth to which a path is halved while its chords are being certified. 2^-52 of the path is below the rounding of its
/// points; a chord that still meets a triangle there is taken as an impact at that place.
inline constexpr int kCertificateDepth = 52;

/// Places at which one segment meets neighbouring triangles are one crossing when they are nearer to each other than
/// this part of their largest coordinate. Reason: through an edge a segment meets two triangles at places that differ
/// by rounding only. Smaller: such a crossing counts twice, and an open surface that was crossed looks as if it was
/// not. Larger: the two faces of a thinner plate count as one.
inline constexpr double kSameCrossing = 1e-9;

/// Correction of a velocity, relative to the largest speed in the system, with which Newton's method for the implicit
/// step has converged. Reason: convergence is quadratic near the solution, so what is left is far below, and rounding
/// of the forces (some 1e-16 times the stiffness number) must not keep it going. Smaller: stiff systems never report
/// convergence. Larger: the step's end solves its equation less closely; stability is not touched.
inline constexpr double kNewtonTolerance = 1e-10;

/// Energy that an integrator may have made out of nothing before the run stops as diverged, in parts of all that forces
/// and walls have given. Reason: errors of stable methods stay below what was given, explosions pass any bound within a
/// few steps. Smaller: coarse but stable runs are stopped. Larger: more nonsense is written before the stop.
inline constexpr double kDivergedGain = 100.0;

/// Stretch of springs, relative to their rest length, whose energy is taken for rounding where nothing else moves.
/// Smaller than some 1e-8: a network at rest counts as diverged by its own rounding. Larger: explosions from perfect
/// rest are seen later.
inline constexpr double kNegligibleStretch = 1e-6;

/// Speed that no particle may be brought to, m/s: that of light (exact by the definition of the metre). Forces that do
/// so are wrong or the step is too long for them; the run stops. Particles that start faster are let be.
inline constexpr double kMaxSpeed = 299792458.0;

/// SafePosition gaps by which a particle may slide beyond a triangle's rim before it leaves that triangle. Reason: at a
/// gap above one face of a blunt valley the other face is met only 1 / slope gaps beyond the edge, and both must then
/// hold. Smaller: particles zigzag in blunt valleys until their budget is spent. Larger: they slide on air beyond
/// convex edges by that distance (some 1e-12 of the coordinates).
inline constexpr double kEdgeOffsets = 256.0;

/// Largest coordinate a mesh or plane may have, m, and largest state a particle may reach before it is frozen.
/// Reason: the predicates multiply three coordinates and must not overflow; far inside kLargestExactCoordinate.
inline constexpr double kLargestCoordinate = 1e75;

/// Part of a rope's length by which it must exceed the distance of its ends to be laid out as a catenary, not straight.
/// Smaller (below some 1e-14): the catenary's parameter is made of rounding. Larger: nearly taut ropes start shortened.
inline constexpr double kTautRope = 1e-9;

/// Sideways distance of a rope's ends, relative to its length, below which it hangs straight down and comes back.
/// Smaller than some 1e-300: exponentials overflow. Larger: narrow catenaries lose their bend.
inline constexpr double kFoldedRope = 1e-9;

/// Unit of the per-triangle impulse totals, N s. They are 128-bit integers in this unit, so that sums do not depend on
/// the order; the largest total is 2^27 N s = 1.3e8 N s (beyond it the total wraps).
inline constexpr double kImpulseUnit = 0x1p-100;

/// Distance from x, which is finite, to the next larger double magnitude.
[[nodiscard]] inline double ulp(double x) {
    const double magnitude = std::fabs(x);
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(magnitude) + 1) - magnitude;
}

/// The safe_position gap at a contact point, m: depends on the point's own coordinates only, so that a wall of two or
/// two million triangles gives the same bits.
[[nodiscard]] inline double contact_offset(const Vec3& contact) {
    return std::max(kContactOffsetUlps * ulp(max_abs(contact)), kSmallestContactOffset);
}

/// The overlap that a certified segment of a sphere may show, m: radius and the largest coordinate involved in m.
[[nodiscard]] inline double sphere_tolerance(double radius, double largest_coordinate) {
    return kSphereTolerance * (radius + largest_coordinate);
}

}  // namespace ricochet
