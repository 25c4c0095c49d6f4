/// \file
/// Every tolerance of the library, with its unit, its reason, and the effect of a change. "Smaller" and "Larger" name
/// the effect of a smaller and of a larger value.
/// No tolerance decides whether a particle crosses a surface, because exact predicates decide that.
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

/// Smallest contact offset, in m; matters only at the very origin. Must stay above kSmallestExactCoordinate.
inline constexpr double kSmallestContactOffset = 0x1p-240;

/// Number of times that a contact offset is widened if its certificate fails, and the factor.
inline constexpr int kSafePositionAttempts = 4;
inline constexpr double kContactOffsetWidening = 4.0;

/// Largest distance between a contact point and a safe position that is tried, in ulp of the point's largest
/// coordinate. It is 2^-40 of the coordinate, inside kCandidateSlack, so the candidates already gathered cover every
/// position. Smaller: sharp wedges, whose bisector leaves both walls slowly, have fewer safe positions.
inline constexpr double kLargestContactOffsetUlps = 4096.0;

/// Largest shortfall of a sphere's distance at a contact, as a fraction of the radius, that safe_position() corrects.
/// With a larger one the sphere has started in overlap and keeps its position. Smaller: grazing contacts are not
/// corrected. Larger: a sphere born in a slight overlap is pushed out.
inline constexpr double kContactMismatch = 1e-9;

/// Depth to which a path is halved while its chords are certified. 2^-52 of the path is below the rounding of its
/// points. A chord that still intersects a triangle at this depth is treated as an impact at that position.
inline constexpr int kCertificateDepth = 52;

/// Smallest core of a sphere in overlap, as a fraction of its radius. With a smaller core the sphere collides as a
/// point. Reason: the spin acts at the surface of the core, and would be scaled up there. Smaller: rounding of the
/// contact offset acts as curvature. Larger: spheres that are nearly half behind a surface lose friction's torque.
inline constexpr double kSmallestCore = 0x1p-20;

/// Relative difference up to which a triangle's rim may be farther than its face and still count as equally near.
/// Reason: some ten roundings. Smaller: the rim counts within 1e-8 of the distance inside. Larger: no effect, because
/// the exact test decides.
inline constexpr double kRimTie = 0x1p-48;

// Contact phases

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

/// Smallest restitution of a spring and damper. Reason: a smaller one would need unbounded damping, which no step can
/// follow. Smaller: the stability bound of dead surfaces shrinks with its root. Larger: dead surfaces bounce more.
inline constexpr double kMinPenaltyRestitution = 0.01;

/// Distance within which a particle that was rolled back to a collision touches the surface, relative to its path in
/// one time tolerance. Reason: bisection leaves it up to one such path away. Smaller than 1: a resting particle falls
/// and lands in every step. Larger: particles rest on air that much further away.
inline constexpr double kTouchBrackets = 2.0;

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

/// Largest turn, in rad, of the direction of sliding or of slip within one contact interval. Friction keeps the
/// direction at the middle of the interval. Smaller: more segments (each costs a query). Larger: the end of a slide
/// depends on the time step by the angle's square.
inline constexpr double kMaxHeadingTurn = 0.05;

/// The same limit for a slip that is so slow that its direction turns within a small part of the step. Smaller: more
/// segments for each reversal of a slip. Larger: the start of a slip depends on the time step.
inline constexpr double kMostHeadingTurn = 0.5;

/// Largest relative change of the slip velocity in one arc, if its direction turns. Reason: as for kMaxArcAngle.
/// Smaller: more arcs at the end of every slip. Larger: the end of a slide depends on the time step.
inline constexpr double kMaxSlipChange = 0.1;

/// Largest turn of friction, in rad, in an interval of constant acceleration. Beyond it, and up to kMaxHeadingTurn, the
/// motion is integrated like an arc. Reason: the error of the midpoint rule is the angle's square divided by 24.
/// Smaller: more cost. Larger: the end of a slide depends on the time step.
inline constexpr double kMostStraightTurn = 1e-3;

/// Sine of the angle between friction's directions at the start and in the middle of a contact interval below which
/// they count as equal. Smaller: rounding causes a second solution of the contact problem. Larger: slow turns add up.
inline constexpr double kStraightHeading = 0x1p-44;

/// Turn, in rad, of a particle around an edge or a curved surface in one straight segment of sliding or rolling. It
/// applies to the rollback response and to particles along flows. Smaller: more segments (each costs a query). Larger:
/// the particle leaves the surface by more (angle^2 / 2 of the radius of curvature) before it falls back.
inline constexpr double kMaxChordAngle = 0.01;

/// Part of a step during which a flow has to lead a stopped particle away from a wall before the particle moves.
/// Smaller: if a flow turns away only at that point, a particle creeps along the wall in ever more hops until its
/// budget is spent. Larger: it starts later, by less than this part of the step.
inline constexpr double kShortestRelease = 1.0 / 64.0;

/// Part of a step below which a path along a wall is skipped if it moves the particle only by rounding. Smaller: the
/// remaining path before a rim or a release is divided by so short a time that velocities overflow. Larger: a particle
/// leaves a wall earlier, by a path of less than a quarter of a contact offset.
inline constexpr double kNoProgress = 0x1p-20;

// Broad phase and look-ahead

/// Margin beside a path in free flight for many steps, relative to the largest coordinate involved. Reason: it covers
/// kCandidateSlack and the rounding of kMaxLookAheadSteps steps. Each step adds some 2^-52 for the position and as much
/// again, times the number of steps, for the velocity. Smaller than some 2^-38: a particle could pass a surface that a
/// query would have found. Larger: particles near surfaces need more queries.
inline constexpr double kLookAheadSlack = 0x1p-36;

/// Largest number of steps of free flight without a new query, on straight paths and on parabolas. Larger:
/// kLookAheadSlack must grow with the first constant. With a larger second one a parabola would be longer than one
/// query can cover with the boxes' margin.
inline constexpr int kMaxLookAheadSteps = 4096;
inline constexpr int kMaxLookAheadStepsCurved = 256;

/// Distance by which paths may leave the chords of broad-phase queries, as a fraction of the mean triangle's box. The
/// first value is the general one. The second one applies to look-ahead along parabolas, and limits its length.
/// Smaller: more chords for a path next to surfaces, more queries along it. Larger: boxes overlap more. Measured: 1/16
/// and 1/8 are alike in hail; 1/16 is a tenth faster for sliding debris; 1/4 is slower in both; 1/8 costs gas 10 %. No
/// result depends on them.
inline constexpr double kChordMargin = 1.0 / 32;
inline constexpr double kLookAheadMargin = 1.0 / 16;

/// Least chord margin, as a fraction of the box of all triangles and of a sphere's radius. It applies if triangles are
/// tiny or points. Smaller: paths next to tiny triangles are cut into an excessive number of chords. Larger: boxes
/// overlap more if triangles are much smaller than the scene. No result depends on it.
inline constexpr double kLeastChordMargin = 0x1p-26;

/// Rounding of positions in a distance field, in cells. Reason: positions are rounded to some 2^-50 of the largest
/// coordinate, and a cell is at least kSmallestDistanceCell of it. The grid's thousand cells add as much rounding
/// again. Smaller than some 2^-18: a triangle could be nearer than the lower bound. Larger: bounds are that much
/// smaller.
inline constexpr double kDistanceFieldRounding = 0x1p-10;

/// Smallest edge of a distance field's cell, relative to the largest coordinate. Smaller than some 2^-36: see
/// kDistanceFieldRounding. Larger: small meshes far from the origin get no field, and curved paths near them need
/// several queries.
inline constexpr double kSmallestDistanceCell = 0x1p-30;

/// Distance to the path beyond which a candidate triangle is culled, relative to the largest coordinate involved. It
/// applies to the triangle, its box and its plane. It is also the sine of the angle at which a path leads away from a
/// plane. Reason: it covers the displacement of safe positions (2^-40) and the rounding of points on the path. Smaller:
/// a certificate could miss a triangle near a safe position. Larger: more triangles reach the narrow phase.
inline constexpr double kCandidateSlack = 0x1p-39;

/// Rounding of a point on a path, relative to the largest coordinate that the path's terms reach: some ten roundings of
/// 2^-53. If it exceeds the boxes' margin, all triangles are candidates. Steps of free flight that lead a sphere away
/// from a triangle by less than this may lead it back. Smaller: a sphere could pass through such a triangle.
inline constexpr double kPathRounding = 0x1p-48;

/// Growth of the boxes in Embree, in units of 2^-24 times the scene's largest centred coordinate. Reason: covers
/// rounding of the ray's origin, of its direction and of t * direction in single precision on each axis. Smaller than
/// about 8: Embree might not propose a touched triangle, and particles could leak.
inline constexpr double kBoxPaddingUnits = 16.0;

/// Additional growth of boxes, as a fraction of the half extent; kCandidateSlack of the largest world coordinate is
/// added too. Reason: safe positions and rounded points of a path lie beside the segments of a query. Smaller: paths
/// that reach far beyond the mesh need every triangle as a candidate sooner (at kBoxSlack / kPathRounding half extents,
/// 2^28).
inline constexpr double kBoxSlack = 0x1p-20;

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

// Narrow phase

/// Difference of times, in ulp, below which impacts are simultaneous: all surfaces hit are then resolved together
/// (corners).
inline constexpr double kSimultaneousUlps = 4.0;

/// One minus the cosine of the angle between the normals of a face and of an edge or vertex, if a sphere hits both at
/// the same time. Below it the edge is the face's own seam and is ignored. Reason: contacts tie while the closest
/// point is within sqrt(2 * rounding * radius) of the edge. For coordinates of a thousand radii this is an angle of
/// 1e-6. Smaller: a grazing sphere is deflected by flat inner edges. Larger: blunt real edges act as faces.
inline constexpr double kSeamTurn = 1e-11;

/// Overlap of a sphere with a surface up to which its segment is accepted, relative to radius plus coordinates. Reason:
/// distances and safe positions are rounded to a few 1e-16 of the coordinates, and a sphere at a safe position must
/// pass. Smaller (below some 1e-15): safe positions fail their own certificate. Larger: spheres may sink in by that
/// much. It never lets a centre through, because the exact certificate of the centre's segment decides that.
inline constexpr double kSphereTolerance = 1e-12;

/// Lateral distance up to which a sphere that touches an edge or a vertex also touches the face beside it. It is
/// relative to the largest coordinate involved. Reason: over the seam of a flat plate rounding decides on which side
/// the closest point is, and the sphere should bounce as off one plate. Smaller than some 2^-50: seams of flat plates
/// deflect by rounding errors. Larger: on a convex edge the normal is wrong by up to this length over the radius.
inline constexpr double kSeamSlack = 0x1p-48;

/// Least approach speed of a sphere that already overlaps a surface, as a fraction of its speed. A slower sphere does
/// not count as approaching.
/// Reason: a velocity along the surface has a normal component of rounding errors, which must not stop the sphere
/// repeatedly. Larger: a sphere that overlaps at birth can sink in by that fraction of its path.
inline constexpr double kMinApproach = 0x1p-48;

/// Rounding of a pseudonormal, relative to the sum of the weights of its face normals, and of its scalar product with a
/// unit vector. Reason: a few roundings of 2^-50 and one of 2^-53 for each of some hundred triangles around a vertex.
/// Below it normals count as cancelled and sides as undecided. Smaller: rounding decides between the sides of knife
/// edges. Larger: edges sharper than that (rad) have no sides.
inline constexpr double kPseudonormalRounding = 0x1p-44;

/// Distance, as a fraction of the largest coordinate, below which the points at which one segment crosses neighbouring
/// triangles are one crossing. Reason: through an edge a segment crosses two triangles at points that differ only by
/// rounding. Smaller: such a crossing counts twice, and the parity of an open surface shows no crossing. Larger: the
/// two faces of a thinner plate count as one.
inline constexpr double kSameCrossing = 1e-9;

// Dynamics

/// Correction of a velocity at which Newton's method for the implicit step has converged, relative to the largest speed
/// in the system. Reason: convergence is quadratic near the solution, so the remaining error is far below it. Rounding
/// of the forces (some 1e-16 times the stiffness number) must not prolong the iteration. Smaller: stiff systems never
/// report convergence. Larger: the end of the step solves its equation less exactly; stability is not affected.
inline constexpr double kNewtonTolerance = 1e-10;

/// Energy created by the integrator at which the run stops as diverged, as a multiple of all energy from forces and
/// walls. Reason: errors of stable methods stay below that energy, and explosions pass any bound within a few steps.
/// Smaller: coarse but stable runs are stopped. Larger: more invalid output is written before the stop.
inline constexpr double kDivergedGain = 100.0;

/// Strain of springs whose energy counts as rounding if nothing else moves. Smaller than some 1e-8: a network at rest
/// counts as diverged by its own rounding. Larger: explosions from perfect rest are detected later.
inline constexpr double kNegligibleStretch = 1e-6;

/// Distance, in m, below which particles coincide and have no direction between them: forces between them are zero.
/// Reason: its third power is the smallest that is still a normal number with margin. Smaller (from 1e-102 on): the
/// inverse cube overflows. Larger: no effect on real scenes.
inline constexpr double kSamePlace = 1e-100;

/// Speed that forces may not exceed, in m/s: the speed of light (exact by the definition of the metre). Reason: a
/// higher speed means that the forces are wrong or the step is too long for them, so the run stops. Particles that
/// start faster are left alone.
inline constexpr double kMaxSpeed = 299792458.0;

/// Largest coordinate of a mesh or plane, in m, and largest state of a particle before it is frozen. Reason: the
/// predicates multiply three coordinates and must not overflow; far inside kLargestExactCoordinate.
inline constexpr double kLargestCoordinate = 1e75;

/// Smallest size of a surface, in m: the extent of a mesh, the diameter and height of a shape. Reason: coordinates
/// below kSmallestExactCoordinate count as zero, and that is far below the rounding of such a surface. Products of four
/// lengths, with their errors in double-double, stay normal numbers. The smallest contact offset is less than 1e-12 of
/// the size. Smaller (from 1e-70 on): triangles lose their areas to underflow, and particles and rays miss them.
/// Larger: no effect on real scenes.
inline constexpr double kSmallestSize = 1e-60;

/// Largest coefficient of a path, in m/s^k, that is followed. Reason: a cubic between two positions within a nearly
/// zero time has coefficients of their distance over the cube of that time. Sums of their squares must not overflow in
/// the narrow phase. Larger: the narrow phase finds no roots among values that are not numbers, and only the
/// certificate protects the path. Smaller (from 1e40 on): short arcs that can be followed are not.
inline constexpr double kLargestPathCoefficient = 1e120;

/// Least mass of a particle, in kg, fragments included. Reason: inertia (0.4 m r^2), momentum and kinetic energy of
/// slow and small particles have to stay normal numbers. A share of a mass is a whole multiple of its last bit, which
/// must not be 0. Smaller (from 1e-308 on): masses of fragments become 0 or not a number. Larger: no effect on real
/// scenes.
inline constexpr double kSmallestMass = 1e-300;

/// Least excess of a rope's length over the distance of its ends for a catenary, as a fraction of the length. Ropes
/// with less are laid out straight. Smaller (below some 1e-14): the catenary's parameter is rounding. Larger: nearly
/// taut ropes start shortened.
inline constexpr double kTautRope = 1e-9;

/// Sideways distance of a rope's ends, relative to its length, below which it hangs straight down and back up. Smaller
/// than some 1e-300: exponentials overflow. Larger: narrow catenaries lose their curvature.
inline constexpr double kFoldedRope = 1e-9;

/// Relative change of an impact that earlier impacts of the same substep may cause by moving the body that it hits. It
/// limits the change of the relative velocity, as a fraction of the impact's velocity change. It also limits the energy
/// change from the joint solution of the impacts, as a fraction of the energy that they dissipate. Larger: impacts
/// treat light bodies as not yet moved; from 1 on energy grows. Smaller: more substeps.
inline constexpr double kMostBodyChange = 0.1;

/// Mass of the load on a body, relative to the body's effective mass, above which the substep is planned again until
/// the load fits. Larger: from 1 on energy grows. Smaller: more work for loads that converge by themselves from
/// step to step.
inline constexpr double kHeavyLoad = 0.5;

/// Difference of planned and actual load on a body. It is measured as a velocity change, relative to the largest
/// velocity change by the load in a substep. Larger: energy is gained or lost. Smaller: the substep is planned more
/// often.
inline constexpr double kLoadFits = 1e-3;

/// Largest number of plans of a substep of the same duration. Smaller: substeps get shorter if loads begin and end
/// within them. Larger: such substeps cost more before they get shorter.
inline constexpr int kMostLoadRounds = 8;
/// Largest number of plans of a substep that cannot be shortened.
inline constexpr int kFewLoadRounds = 3;

/// Fraction of the time to the next impact, or to the step's end, after which a substep ends and bodies receive their
/// impulses. If impacts dissipate little energy, the square or cube of this fraction applies. Larger: bodies move on
/// longer without the impulses. Much smaller: grains that settle on a body cause many substeps.
inline constexpr double kPartAfterImpact = 1e-3;

/// Least duration of a substep, as a fraction of the time step. Smaller: bodies between many impacts take longer.
/// Larger: more impacts are treated as simultaneous, which can add energy.
inline constexpr double kShortestPart = 1e-4;

/// Rounding of sums of exchanged energies, relative to these energies. Smaller: substeps end at every impact. Larger:
/// bodies gain energy.
inline constexpr double kImpactEnergyRounding = 1e-14;

/// Unit of the per-triangle impulse totals, in N s. Totals are 128-bit integers in this unit, so that sums do not
/// depend on the order. The largest total is 2^27 N s = 1.3e8 N s (beyond it the total wraps).
inline constexpr double kImpulseUnit = 0x1p-100;

/// Returns the difference between |x| and the next larger double. x must be finite.
[[nodiscard]] inline double ulp(double x) {
    const double magnitude = std::fabs(x);
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(magnitude) + 1) - magnitude;
}

/// Returns the contact offset at a contact point, in m. It depends only on the point's own coordinates, so that a wall
/// of two or of two million triangles gives the same bits.
[[nodiscard]] inline double contact_offset(const Vec3& contact) {
    return std::max(kContactOffsetUlps * ulp(max_abs(contact)), kSmallestContactOffset);
}

/// Returns the overlap that a certified segment of a sphere may show, in m. radius and largest_coordinate are in m.
[[nodiscard]] inline double sphere_tolerance(double radius, double largest_coordinate) {
    return kSphereTolerance * (radius + largest_coordinate);
}

/// Smallest tolerance, in m and m/s, of the integrator that chooses its own steps. Reason: the number of substeps grows
/// with the inverse fifth root of the tolerance. Smaller: a step never ends. Larger: systems of 1e-15 m and less could
/// not be followed accurately.
inline constexpr double kSmallestTolerance = 1e-30;

/// Shortest substep of an adaptive method, as a fraction of its step. If its error still exceeds the tolerance, it is
/// accepted and its particle-step is counted (coarse_steps). Reason: a particle passes a jump of a force with an error
/// of 2^-48 of the jump's effect in a step. No substep is short enough near a point of infinite force. Smaller: the
/// clock, which rounds to 2^-53 of the time, does not advance. Larger: close passages of point masses lose their
/// accuracy earlier.
inline constexpr double kShortestSubstep = 0x1p-48;

/// Largest number of substeps of an adaptive method in one step of a particle. The rest of the step is not simulated,
/// and is counted (budget_exhausted). Reason: some tenths of a second of work. Smaller: particles bound close to a
/// point mass, which need some 50 substeps per orbit, stop for a part of each step. Larger: a step takes longer before
/// it ends.
inline constexpr std::uint32_t kMostSubsteps = 100000;

/// Error of an adaptive substep that counts as zero, relative to the largest component of the state: a quarter of its
/// rounding. Smaller: substeps shorten without end if the tolerance is below the precision of doubles. Larger: the
/// integrator does not meet tolerances that it could meet.
inline constexpr double kStateRounding = 0x1p-54;

/// Largest residual of solved equations of contact with friction, as a fraction of the largest rate (forces per mass
/// and rates have the same unit). Reason: some ten times the rounding. Smaller: solved problems
/// count as unsolved. Larger: energy may grow by as much.
inline constexpr double kCoulombResidual = 0x1p-40;

/// Residual up to which a solution is accepted before less friction is tried. Reason: if surfaces press against each
/// other with undetermined forces, rounding leaves 1e-7 and more. The next smaller friction would be wrong by 1e-3.
/// Smaller: a sphere that rolls between two surfaces slips for a moment. Larger: less exact solutions are accepted.
/// Their energy is still limited.
inline constexpr double kNearlySolved = 1e-4;

/// Residual at which the iteration stops. Reason: rounding of six products. Smaller: iterations without improvement.
/// Larger: worse solutions.
inline constexpr double kCoulombRounding = 0x1p-50;

/// Compliance, relative to the inertia of the particle, of contacts that count as stiff. Reason: normals that differ by
/// its square root, 1e-5, still determine which of two contacts carries the load. Proximal steps handle closer normals.
/// Smaller: the equations cannot be solved in doubles. Larger: more proximal steps.
inline constexpr double kStiffCompliance = 1e-10;

/// Factor by which the compliance decreases per stage from soft contacts to stiff ones: the first value, and the limit
/// when no solution is found. Reason: two digits per stage lose the solution in one case of a thousand. Smaller: it is
/// lost more often. Larger: more stages.
inline constexpr double kStiffening = 1e-2;
inline constexpr double kShortestStiffening = 0.9;

/// Energy that impulses of a contact network may seem to add, as a fraction of the sum of their works. Reason: rounding
/// of sums over a thousand contacts. Smaller: elastic impacts lose their rebound. Larger: energy may grow by as much.
inline constexpr double kNetworkEnergyRounding = 1e-12;

/// Fraction of an overlap of spheres in dense contact that one step removes. Reason: remaining errors of the sweeps
/// must not add up from step to step. With one half an overlap vanishes in a few steps without a jerk. Smaller:
/// overlaps last. Larger: deep overlaps, from hard impacts, eject spheres.
inline constexpr double kNetworkPushOut = 0.5;

/// Over-relaxation factor of normal impulses in sweeps over contact networks. Reason: with 1.2 boxes of 2000 spheres
/// come to rest with two thirds of the sweeps; with 1.5 friction oscillates. Smaller: more sweeps. Larger: sweeps
/// diverge at 2.
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

/// Largest turn, in rad, of surfaces of different frames, or of curved surfaces, under a particle that they support
/// together, in one interval of contact. Reason: within an interval the surfaces are replaced by their planes at its
/// start, and the error is the square of the turn. Smaller: more intervals (each costs a query), and a step's limit of
/// intervals is reached sooner. Larger: contact with several frames at once is less exact.
inline constexpr double kMostSharedTurn = 0.02;

/// Number of bounces among moving colliders after which the progress of a particle is checked. The second constant is
/// the part of the step that must have passed by then. Otherwise the particle is pinched between closing surfaces and
/// stops for this step. Reason: between closing walls each bounce takes a part of the remaining time, and more bounces
/// would not help. Fewer bounces, or a larger part: particles stop in corners that they could leave. More bounces, or a
/// smaller part: pinched particles cost more bounces.
inline constexpr std::uint32_t kBouncesToClose = 16;
inline constexpr double kLeastWayOut = 1e-3;

/// Length of the difference of unit normals up to which surfaces count as one in an impact or a contact. Reason: the
/// effects of two such surfaces differ by as much, far below the accuracy of a path's parabolas. The facets of a flat
/// surface, and seams, differ by rounding. Smaller: nearly redundant contacts, whose forces are ill-conditioned.
/// Larger: a wedge of that angle supports less than it should.
inline constexpr double kSameDirection = 1e-9;

/// Rounding of twice the energy over the mass in an impact. It is a fraction of the squares of the velocity and of the
/// velocity changes by all surfaces. A smaller gain is scaled away; a larger one is a real gain. Reason: some ten times
/// the rounding of the solved equations. Smaller: restitution is lowered for rounding only. Larger: a gain by friction
/// is scaled away instead of lowering the restitution.
inline constexpr double kEnergyRounding = 0x1p-44;

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

/// Angle, in rad, by which a particle turns around an edge or along a curved surface in one arc. Reason: the error of
/// an arc is the fifth power of the angle. Smaller: more arcs (each costs a query). Larger: paths of swings and rolls
/// are less exact.
inline constexpr double kMaxArcAngle = 0.1;

/// Turn, in rad, of a curved surface under a sphere in one arc. Above it the arc is searched for a jump of the nearest
/// point. Reason: planned arcs turn by kMaxArcAngle. Smaller: whole arcs are searched and cut. Larger: a sphere wider
/// than a shape passes through the side that its nearest point has jumped to.
inline constexpr double kMostTurn = 2.0 * kMaxArcAngle;

/// Turn, in rad, or path, in radii, that counts as a jump between two times 2^-40 of an arc apart. The start of an arc
/// is tested for a jump too. A jump means that the surface is narrower than the sphere, which jams. Smaller: fast turns
/// jam. Larger: small jumps are missed.
inline constexpr double kJump = 1e-3;

/// Largest relative correction of an arc's end that conserves its energy. Reason: the error of the method is far
/// smaller, and a larger correction would hide other mistakes. Smaller: slow turning points are left uncorrected.
/// Larger: such mistakes are hidden.
inline constexpr double kMostEnergyCorrection = 1e-2;

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

// Impacts between particles

/// Size of a cell of the neighbour search, relative to the boxes in it. Reason: a box must not be longer than its cell
/// after rounding, and 2^19 cells along an axis leave 2^-33. Smaller: neighbours may be missed. Larger: more
/// candidates.
inline constexpr double kCellSlack = 1.0 + 0x1p-20;

/// Approach of two touching spheres that counts as zero, relative to their speeds. Reason: some roundings of an impact
/// that has stopped them. Smaller: such pairs collide repeatedly at one time. Larger: spheres overlap more.
inline constexpr double kPairApproachRounding = 0x1p-48;

/// Overlap of two spheres, relative to the smaller radius, from which they press on each other. The overlap must have
/// grown in a step without a common plan. A force then drives them together that no impact resolves. Reason: far above
/// the rounding of impacts, far below visible overlap. Smaller: rounding causes plans. Larger: spheres overlap by as
/// much.
inline constexpr double kPressedOverlap = 1e-7;

/// Difference of impact times, in ulp, up to which impacts are simultaneous. Reason: roundings of the times of
/// symmetric pairs. Smaller: symmetric pairs are resolved sequentially. Larger: sequential impacts are resolved
/// together.
inline constexpr double kSameImpactUlps = 16.0;

/// Relative difference of approach speeds up to which they are equal and the impacts are solved as one problem. Reason:
/// as for kSameImpactUlps, after some rounds. Smaller and larger: as for kSameImpactUlps.
inline constexpr double kSameApproach = 1e-9;

/// Size of the box in which a sphere declares to stay, relative to the necessary size. Reason: roundings of its path,
/// and of lasting contact. Smaller: spheres leave their boxes by rounding, and are processed twice. Larger: more
/// candidates.
inline constexpr double kPairBoxSlack = 1.0 + 0x1p-20;

// Clouds that move with their parents

/// Largest turn, in rad, in one piece of a path: of positions in a cloud, and of the swing of particles that are pulled
/// back to them. Reason: the cubic of a piece is within angle^4 / 384 of the arc, 1e-5 of its radius, and ends on it.
/// Smaller: more pieces. Larger: walls are hit beside the arc.
inline constexpr double kMostCloudTurn = 0.25;

/// Largest such turn in one step of the run, above which a scene is refused. Reason: 64 pieces. Larger: steps without
/// end.
inline constexpr double kMostCloudTurnOfStep = 16.0;

}  // namespace ricochet
